"""A file of any container as a table: CSV, JSON, a spreadsheet, an archive of results."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from data.convert.archive import archive_names, archive_records, is_results_archive
from data.convert.delimited import Record, records
from data.convert.json_records import json_records, json_table
from data.convert.spreadsheet import spreadsheet_records
from data.convert.table import FILE, Row, Table, counted, plain
from data.errors import InputError

_SPREADSHEETS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")


@dataclass(frozen=True)
class Header:
    """The names of the columns, and how many records they take up."""

    names: tuple[str, ...]
    records: int = 1


def one_header_row(first: Sequence[Record]) -> Header:
    """The header of an ordinary table."""
    return Header(tuple(cell or "" for cell in first[0].cells))


@dataclass(frozen=True)
class Layout:
    """How a table stands in a CSV file or a spreadsheet.

    Attributes
    ----------
    header : callable
        The header from the file's first records.
    footer : str
        Text of the last line, one cell alone; a file without it is cut off.
    mend : callable
        Changes the text of a file whose quotation marks are not those of CSV.
    """

    header: Callable[[Sequence[Record]], Header] = one_header_row
    footer: str = ""
    mend: Callable[[str], str] = str


def read_table(path: Path, layout: Layout, sheet: str = "") -> Table:
    """A file as a table.

    Raises
    ------
    InputError
        One line: the file, the line and what is wrong.
    """
    name, content = str(path), _content(path)
    if content.startswith(_SPREADSHEETS):
        if is_results_archive(content):
            return _with_file(path, json_table(name, archive_records(name, content)))
        if not _is_spreadsheet(content):
            raise InputError(
                f"{name}: a damaged zip archive, or one of other files: unpack it and convert those"
            )
        return _with_file(path, _tabular(name, spreadsheet_records(name, content, sheet), layout))
    text = _text(name, content)
    if text.lstrip().startswith(("[", "{")):
        return _with_file(path, json_table(name, json_records(name, text)))
    return _with_file(path, _tabular(name, records(name, layout.mend(text)), layout))


def read_head(path: Path, sheet: str = "") -> Table:
    """A file under its first row as the header, without the rows that do not fit it."""
    name, content = str(path), _content(path)
    if content.startswith(_SPREADSHEETS) and _is_spreadsheet(content):
        lines = spreadsheet_records(name, content, sheet)
    elif content.startswith(_SPREADSHEETS) or _text(name, content).lstrip().startswith(("[", "{")):
        return read_table(path, Layout(), sheet)
    else:
        lines = records(name, _text(name, content))
    width = len(lines[0].cells) if lines else 0
    even = [line for line in lines if len(line.cells) == width and not line.has_stray_quote]
    return _with_file(path, _tabular(name, even, Layout()))


def read_tables(paths: Sequence[Path], layout: Layout, sheet: str = "") -> Table:
    """Several files of one form as one table; a column that a file lacks is empty there."""
    for number, path in enumerate(paths):
        if any(path == earlier or _is_same(path, earlier) for earlier in paths[:number]):
            raise InputError(f"{path}: the file is named twice: each answer would count twice")
    tables = [read_table(path, layout, sheet) for path in paths]
    if len(tables) == 1:
        return tables[0]
    if any(len(set(table.names)) < len(table.names) for table in tables):
        for table in tables[1:]:
            if table.names != tables[0].names:
                raise InputError(f"{table.path}: other columns than {tables[0].path}: convert it alone")
        rows = tuple(row for table in tables for row in table.rows)
        return Table(tables[0].path, tables[0].names, rows, tuple(n for t in tables for n in t.notes))
    names = tuple(dict.fromkeys(name for table in tables for name in table.names))
    joined: list[Row] = []
    for table in tables:
        place = {name: at for at, name in enumerate(table.names)}
        places = [place.get(name, -1) for name in names]
        for row in table.rows:
            cells = tuple(row.cells[at] if at >= 0 else None for at in places)
            joined.append(Row(row.path, row.line, cells))
    paths_text = " and ".join(str(path) for path in paths)
    return Table(paths_text, names, tuple(joined), tuple(note for table in tables for note in table.notes))


def _is_same(path: Path, other: Path) -> bool:
    try:
        return path.samefile(other)
    except OSError:
        return False


def _with_file(path: Path, table: Table) -> Table:
    return table.with_columns((FILE,), lambda row: (path.name,))


def _tabular(path: str, lines: list[Record], layout: Layout) -> Table:
    """Records as a table; each must have a cell for each column."""
    notes: tuple[str, ...] = ()
    if layout.footer:
        if lines and lines[-1].cells[0] == layout.footer and not any(lines[-1].cells[1:]):
            lines = lines[:-1]
        else:
            notes = (
                f"{path}: the last line is not {layout.footer}: the file is cut off, rows may be missing",
            )
    if not lines:
        raise InputError(f"{path}: the file has no rows")
    header = layout.header(lines)
    width = len(lines[0].cells)
    for record in lines:
        if len(record.cells) != width or record.has_stray_quote:
            raise _uneven(path, record, width)
    filled = [record for record in lines[header.records :] if any(record.cells)]
    rows = tuple(Row(path, record.line, record.cells) for record in filled)
    return Table(path, tuple(map(plain, header.names)), rows, notes)


def _uneven(path: str, record: Record, width: int) -> InputError:
    hint = ": a quotation mark inside a quoted text is not doubled there" if record.has_stray_quote else ""
    if len(record.cells) == width:
        return InputError(f"{path}: line {record.line}: text behind a closing quotation mark{hint}")
    cells = counted(len(record.cells), "cell")
    return InputError(f"{path}: line {record.line}: {cells}, but the header has {width} columns{hint}")


def _content(path: Path) -> bytes:
    try:
        if path.is_char_device() or path.is_block_device():
            raise InputError(f"{path}: is a device, not a file")
        content = path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder, not a file") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"{path}: cannot be read: {reason}") from None
    if not content.removeprefix(b"\xef\xbb\xbf").strip():
        raise InputError(f"{path}: the file is empty")
    return content


def _text(path: str, content: bytes) -> str:
    encoding = "utf-16" if content.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8-sig"
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}: line {line}: not UTF-8 text (byte {error.start + 1} of the file): save it as UTF-8"
        ) from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise InputError(f"{path}: line {line}: not text: a NUL byte")
    return text


def _is_spreadsheet(content: bytes) -> bool:
    if not content.startswith(b"PK"):
        return True
    return any(name.startswith("xl/") or name == "content.xml" for name in archive_names(content))
