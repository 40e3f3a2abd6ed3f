"""formr.org, CSV: a row a run through the survey.

A session whose code has XXX in it was made by the researcher: a test run, or a person whom the researcher
named. The file does not say which, so it has to be told.

References
----------
formr.org, commit 11b5a85: in application/, Model/SurveyStudy.php (columns), Model/RunSession.php (codes of
sessions) and Spreadsheet/SpreadsheetReader.php (CSV by PhpSpreadsheet).
"""

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule
from data.convert.table import Row, Table

SESSION = "@session"
"""Column that says who made a row's session."""
_MARK = "XXX"


def _with_makers(table: Table, wanted: ConversionMap) -> Table:
    column = table.find("session")
    if column is None:
        return table

    def maker(row: Row) -> tuple[str]:
        code = column.text(row) or ""
        return (f"researcher:{code.partition(_MARK)[0]}" if _MARK in code else "participant",)

    return table.with_columns((SESSION,), maker)


FORM = Form(
    name="formr",
    title="formr.org",
    columns=("session", "session_id", "study_id", "iteration", "created", "modified", "ended", "expired"),
    defaults=ConversionMap(
        participant="session",
        rows=(RowRule(column="ended", without=("",), reason="unfinished", optional=True),),
    ),
    choose_rows=(SESSION,),
    prepare=_with_makers,
    tell="the answer columns and what stood on each side (--pair), what each code means, and which sessions "
    "that the researcher made (XXX in the code) are people",
)
