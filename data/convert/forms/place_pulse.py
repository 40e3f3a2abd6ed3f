"""Image pairs, as of Place Pulse: left, right or equal; the study is the question, and nobody is named."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="place-pulse",
    title="image pairs (Place Pulse)",
    columns=("left_id", "right_id", "winner", "study_id"),
    defaults=ConversionMap(
        participant="",
        answers=(
            AnswerColumn(column="winner", left="left_id", right="right_id", question_column="study_id"),
        ),
        words={"left": "A", "right": "B", "equal": "equal"},
    ),
    tell="nothing",
)
