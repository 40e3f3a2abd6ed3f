"""A lap on disk: every input exactly, the states 25 times a second, and what is needed to run it again.

One Parquet file, one row a control tick. The inputs (what the force-torque sensor counted, the triggers)
are whole numbers and stand in every row; the states are float32 and stand in every fifth row, null in
between: `trial.replay` regenerates them at the full rate. Facts about the lap are JSON in the file's
metadata under ``elbowroom``.
"""

import hashlib
import io
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from data.errors import ElbowroomError, InputError
from data.locations import atomic_write
from sim_trials.guidance import Hand
from sim_trials.loop import COMPLETED, DIVERGED, TICK
from sim_trials.operators import Operator

FORMAT = "lap/2"
_OLD_FORMAT = "lap/1"
"""Without people: the facts have no ``hand``. It is still read."""
STATE_EVERY = 5
"""Control ticks from one kept state to the next: 25 Hz."""

_UNITS = {
    "q": "rad",
    "qdot": "rad_s",
    "sigma": "",
    "cursor_y": "m",
    "cursor_z": "m",
    "tilt": "rad",
    "tilt_direction": "rad",
    "place": "m",
}
"""The fields of ``loop.TICK`` that are kept, with their units; the others follow from a replay."""

STATE = np.dtype([(name, np.float32, TICK[name].shape) for name in _UNITS])
"""What is kept of ``loop.TICK``, in single precision."""

_KEY = b"elbowroom"
_INPUTS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
_TRIGGERS = "triggers"


@dataclass(frozen=True)
class Facts:
    """What is known of a lap beside its time series.

    Attributes
    ----------
    study, study_sha256 : str
        Name and hash of the study it was run for.
    mode, method, parameters : str, str, dict
        The mode's name, its method and all of the method's parameters.
    operator : dict or None
        Fields of the ``operators.Operator``; None if a person guided the robot.
    hand : dict or None
        Fields of the ``guidance.Hand`` that a person's pointer moved; None for simulated operators.
    seed, lap : int
        Of the hand's unsteadiness, and which lap under this condition it is.
    start_rad : tuple of float
        Joint angles at the start.
    ending : int
        How it ended, ``loop.COMPLETED`` ...
    versions : dict
        Of what the arithmetic depends on.
    """

    study: str
    study_sha256: str
    mode: str
    method: str
    parameters: dict[str, float]
    operator: dict[str, float] | None
    hand: dict[str, float] | None
    seed: int
    lap: int
    start_rad: tuple[float, ...]
    ending: int
    versions: dict[str, str]


@dataclass(frozen=True, eq=False)
class Recording:
    """One lap as it is kept.

    Attributes
    ----------
    facts : Facts
    counts : ndarray of int16, shape (n, 6)
        What the sensor counted in each control tick: force along x, y, z [1/128 N], moment [1/1024 N m]; tool
        frame.
    triggers : ndarray of uint8, shape (n,)
        Bits ``loop.ENABLE`` and ``loop.BLAST``.
    states : ndarray of STATE, shape (ceil(n / 5),)
        The state at the beginning of every fifth tick, from the first on.
    """

    facts: Facts
    counts: np.ndarray
    triggers: np.ndarray
    states: np.ndarray

    def __eq__(self, other: object) -> bool:
        """Equal to the last bit."""
        return (
            isinstance(other, Recording)
            and self.facts == other.facts
            and self.counts.tobytes() == other.counts.tobytes()
            and self.triggers.tobytes() == other.triggers.tobytes()
            and self.states.tobytes() == other.states.tobytes()
        )

    def write(self, path: Path) -> str:
        """Write the file, so that it is there whole or not at all; its SHA-256 is returned.

        The same recording gives the same bytes with the same version of pyarrow.

        Raises
        ------
        ElbowroomError
            If the place is full or cannot be written.
        """
        table, buffer = _table(self), io.BytesIO()
        pq.write_table(
            table,
            buffer,
            compression="zstd",
            compression_level=9,
            use_dictionary=[_TRIGGERS],
            column_encoding=_encodings(table.schema),
            write_page_checksum=True,
        )
        content = buffer.getvalue()
        atomic_write(path, content)
        return hashlib.sha256(content).hexdigest()


