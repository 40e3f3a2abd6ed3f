"""CSV files in every dialect that exporters write: separators, quotation marks, marks, line breaks.

An empty cell is None, and "" where the file has two quotation marks: some exporters tell by that whether a
question was asked. A quotation mark inside an unquoted cell is text.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from data.convert.table import Cell
from data.errors import InputError

SEPARATORS = (",", ";", "\t", "|")
_QUOTED = re.compile(r'"((?:[^"]|"")*+)"')


@dataclass(frozen=True, slots=True)
class Record:
    """The cells between two line breaks that are not quoted.

    Attributes
    ----------
    has_stray_quote : bool
        Whether text follows a closing quotation mark, so that it is uncertain where the cell ends.
    """

    line: int
    cells: tuple[Cell, ...]
    has_stray_quote: bool = False


def records(path: str, text: str, separator: str | None = None) -> list[Record]:
    """The records of a text without its blank lines.

    Parameters
    ----------
    path : str
        For messages.
    text : str
        With line breaks as they are in the file.
    separator : str, optional
        Otherwise the one that splits the first line most often.

    Raises
    ------
    InputError
        If a quotation mark is never closed.
    """
    text = with_line_feeds(text)
    first_line = 1
    if named := re.match(r"sep=(.)\n", text):
        separator, text, first_line = named[1], text[named.end() :], 2
    if separator is None:
        separator = _separator(text)
    return list(_records(path, text, separator, first_line))


def with_line_feeds(text: str) -> str:
    r"""The text with one line feed for each line break, also for ``\r\r\n`` as Windows may write it."""
    if "\n" in text:
        return re.sub(r"\r+\n", "\n", text)
    return text.replace("\r", "\n")


def _separator(text: str) -> str:
    header = _QUOTED.sub("", text[: text.find("\n") if "\n" in text else len(text)])
    return max(SEPARATORS, key=header.count)


def _records(path: str, text: str, separator: str, line: int) -> Iterator[Record]:
    at, end = 0, len(text)
    unquoted = re.compile(rf"[^\n{re.escape(separator)}]*")
    while at < end:
        stop = text.find("\n", at)
        stop = end if stop < 0 else stop
        if '"' not in text[at:stop]:
            if text[at:stop].strip(" "):
                yield Record(line, tuple(cell or None for cell in text[at:stop].split(separator)))
            at, line = stop + 1, line + 1
            continue
        cells, after, is_stray = _quoted_record(path, text, at, separator, unquoted, line)
        yield Record(line, cells, is_stray)
        line += text.count("\n", at, after)
        at = after


def _quoted_record(
    path: str, text: str, at: int, separator: str, unquoted: re.Pattern[str], line: int
) -> tuple[tuple[Cell, ...], int, bool]:
    """The cells of a record with quotation marks, where the next one begins, and whether one is stray."""
    cells: list[Cell] = []
    stray = False
    while True:
        cell: Cell
        if text.startswith('"', at):
            match = _QUOTED.match(text, at)
            if match is None:
                raise InputError(f"{path}: line {line}: a quotation mark is opened and never closed")
            tail = unquoted.match(text, match.end())
            assert tail is not None
            stray = stray or bool(tail[0].strip())
            cell, at = match[1].replace('""', '"') + tail[0].rstrip(), tail.end()
        else:
            match = unquoted.match(text, at)
            assert match is not None
            cell, at = match[0] or None, match.end()
        cells.append(cell)
        if not text.startswith(separator, at):
            return tuple(cells), at + 1, stray
        at += 1
