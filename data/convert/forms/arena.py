"""Arena votes (FastChat), JSON or JSON Lines; a vote is blinded where ``anony`` is true."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap, RowRule

FORM = Form(
    name="arena",
    title="arena votes",
    columns=("model_a", "model_b", "winner", "judge"),
    defaults=ConversionMap(
        participant="judge",
        answers=(AnswerColumn(column="winner", left="model_a", right="model_b"),),
        words={"model_a": "A", "model_b": "B", "tie": "equal", "tie (bothbad)": "equal"},
        rows=(
            RowRule(column="anony", without=("false",), reason="vote that was not blinded", optional=True),
        ),
        keep=("winner",),
    ),
    tell="nothing",
)
