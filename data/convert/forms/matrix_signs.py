"""A matrix of signs for each person: each pair stands twice, mirrored.

The first column names the person in the first row of a block, the second the row's mode; the others are
modes.
"""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap
from data.convert.reading import FILE
from data.convert.table import Row, Table, listed
from data.errors import InputError

_BEFORE = 2
"""Columns before the signs."""


def _melted(table: Table, mapping: ConversionMap) -> Table:
    """A row a sign: the person, the two modes, the sign."""
    modes = tuple(name for name in table.names if name != FILE)[_BEFORE:]
    rows = []
    person: str | None = None
    for row in table.rows:
        person = (row.cells[0] or "").strip() or person
        mode = (row.cells[1] or "").strip()
        if mode not in modes:
            raise InputError(f"{row.where}, {table.names[1]}: {mode!r} is not one of: {listed(modes)}")
        for other, cell in zip(modes, row.cells[_BEFORE:], strict=False):
            if cell and cell.strip():
                rows.append(Row(row.path, row.line, (person, mode, other, cell)))
    return Table(table.path, ("@person", "@row", "@column", "@sign"), tuple(rows), table.notes)


def _looks_like(table: Table) -> bool:
    modes = set(table.names[_BEFORE:-1])
    texts = [(row.cells[1] or "").strip() for row in table.rows] if len(table.names) > _BEFORE else []
    return len(modes) > 1 and bool(texts) and set(texts) <= modes


FORM = Form(
    name="matrix-signs",
    title="a matrix of signs for each person",
    defaults=ConversionMap(
        participant="@person",
        answers=(AnswerColumn(column="@sign", left="@row", right="@column", sides="unknown"),),
        each_pair_once=True,
    ),
    prepare=_melted,
    tell="what each sign means; A: the mode of the row is preferred",
    recognise=_looks_like,
)
