"""The stuck CSV: which comparisons had the robot stuck under which mode, as found elsewhere.

``comparison``
    Required: as in the response CSV that was imported before.
``mode``
    Required: the mode under which it happened.
``participant``
    Required if the responses had it.
``stuck`` or ``kind``
    One of them is required. With ``stuck`` (true or false) a row says whether the robot got stuck in
    that comparison under that mode. With ``kind`` (``stuck``, ``elbow_inversion``,
    ``protective_stop``) a row is an event, and what no row names had none.
``time_s``
    Optional: when it happened, since the start of the trial [s].
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from data.csv_file import CsvFile, read_csv_file
from data.errors import InputError
from data.labels import plain_or_quoted, quoted
from data.records import EventKind, StuckEvent
from data.study import Study

_TRUE, _FALSE = ("true", "1"), ("false", "0")
EXTERNAL = "external"
"""The definition of a stuck event that others found."""


@dataclass(frozen=True)
class StuckStatement:
    """One row of a stuck CSV.

    Attributes
    ----------
    row : int
        From 0, below the header.
    participant : str
        "" if the file has no such column.
    event : StuckEvent or None
        None if the row says that nothing happened.
    """

    row: int
    participant: str
    comparison: str
    mode: str
    event: StuckEvent | None


@dataclass(frozen=True)
class StuckFile:
    """A stuck CSV, every cell of it validated.

    Attributes
    ----------
    is_complete : bool
        True if comparisons that no row names had no event (the file has a column ``kind``).
    repeated : frozenset of int
        Rows that say again what an earlier row says.
    notes : tuple of str
        What a reader must know of how the file was read, a sentence each.
    """

    file: CsvFile
    is_complete: bool
    repeated: frozenset[int]
    notes: tuple[str, ...]

    def statements(self) -> Iterator[StuckStatement]:
        """The rows, in order, each statement once."""
        column = "kind" if self.is_complete else "stuck"
        for row in range(self.file.rows):
            if row in self.repeated:
                continue
            said = self.file.text(row, column)
            time = self.file.text(row, "time_s") if "time_s" in self.file.columns else ""
            kind: EventKind = next((kind for kind in get_args(EventKind) if kind == said), "stuck")
            event = StuckEvent(kind, float(time) if time else math.nan, math.nan, "", EXTERNAL)
            yield StuckStatement(
                row,
                self.file.text(row, "participant") if "participant" in self.file.columns else "",
                self.file.text(row, "comparison"),
                self.file.text(row, "mode"),
                event if self.is_complete or said.lower() in _TRUE else None,
            )


def read_stuck_csv(path: Path, study: Study) -> StuckFile:
    """Read a stuck CSV.

    Raises
    ------
    InputError
        One line: the file, the line, the column and the valid values.
    """
    file = read_csv_file(
        Path(path), ("comparison", "mode"), "stuck events", ("participant", "stuck", "kind", "time_s")
    )
    is_complete = "kind" in file.columns
    if not is_complete and "stuck" not in file.columns:
        columns = ", ".join(map(plain_or_quoted, file.names))
        raise InputError(f"{path}: line 1: a column stuck or kind is needed; found: {columns}")
    if is_complete:
        file.check_each("kind", lambda text: _one_of(text, get_args(EventKind)))
    else:
        file.check_each("stuck", lambda text: _one_of(text.lower(), (*_TRUE, *_FALSE)))
    file.check_each("mode", lambda text: _one_of(text, study.mode_names))
    for column in ("comparison", "participant"):
        if column in file.columns:
            file.check_each(column, lambda text: None if text else "empty, but a value is needed")
    if "time_s" in file.columns:
        file.check_each("time_s", _time_problem)
    repeated = _repeated(file, is_complete)
    notes = list(file.notes)
    if repeated:
        n = len(repeated)
        are = "row repeats an earlier one and is" if n == 1 else "rows repeat earlier ones and are"
        notes.append(f"{n} {are} counted once.")
    return StuckFile(file, is_complete, repeated, tuple(notes))


def _repeated(file: CsvFile, is_complete: bool) -> frozenset[int]:
    """Rows that say the same as an earlier one; two events of a kind without times may well be two.

    Raises
    ------
    InputError
        For a row that says the contrary of an earlier one.
    """
    stated: dict[tuple[str, ...], tuple[bool, int]] = {}
    seen: set[tuple[str, ...]] = set()
    again = set()
    who = ("participant",) if "participant" in file.columns else ()
    for row in range(file.rows):
        key = tuple(file.text(row, name) for name in (*who, "comparison", "mode"))
        time = file.text(row, "time_s") if "time_s" in file.columns else ""
        if is_complete:
            statement, is_one = (*key, file.text(row, "kind"), time), time != ""
        else:
            is_stuck = file.text(row, "stuck").lower() in _TRUE
            earlier, place = stated.setdefault(key, (is_stuck, row))
            if earlier != is_stuck:
                raise file.error(row, "stuck", f"says the contrary of line {file.line(place)}")
            statement, is_one = (*key, time), True
        if is_one and statement in seen:
            again.add(row)
        seen.add(statement)
    return frozenset(again)


def _one_of(text: str, valid: tuple[str, ...]) -> str | None:
    return None if text in valid else f"{quoted(text)} is not one of: {', '.join(valid)}"


def _time_problem(text: str) -> str | None:
    if not text or re.fullmatch(r"(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,2})?", text, re.ASCII):
        return None
    return f"{quoted(text)} is not a number of seconds from 0"
