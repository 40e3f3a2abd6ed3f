"""jsPsych, CSV (DataPipe, Pavlovia, cognition.run): several answers may stand in one cell, as JSON."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="jspsych",
    title="jsPsych, CSV",
    columns=("rt", "response", "trial_type", "trial_index", "time_elapsed"),
    defaults=ConversionMap(
        answers=(AnswerColumn(column="response"),),
        words={"null": "none: without answer"},
        empty="without answer",
    ),
    choose_rows=("task", "trial_type"),
    tell="the participant's column, the columns of the two sides, what each word or button means (0 is the "
    "first button), which rows are comparisons; keys of JSON in `response` are the questions",
)
