"""Gorilla, task builder 1: a row a screen; answers are the rows whose Zone Type begins with response_."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap, RowRule
from data.convert.reading import Layout

FORM = Form(
    name="gorilla",
    title="Gorilla, task builder 1",
    columns=("Event Index", "Participant Private ID", "Trial Number", "Zone Type", "Response"),
    defaults=ConversionMap(
        participant="Participant Private ID",
        answers=(AnswerColumn(column="Response"),),
        rows=(
            RowRule(
                column="Zone Type",
                only=("response_*", "timelimit_screen"),
                reason="no answer screen",
                optional=True,
            ),
        ),
        empty="time limit, without answer",
    ),
    choose_rows=("display",),
    layout=Layout(footer="END OF FILE"),
    tell="the columns of the two sides, what each answer means, which `display` counts (not practice)",
)
