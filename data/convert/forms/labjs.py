"""lab.js, CSV: a row a component of the experiment, also for those that only hold others.

What a person typed stands in the row of that page alone, so the person's column is filled within each file. A
cell that a spreadsheet could run as a formula has an apostrophe before it.

References
----------
lab.js, commit c7847a3: packages/library/src/data/store.ts, data/util/csv.ts, base/component.ts.
"""

from dataclasses import replace

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap
from data.convert.table import Cell, Row, Table

_FORMULA_STARTS = ("'=", "'+", "'-", "'@")


def _as_typed(table: Table, wanted: ConversionMap) -> Table:
    """Cells without the exporter's apostrophe, and each file's rows with the person that the file names."""
    person = table.column(wanted.participant).place if wanted.participant else -1
    above: dict[str, Cell] = {}
    rows: list[Row] = []
    for row in table.rows:
        cells = [cell[1:] if cell and cell.startswith(_FORMULA_STARTS) else cell for cell in row.cells]
        if person >= 0:
            cells[person] = above[row.path] = cells[person] or above.get(row.path)
        rows.append(replace(row, cells=tuple(cells)))
    return replace(table, rows=tuple(rows))


FORM = Form(
    name="labjs",
    title="lab.js",
    columns=("sender", "sender_type", "sender_id", "timestamp", "ended_on", "time_commit"),
    defaults=ConversionMap(answers=(AnswerColumn(column="response"),), empty="time limit, without answer"),
    choose_rows=("sender",),
    prepare=_as_typed,
    tell="the column that names the person, which `sender` asks (--only sender=...), which rows are "
    "practice, the columns of the two sides, what each response means",
)
