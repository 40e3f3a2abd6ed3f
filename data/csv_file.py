"""Reading a CSV file that others wrote: strictly, in bounded memory, with errors that name the line.

A file is UTF-8 with or without a byte-order mark, has commas, a header, and one cell per column in
every row. Anything else is an error that says where, never a guess.
"""

import csv
import hashlib
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.csv

from data.errors import InputError
from data.labels import as_known, plain_or_quoted, quoted

if TYPE_CHECKING:
    import _csv

_CHUNK = 50_000
"""Rows that are in memory as Python objects at once."""
LARGE = 1_000_000
"""Bytes from which on a file is worth the fast reader."""
_TEXTS = pa.dictionary(pa.int32(), pa.string())


@dataclass(frozen=True)
class Column:
    """A column as the distinct texts in it, in order of first appearance.

    Attributes
    ----------
    values : tuple of str
        The distinct texts.
    codes : ndarray of int32, shape (rows,)
        Place of each row's text in ``values``.
    """

    values: tuple[str, ...]
    codes: np.ndarray

    def first_row(self, value: int) -> int:
        """The first row, from 0, that holds ``values[value]``."""
        return int(np.argmax(self.codes == value))


@dataclass(frozen=True)
class CsvFile:
    """A CSV file as read, all cells as text.

    Attributes
    ----------
    notes : tuple of str
        What a reader must know of how it was read, a sentence each.
    """

    path: Path
    content: bytes
    names: tuple[str, ...]
    columns: dict[str, Column]
    rows: int
    notes: tuple[str, ...] = ()

    @property
    def sha256(self) -> str:
        """Hash of the file's bytes."""
        return hashlib.sha256(self.content).hexdigest()

    def text(self, row: int, column: str) -> str:
        """A cell; ``row`` counts from 0 below the header."""
        texts = self.columns[column]
        return texts.values[texts.codes[row]]

    def error(self, row: int, column: str, message: str) -> InputError:
        """The error for a cell; ``row`` counts from 0 below the header."""
        return InputError(f"{self.path}: line {self.line(row)}, {column}: {message}")

    def line(self, row: int) -> int:
        """The line in the file on which a row begins; ``row`` counts from 0 below the header."""
        return self.lines((row,))[0]

    def lines(self, rows: Sequence[int]) -> tuple[int, ...]:
        """The lines on which rows begin, in one pass through the file."""
        return _lines_of_rows(self.content, rows)

    def check_each(self, column: str, problem: Callable[[str], str | None]) -> None:
        """Raise for the first row whose text has a problem; each distinct text is looked at once."""
        texts = self.columns[column]
        # Distinct texts stand in order of first appearance, so the first bad one is the earliest.
        for value, text in enumerate(texts.values):
            said = problem(text)
            if said is not None:
                raise self.error(texts.first_row(value), column, said)


def read_csv_file(path: Path, required: Sequence[str], kind: str, optional: Sequence[str] = ()) -> CsvFile:
    """Read a CSV file.

    A column whose name differs from a known one only by blanks, characters that cannot be seen or capital
    letters is read as that one, and a note says so.

    Parameters
    ----------
    path : Path
    required : sequence of str
        Columns that must be there; others are read as well.
    kind : str
        What the rows are, for the error about a header without rows, e.g. ``responses``.
    optional : sequence of str
        Further columns whose names have a meaning.

    Raises
    ------
    InputError
        One line: the file, the line and what is wrong.
    """
    content = _read_bytes(path)
    try:
        names, notes, parts, rows = _parse(path, content, required, optional)
    except csv.Error as error:
        raise InputError(f"{path}: line {_line_of_csv_error(content)}: not valid CSV: {error}") from None
    if rows == 0:
        raise InputError(f"{path}: line 1: a header without rows: there are no {kind}")
    columns = {name: _column(chunks) for name, chunks in zip(names, parts, strict=True)}
    return CsvFile(path, content, names, columns, rows, notes)


def _column(chunks: pa.ChunkedArray) -> Column:
    encoded = chunks.unify_dictionaries().combine_chunks()
    if isinstance(encoded, pa.ChunkedArray):
        encoded = encoded.chunk(0)
    # Parts are unified one after the other: the texts stand in order of first appearance.
    return Column(tuple(encoded.dictionary.to_pylist()), encoded.indices.to_numpy())


