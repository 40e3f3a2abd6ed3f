"""JSON as exporters write it: one array, JSON Lines, or several documents end to end."""

from dataclasses import dataclass

from data.convert.table import Cell, Row, Table, decoder, json_text, plain
from data.errors import InputError
from data.labels import plain_or_quoted

ARRAY = "@array"
"""Column with the number of the array, from 1, that a record stands in; empty outside of arrays."""
_BLANK = " \t\r\n"


@dataclass(frozen=True)
class JsonRecord:
    """An object with the line on which it begins and the number of its array, 0 outside of arrays.

    ``path`` is the file inside an archive.
    """

    line: int
    array: int
    fields: dict[str, object]
    path: str = ""


def json_table(path: str, records: list[JsonRecord]) -> Table:
    """Records as a table: a column a key, in the order in which the keys appear."""
    names: dict[str, int] = {}
    for record in records:
        for key in record.fields:
            names.setdefault(key, len(names))
    rows = []
    for record in records:
        cells: list[Cell] = [None] * len(names)
        for key, value in record.fields.items():
            cells[names[key]] = json_text(value)
        rows.append(
            Row(record.path or path, record.line, (*cells, str(record.array) if record.array else None))
        )
    return Table(path, (*map(plain, names), ARRAY), tuple(rows))


def json_records(path: str, text: str) -> list[JsonRecord]:
    """The objects of all documents in a text.

    Raises
    ------
    InputError
        Where the text is not JSON, or something else than objects stands in it.
    """
    places = _Places(path, text)
    records: list[JsonRecord] = []
    at, arrays = places.next(0), 0
    while at < len(text):
        if text[at] != "[":
            fields, end = places.fields(at)
            records.append(JsonRecord(places.line(at), 0, fields))
        else:
            arrays += 1
            inside = places.next(at + 1)
            while not text.startswith("]", inside):
                fields, end = places.fields(inside)
                records.append(JsonRecord(places.line(inside), arrays, fields))
                inside = places.behind_element(end)
            end = inside + 1
        at = places.next(end)
        if at < len(text) and text[at] == ",":
            raise places.error(at, "a comma between two documents")
    if not records:
        raise InputError(f"{path}: JSON without records")
    return records


class _Places:
    """Goes through a text from its beginning to its end and knows the line it is on."""

    def __init__(self, path: str, text: str) -> None:
        self.path, self.text = path, text
        self._at, self._line = 0, 1

    def line(self, at: int) -> int:
        """The line of a place; places only ever move on."""
        self._line += self.text.count("\n", self._at, at)
        self._at = max(at, self._at)
        return self._line

    def error(self, at: int, message: str) -> InputError:
        return InputError(f"{self.path}: line {self.line(at)}: not valid JSON: {message}")

    def next(self, at: int) -> int:
        """The next place that is not blank."""
        while at < len(self.text) and self.text[at] in _BLANK:
            at += 1
        return at

    def fields(self, at: int) -> tuple[dict[str, object], int]:
        """The object that begins here, and where it ends."""
        try:
            value, end = decoder().raw_decode(self.text, at)
        except ValueError as error:
            at = getattr(error, "pos", at)
            message = getattr(error, "msg", str(error))
            raise self.error(max(at, self._at), message[0].lower() + message[1:]) from None
        except RecursionError:
            raise self.error(at, "nested too deeply") from None
        if not isinstance(value, dict):
            raise self.error(at, f"{plain_or_quoted(self.text[at:end])} where an object is needed")
        return value, end

    def behind_element(self, at: int) -> int:
        """The place of the next element of an array, or of the bracket that closes it."""
        at = self.next(at)
        if self.text.startswith(",", at):
            return self.next(at + 1)
        if not self.text.startswith("]", at):
            raise self.error(at, "neither a comma nor a closing bracket behind an element of an array")
        return at
