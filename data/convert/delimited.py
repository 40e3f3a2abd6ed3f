"""CSV files in every dialect that exporters write: separators, quotation marks, marks, line breaks.

An empty cell is None, and "" where the file has two quotation marks: some exporters tell by that whether a
question was asked. A quotation mark inside an unquoted cell is text.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from data.convert.table import Cell
from data.errors import InputError

_LINES_TO_LOOK_AT = 20
SEPARATORS = (",", ";", "\t", "|")
_INSIDE = r'[^"]*+(?:""[^"]*+)*+'
_QUOTED = re.compile(f'"{_INSIDE}"')


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
        Otherwise the one that gives the first lines equal numbers of cells, or else splits the header most
        often.

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
        separator = _separator(path, text)
    return list(_records(path, text, separator, first_line))


def with_line_feeds(text: str) -> str:
    r"""The text with one line feed for each line break, also for ``\r\r\n`` as Windows may write it."""
    if "\n" in text:
        return re.sub(r"\r+\n", "\n", text)
    return text.replace("\r", "\n")


def _separator(path: str, text: str) -> str:
    """The separator of a text that begins with its header."""
    widths: dict[str, set[int]] = {}
    for mark in SEPARATORS:
        try:
            first = islice(_records(path, text, mark, 1), _LINES_TO_LOOK_AT)
            widths[mark] = {len(record.cells) for record in first if not record.has_stray_quote}
        except InputError:
            continue
    even = {mark: max(numbers) for mark, numbers in widths.items() if len(numbers) == 1 and max(numbers) > 1}
    if even:
        return max(even, key=lambda mark: even[mark])
    header = _QUOTED.sub("", text.partition("\n")[0])
    return max(SEPARATORS, key=header.count)


def _records(path: str, text: str, separator: str, line: int) -> Iterator[Record]:
    at, end = 0, len(text)
    between = rf"[^\n{re.escape(separator)}]*+"
    # A quoted cell and what follows its closing mark, or else all up to the next separator or line feed.
    cell = re.compile(rf'(?:"({_INSIDE})"({between})|({between}))(\n|{re.escape(separator)}|\Z)')
    while at < end:
        stop = text.find("\n", at)
        stop = end if stop < 0 else stop
        plain = text[at:stop]
        if '"' not in plain:
            if plain.strip(" "):
                yield Record(line, tuple([cell or None for cell in plain.split(separator)]))
            at, line = stop + 1, line + 1
            continue
        cells: list[Cell] = []
        has_stray_quote = False
        after = at
        for match in cell.finditer(text, at):
            quoted, tail, unquoted, closes = match.groups()
            if unquoted is not None:
                if unquoted.startswith('"'):
                    raise InputError(f"{path}: line {line}: a quotation mark is opened and never closed")
                cells.append(unquoted or None)
            else:
                if tail:
                    has_stray_quote = has_stray_quote or bool(tail.strip())
                    quoted += tail.rstrip()
                cells.append(quoted.replace('""', '"') if '"' in quoted else quoted)
            if closes != separator:
                after = match.end()
                break
        yield Record(line, tuple(cells), has_stray_quote)
        line += text.count("\n", at, after)
        at = after
