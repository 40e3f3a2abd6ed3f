"""Qualtrics, CSV or TSV, choice texts or numeric values, also with loop and merge.

Three header rows: names; the questions' texts; JSON with an ImportId. Status and Finished have texts or
codes, after what was chosen for the answers.
"""

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule
from data.convert.table import Table

_HEADER_ROWS = 3
"""Rows below the names in which the ImportId is looked for."""


def _without_header_rows(table: Table, mapping: ConversionMap) -> Table:
    """Without the rows of question texts and of import ids, wherever they still are."""
    for place, row in enumerate(table.rows[:_HEADER_ROWS]):
        if any(cell and cell.startswith('{"ImportId"') for cell in row.cells):
            return Table(table.path, table.names, table.rows[place + 1 :], table.notes)
    note = "no row of import ids below the names: all rows below the first are taken as people"
    return Table(table.path, table.names, table.rows, (*table.notes, note))


FORM = Form(
    name="qualtrics",
    title="Qualtrics",
    columns=("StartDate", "EndDate", "Status", "Finished", "RecordedDate", "ResponseId"),
    defaults=ConversionMap(
        participant="ResponseId",
        rows=(
            RowRule(
                column="Status",
                without=("Survey Preview", "1", "Offline Survey Preview", "17"),
                reason="survey preview",
                optional=True,
            ),
            RowRule(column="Status", without=("Survey Test", "2"), reason="survey test", optional=True),
            RowRule(
                column="Status",
                without=("Spam", "8", "9", "12", "40"),
                reason="marked as spam",
                optional=True,
            ),
            RowRule(column="Finished", without=("False", "0"), reason="unfinished", optional=True),
        ),
    ),
    ranking_cells="ranks",
    prepare=_without_header_rows,
    tell="the answer columns, what stood on each side, and what each word or code means (codes have gaps)",
)