def _parse(
    path: Path, content: bytes, required: Sequence[str], optional: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...], list[pa.ChunkedArray], int]:
    """The header, notes on it, the columns as dictionaries, and the number of rows."""
    records = _records(content)
    header = tuple(next(records, ()))
    known = as_known(header, (*required, *optional))
    names = tuple(known.get(name, name) for name in header)
    notes = _about_columns(known)
    _check_header(path, header, names, required)
    table = _parse_plain(content)
    if table is not None:
        return names, notes, table.columns, table.num_rows
    parts: list[list[pa.Array]] = [[] for _ in names]
    rows = 0
    while chunk := list(islice(records, _CHUNK)):
        if set(map(len, chunk)) != {len(names)}:
            place = next(k for k, record in enumerate(chunk) if len(record) != len(names))
            line = _lines_of_rows(content, (rows + place,))[0]
            cells = len(chunk[place])
            raise InputError(
                f"{path}: line {line}: {cells} {'cell' if cells == 1 else 'cells'}, "
                f"but the header has {len(names)} columns: {_listed(names)}"
            )
        for part, texts in zip(parts, zip(*chunk, strict=True), strict=True):
            part.append(pa.array(texts, pa.string()).dictionary_encode())
        rows += len(chunk)
    return names, notes, [pa.chunked_array(part, _TEXTS) for part in parts], rows


def _about_columns(known: Mapping[str, str]) -> tuple[str, ...]:
    if not known:
        return ()
    pairs = ", ".join(f"{quoted(name)} as {column}" for name, column in known.items())
    return (f"Column names were read without blanks and capital letters: {pairs}.",)


def _parse_plain(content: bytes) -> pa.Table | None:
    """The rows of a large file without quotes, ten times as fast; None if it has to be read with care.

    Without quotes there is but one way to read a file. Whatever is wrong with it is left to the
    careful reader, which can say where.
    """
    if len(content) < LARGE or b'"' in content or b"\r" in content.replace(b"\r\n", b"\n"):
        return None
    try:
        return pyarrow.csv.read_csv(
            pa.BufferReader(content),
            parse_options=pyarrow.csv.ParseOptions(quote_char=False),
            convert_options=pyarrow.csv.ConvertOptions(default_column_type=_TEXTS, strings_can_be_null=False),
        )
    except pa.ArrowInvalid:
        return None


def _listed(names: Sequence[str]) -> str:
    """Column names on one line, however odd they are."""
    return ", ".join(plain_or_quoted(name) if name else "(without name)" for name in names)


def _check_header(
    path: Path, header: tuple[str, ...], names: tuple[str, ...], required: Sequence[str]
) -> None:
    """Every required column is there, and no column twice; ``names`` are those of the header as read."""
    for name in required:
        if name not in names:
            other = next((mark for mark in (";", "\t") if len(names) == 1 and mark in names[0]), None)
            hint = f" (cells are separated by commas, not by {other!r})" if other else ""
            raise InputError(f"{path}: line 1: the column {name} is missing; found: {_listed(names)}{hint}")
    for name in names:
        if names.count(name) > 1:
            spelled = dict.fromkeys(
                as_written for as_written, n in zip(header, names, strict=True) if n == name
            )
            how = f", as {' and '.join(map(quoted, spelled))}" if len(spelled) > 1 else ""
            raise InputError(f"{path}: line 1: the column {_listed([name])} is there twice{how}")


def _read_bytes(path: Path) -> bytes:
    """The file's bytes, known to be text."""
    try:
        if path.is_char_device() or path.is_block_device():
            raise InputError(f"{path}: is a device, not a CSV file")
        content = path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder, not a CSV file") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"{path}: cannot be read: {reason}") from None
    if not content.removeprefix(b"\xef\xbb\xbf").strip():
        raise InputError(f"{path}: the file is empty")
    try:
        content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = _physical_line(content, error.start)
        raise InputError(
            f"{path}: line {line}: not UTF-8 text (byte {error.start + 1} of the file)"
        ) from None
    at = content.find(b"\0")
    if at >= 0:
        raise InputError(f"{path}: line {_physical_line(content, at)}: not text: a NUL byte")
    return content


def _reader(content: bytes) -> "_csv.Reader":
    return csv.reader(io.TextIOWrapper(io.BytesIO(content), "utf-8-sig", newline=""), strict=True)


def _records(content: bytes) -> Iterator[list[str]]:
    """The file's records without its empty lines."""
    return filter(None, _reader(content))


def _lines_of_rows(content: bytes, rows: Sequence[int]) -> tuple[int, ...]:
    """The line on which each row begins; a cell may go over several lines."""
    reader = _reader(content)
    begins, row, last = 1, -2, max(rows)
    line_of: dict[int, int] = {}
    for record in reader:
        if record:
            row += 1
            if row in rows:
                line_of[row] = begins
            if row == last:
                break
        begins = reader.line_num + 1
    # A row beyond the last record is where the file ends.
    return tuple(line_of.get(row, begins) for row in rows)


def _line_of_csv_error(content: bytes) -> int:
    """The line on which the record begins that is no valid CSV."""
    reader = _reader(content)
    begins = 1
    try:
        for _ in reader:
            begins = reader.line_num + 1
    except csv.Error:
        pass
    return begins


def _physical_line(content: bytes, at: int) -> int:
    before = content[:at].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return before.count(b"\n") + 1
