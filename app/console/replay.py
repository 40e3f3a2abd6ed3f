"""A recorded lap for the researcher's replay: what a participant can see of it, and what only we may.

The lap runs once more from its inputs, which shows whether the recording is what happened; what is drawn
comes from the recorded states. Like all work with the robot this is done in a worker process.

The bytes (read by ``modules/replay_data.js``): a 32-bit length, so many bytes of JSON padded to a multiple of
four, the lap as in ``app.server.lap_wire``, then little-endian 32-bit floats, one row of `COLUMNS` a frame.
"""

import json
import struct
from pathlib import Path

from app.server.lap_wire import pack_lap
from data.records import Outcome
from data.study import Study

COLUMNS = ("force_n", "speed_m_s", "sigma_min", "phase")
"""Magnitude of the hand's force, speed of the cursor, smallest singular value, index of the phase."""

_LENGTH = struct.Struct("<I")


def replay_content(
    recording: Path, sha256: str | None, study: Study, duration_s: float, outcome: Outcome
) -> bytes:
    """The bytes of a trial's replay.

    Parameters
    ----------
    recording : Path
        The trial's file.
    sha256 : str or None
        What its hash must be.
    study : Study
        The study that the trial belongs to.
    duration_s, outcome : float, Outcome
        As stored with the trial.

    Raises
    ------
    InputError
        If the file is missing, is no recording, or is not the one that was written.
    """
    import numpy as np

    from data.errors import ElbowroomError
    from sim_trials.frames import FRAME_HZ, frames
    from sim_trials.maze import PHASES
    from sim_trials.metrics import phases
    from sim_trials.recording import STATE_EVERY, read
    from sim_trials.trace import Trace
    from sim_trials.trial import replay_trace

    lap = read(recording, sha256)
    seen = frames(lap)
    # Phases are computed in double precision, whatever precision the places were kept in.
    places = np.zeros(lap.states.size, [("place", np.float64)])
    places["place"] = lap.states["place"]
    kept = Trace(places, lap.counts[::STATE_EVERY], lap.triggers[::STATE_EVERY], lap.facts.ending)
    rows = np.column_stack([kept.force_n, seen.speed_m_s, lap.states["sigma"], phases(kept, study)])
    try:
        replay_trace(lap, study)
        doubt = ""
    except ElbowroomError as error:
        doubt = _without_modes(str(error), study)
    packed = pack_lap(seen, FRAME_HZ, duration_s, outcome)
    facts = {
        "hz": FRAME_HZ,
        "rows": len(rows),
        "columns": list(COLUMNS),
        "phases": list(PHASES),
        "lap_bytes": len(packed),
        "doubt": doubt,
    }
    head = json.dumps(facts).encode()
    head += b" " * (-len(head) % 4)
    return _LENGTH.pack(len(head)) + head + packed + rows.astype("<f4").tobytes()


def _without_modes(text: str, study: Study) -> str:
    """An error's words, unless they name a mode: the replay is shown while the study is blinded, too."""
    named = any(name in text for name in study.mode_names)
    return "the recording can't be run again here" if named else text
