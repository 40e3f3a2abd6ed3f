"""A table of text cells as it was read from a file, and how a column in it is named."""

import json
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from data.errors import InputError
from data.labels import plain_or_quoted, quoted

Cell = str | None
"""A cell's text; None where the file has nothing at all, unlike "", which was written."""
FILE = "@file"
"""Column with the name of the file that a row stands in."""
MOST_SHOWN, MOST_COLUMNS = 12, 60
"""Values, and names of columns to choose from, that are listed in one message."""


@dataclass(frozen=True, slots=True)
class Row:
    """A row with the line on which it begins in its file."""

    path: str
    line: int
    cells: tuple[Cell, ...]

    @property
    def where(self) -> str:
        """The row's place, for messages."""
        return f"{self.path}: line {self.line}"


@dataclass(frozen=True)
class Table:
    """All rows of one or more files of one form.

    Attributes
    ----------
    names : tuple of str
        The columns' names, blanks and line breaks in them made one blank. A name may be empty or be there
        twice. Names that begin with ``@`` are not in the file but say where a row comes from.
    rows : tuple of Row
    notes : tuple of str
        What reading the file has shown that the user should hear.
    """

    path: str
    names: tuple[str, ...]
    rows: tuple[Row, ...]
    notes: tuple[str, ...] = ()

    def with_columns(self, names: Sequence[str], cells: Callable[[Row], Sequence[Cell]]) -> "Table":
        """The table with further columns, computed from each row."""
        rows = tuple(Row(row.path, row.line, (*row.cells, *cells(row))) for row in self.rows)
        return Table(self.path, (*self.names, *names), rows, self.notes)

    @property
    def labels(self) -> str:
        """The columns as they can be named on the command line."""
        is_of_several_files = len({row.path for row in self.rows}) > 1
        labels = [
            name if self.names.count(name) == 1 else f"#{place + 1} {name}"
            for place, name in enumerate(self.names)
            if name and (name != FILE or is_of_several_files)
        ]
        return listed(labels, most=MOST_COLUMNS)

    def find(self, reference: str) -> "Column | None":
        """The column that a reference means, or None.

        A reference is a column's name; ``#4``, the fourth column; the beginning of a name and ``...``; or a
        column with JSON in it and the keys that lead to a value, such as ``response.prefer``.

        Raises
        ------
        InputError
            If several columns are meant.
        """
        reference = plain(reference)
        places = [place for place, name in enumerate(self.names) if name == reference]
        if not places and (number := re.fullmatch(r"#(\d+)", reference)):
            places = [int(number[1]) - 1] if 0 < int(number[1]) <= len(self.names) else []
        if not places and reference.endswith("..."):
            places = [place for place, name in enumerate(self.names) if name.startswith(reference[:-3])]
        if len(places) > 1:
            is_beginning = reference.endswith("...") and reference not in self.names
            which = "several columns begin so" if is_beginning else "several columns have that name"
            numbers = listed(f"#{place + 1}" for place in places)
            raise InputError(f"{self.path}: {plain_or_quoted(reference)}: {which}; write one of {numbers}")
        if places:
            return Column(reference, places[0])
        holder, _, keys = reference.rpartition(".")
        trail: list[str] = []
        while holder:
            trail.insert(0, keys)
            if self.names.count(holder) == 1:
                return Column(reference, self.names.index(holder), tuple(trail))
            holder, _, keys = holder.rpartition(".")
        return None

    def column(self, reference: str) -> "Column":
        """The column that a reference means.

        Raises
        ------
        InputError
            If there is none, listing those that there are, or if several are meant.
        """
        column = self.find(reference)
        if column is None:
            raise InputError(
                f"{self.path}: the column {plain_or_quoted(reference)} is missing; columns: {self.labels}"
            )
        return column

    def matches(self, pattern: str) -> list[str]:
        """What the ``*`` of a pattern stands for in the names that fit it; it stands for a whole number."""
        fits = re.compile(re.escape(plain(pattern)).replace(r"\*", r"(\d+)", 1))
        return [match[1] for name in self.names if (match := fits.fullmatch(name))]


@dataclass(frozen=True)
class Column:
    """A column, or a value inside the JSON of its cells."""

    name: str
    place: int
    keys: tuple[str, ...] = ()

    def text(self, row: Row) -> Cell:
        """A cell's text without blanks around it."""
        cell = row.cells[self.place]
        if cell is None:
            return None
        return self._inside(cell, row) if self.keys else cell.strip()

    def _inside(self, cell: str, row: Row) -> Cell:
        if not cell.strip():
            return None
        value = parse_json(cell, f"{row.where}, {self.name}")
        for key in self.keys:
            if isinstance(value, list) and key.isdigit() and int(key) < len(value):
                value = value[int(key)]
            elif isinstance(value, dict) and key in value:
                value = value[key]
            else:
                return None
        text = json_text(value)
        return None if text is None else text.strip()

    def error(self, row: Row, message: str) -> InputError:
        """The error for a cell."""
        return InputError(f"{row.where}, {plain_or_quoted(self.name)}: {message}")


def plain(name: str) -> str:
    """A name on one line, without blanks around it."""
    return " ".join(name.split())


def listed(texts: Iterable[str], most: int = MOST_SHOWN) -> str:
    """Texts on one line, the first ``most`` of them; one with a comma in quotes, to be one text."""
    every = [_one_of_several(name) if (name := plain(text)) else "(empty)" for text in texts]
    rest = f" and {len(every) - most} more" if len(every) > most else ""
    return ", ".join(every[:most]) + rest


def _one_of_several(name: str) -> str:
    shown = plain_or_quoted(name)
    return quoted(name) if "," in name and shown == name else shown


def counted(number: int, noun: str, plural: str | None = None) -> str:
    """A number with its noun: ``1 row``, ``2 rows``."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


_DECODER = json.JSONDecoder(parse_float=str, parse_int=str, parse_constant=str)


def decoder() -> json.JSONDecoder:
    """A JSON decoder that keeps numbers as they are written."""
    return _DECODER


def parse_json(text: str, where: str) -> object:
    """The value of a JSON text, numbers in it as text."""
    try:
        return _DECODER.decode(text)
    except (ValueError, RecursionError):
        raise InputError(f"{where}: {quoted(text)} is not JSON") from None


def json_text(value: object) -> Cell:
    """A JSON value as the text of a cell; a list or an object stays JSON."""
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value, ensure_ascii=False)
