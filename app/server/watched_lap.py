"""One lap for a participant to watch; it runs in a worker process."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from app.server.lap_wire import pack_lap
from data.records import Outcome, StuckEvent
from data.study import Study


@dataclass(frozen=True)
class WatchedLap:
    """What the web process keeps of a lap.

    Attributes
    ----------
    frames : bytes
        What the browser gets, and all it gets (``lap_wire``).
    outcome : Outcome
        A lap that the simulated operator gave up is ``abandoned``.
    seed : int
        Of the operator and its hand.
    recording, recording_sha256 : str
        The lap's file in the store's folder of recordings.
    """

    frames: bytes
    outcome: Outcome
    duration_s: float
    seed: int
    metrics: Mapping[str, float]
    events: tuple[StuckEvent, ...]
    recording: str
    recording_sha256: str


def run_lap(study: Study, mode_name: str, seed: int, lap: int, recording: Path) -> WatchedLap:
    """Let the simulated operator of a seed do a lap, and write its recording."""
    from sim_trials.frames import FRAME_HZ, frames
    from sim_trials.operators import draw_operator
    from sim_trials.trial import run_trial

    result = run_trial(study, mode_name, draw_operator(seed), seed=seed, lap=lap)
    return WatchedLap(
        frames=pack_lap(frames(result.recording), FRAME_HZ, result.duration_s, result.outcome),
        outcome=result.outcome,
        duration_s=result.duration_s,
        seed=seed,
        metrics=result.metrics,
        events=result.events,
        recording=recording.name,
        recording_sha256=result.recording.write(recording),
    )


def warm_up(study: Study) -> None:
    """Load and compile what a lap needs, by running one that nobody sees."""
    from sim_trials.operators import draw_operator
    from sim_trials.trial import run_trial

    run_trial(study, study.mode_names[0], draw_operator(0), seed=0)