def file_sha256(path: Path) -> str:
    """SHA-256 of a file's bytes."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def read(path: Path, sha256: str | None = None) -> Recording:
    """Read and verify a recording.

    Parameters
    ----------
    path : Path
    sha256 : str, optional
        What the file's hash must be.

    Raises
    ------
    InputError
        One line: the file is missing, is no recording, or is not the one that was written.
    """
    try:
        found = file_sha256(path)
        if sha256 is not None and found != sha256:
            raise InputError(
                f"{path}: not the file that was written (SHA-256 {found[:12]}…, should be {sha256[:12]}…)"
            )
        table = pq.read_table(path, page_checksum_verification=True)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except (pa.ArrowException, OSError) as error:
        raise InputError(f"{path}: not a readable recording: {str(error).splitlines()[0]}") from None
    try:
        return _recording(table)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path}: not a recording of format {FORMAT}: {error}") from None


def kept_states(ticks: np.ndarray) -> np.ndarray:
    """The states of a lap that are kept, from all of its ticks (``loop.TICK``)."""
    kept = np.empty(-(-ticks.size // STATE_EVERY), STATE)
    for name in _UNITS:
        kept[name] = ticks[name][::STATE_EVERY]
    return kept


def _state_columns() -> list[tuple[str, str, int | None]]:
    """Each state column's name, its field of `STATE` and its place in the field."""
    columns: list[tuple[str, str, int | None]] = []
    for field, unit in _UNITS.items():
        places: list[int | None] = [*range(6)] if STATE[field].shape else [None]
        for i in places:
            parts = (field, "" if i is None else str(i + 1), unit)
            columns.append(("_".join(part for part in parts if part), field, i))
    return columns


def _table(recording: Recording) -> pa.Table:
    n = recording.triggers.size
    is_missing = np.arange(n) % STATE_EVERY != 0
    columns = {name: pa.array(recording.counts[:, i]) for i, name in enumerate(_INPUTS)}
    columns[_TRIGGERS] = pa.array(recording.triggers)
    for name, field, i in _state_columns():
        values = np.zeros(n, np.float32)
        values[::STATE_EVERY] = recording.states[field] if i is None else recording.states[field][:, i]
        columns[name] = pa.array(values, mask=is_missing)
    facts = {"format": FORMAT, **asdict(recording.facts)}
    return pa.table(columns).replace_schema_metadata({_KEY: json.dumps(facts, sort_keys=True).encode()})


def _encodings(schema: pa.Schema) -> dict[str, str]:
    """Neighbouring counts differ little; single-precision numbers compress best byte by byte."""
    encodings = dict.fromkeys(_INPUTS, "DELTA_BINARY_PACKED")
    return encodings | {name: "BYTE_STREAM_SPLIT" for name, _, _ in _state_columns()}


def _recording(table: pa.Table) -> Recording:
    """A recording from a table.

    Raises
    ------
    AttributeError, KeyError, TypeError, ValueError
        Whatever is missing or of the wrong kind.
    """
    metadata = table.schema.metadata or {}
    if _KEY not in metadata:
        raise ValueError("it says nothing about a lap")
    facts = json.loads(metadata[_KEY])
    written_as = facts.pop("format", None)
    if written_as == _OLD_FORMAT:
        facts["hand"] = None
    elif written_as != FORMAT:
        raise ValueError("it has another format")
    facts["start_rad"] = tuple(facts["start_rad"])
    operator, hand = facts["operator"], facts["hand"]
    if (operator is None) == (hand is None):
        raise ValueError("it must name either an operator or a hand")
    person = Hand(**hand) if operator is None else Operator(**operator)
    n = table.num_rows
    if n == 0 or len(facts["start_rad"]) != 6 or facts["ending"] not in range(COMPLETED, DIVERGED + 1):
        raise ValueError("its facts are incomplete")
    numbers = (*facts["start_rad"], *facts["parameters"].values(), *asdict(person).values())
    if not all(isinstance(number, int | float) for number in (*numbers, facts["seed"], facts["lap"])):
        raise ValueError("some of its facts should be numbers and are not")
    counts = np.empty((n, 6), np.int16)
    for i, name in enumerate(_INPUTS):
        counts[:, i] = _numbers(table, name, pa.int16(), 1)
    states = np.empty(-(-n // STATE_EVERY), STATE)
    for name, field, place in _state_columns():
        values = _numbers(table, name, pa.float32(), STATE_EVERY)
        if place is None:
            states[field] = values
        else:
            states[field][:, place] = values
    triggers = _numbers(table, _TRIGGERS, pa.uint8(), 1)
    return Recording(Facts(**facts), counts, triggers, states)


def _numbers(table: pa.Table, name: str, kind: pa.DataType, every: int) -> np.ndarray:
    """Every so many-th value of a column, none of them null."""
    if name not in table.column_names:
        raise ValueError(f"column {name} is missing")
    column = table.column(name)
    if column.type != kind:
        raise ValueError(f"column {name} is {column.type}, not {kind}")
    kept = column.take(pa.array(np.arange(0, table.num_rows, every)))
    if kept.null_count:
        raise ValueError(f"column {name} has gaps")
    return np.array(kept.to_numpy())


def check_same_study(facts: Facts, study_sha256: str) -> None:
    """Refuse to run a recording again for another study than it was made for.

    Raises
    ------
    InputError
        If the hashes differ.
    """
    if facts.study_sha256 != study_sha256:
        raise InputError(
            f"the recording was made for study {facts.study!r} {facts.study_sha256[:12]}…,"
            f" not for {study_sha256[:12]}…"
        )


class ReplayError(ElbowroomError):
    """A replay that doesn't give what was recorded."""
