"""JATOS: result data (JSON arrays, often several end to end) or a results archive, filled by jsPsych."""

from data.convert.archive import RESULT, WORKER
from data.convert.form import Form
from data.convert.json_records import ARRAY
from data.convert.map import AnswerColumn, ConversionMap, RowRule
from data.convert.table import Table


def _looks_like(table: Table) -> bool:
    return ARRAY in table.names and (
        RESULT in table.names or {"trial_type", "trial_index"} <= set(table.names)
    )


FORM = Form(
    name="jatos",
    title="JATOS results, of jsPsych",
    defaults=ConversionMap(
        answers=(AnswerColumn(column="response"),),
        rows=(
            RowRule(
                column=WORKER, without=("Jatos",), reason="run by a JATOS user", per=RESULT, optional=True
            ),
        ),
        empty="without answer",
    ),
    choose_rows=("task", "trial_type"),
    tell="the columns of the two sides, what each button means (0 is the first), which rows are comparisons, "
    f"who answered: a column, or `{RESULT}` in an archive, or a URL parameter as `@url.NAME`",
    recognise=_looks_like,
)
