"""A matrix of counts: how often the mode of a row was preferred to that of a column, or the reverse."""

import re

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap
from data.convert.reading import FILE
from data.convert.table import Cell, Row, Table, listed
from data.errors import InputError

_COUNT = re.compile(r"\d+")


def _labelled(table: Table) -> tuple[tuple[str, ...], int]:
    """The modes, and how many columns stand before the counts: 1 with names of rows, else 0."""
    names = tuple(name for name in table.names if name != FILE)
    for before in (0, 1):
        modes = names[before:]
        rows_agree = before == 0 or tuple((row.cells[0] or "").strip() for row in table.rows) == modes
        if len(modes) == len(table.rows) > 0 and all(modes) and rows_agree:
            return modes, before
    raise InputError(
        f"{table.path}: {len(table.rows)} rows under {listed(names)}: a matrix has as many rows as modes, "
        "in the same order"
    )


def _melted(table: Table, mapping: ConversionMap) -> Table:
    """A row a cell: its two modes, the one that won, how often; cells of 0 say nothing."""
    modes, before = _labelled(table)
    if not mapping.winner:
        first = table.rows[0]
        seen = listed(
            f"{mode}: {(first.cells[place + before] or '').strip()}" for place, mode in enumerate(modes)
        )
        raise InputError(
            f"{first.where}: {seen}: nothing says whether the mode of the row or of the column was preferred "
            "so often; tell it by --winner rows or --winner columns"
        )
    rows = []
    for mode, row in zip(modes, table.rows, strict=True):
        for other, cell in zip(modes, row.cells[before:], strict=False):
            count = _count(row, mode, other, cell)
            if count:
                winner = mode if mapping.winner == "rows" else other
                rows.append(Row(row.path, row.line, (mode, other, winner, str(count))))
    return Table(table.path, ("@row", "@column", "@winner", "@count"), tuple(rows), table.notes)


def _count(row: Row, mode: str, other: str, cell: Cell) -> int:
    text = (cell or "").strip() or "0"
    if not _COUNT.fullmatch(text):
        raise InputError(f"{row.where}, {other}: {text!r} is not a whole number")
    if mode == other and int(text):
        raise InputError(f"{row.where}, {other}: {text} on the diagonal, where a mode meets itself")
    return int(text)


def _looks_like(table: Table) -> bool:
    try:
        _labelled(table)
    except InputError:
        return False
    cells = [(cell or "").strip() for row in table.rows for cell in row.cells[1:-1]]
    return len(table.rows) > 1 and all(cell == "" or _COUNT.fullmatch(cell) for cell in cells)


FORM = Form(
    name="matrix-counts",
    title="a matrix of counts",
    defaults=ConversionMap(
        participant="",
        answers=(AnswerColumn(chosen="@winner", left="@row", right="@column", sides="unknown"),),
        count="@count",
    ),
    prepare=_melted,
    tell="who was preferred in a cell: --winner rows or --winner columns",
    recognise=_looks_like,
)
