"""Arena votes (Kaggle): three columns of which one is 1; nobody is named."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="arena-one-hot",
    title="arena votes, one column an outcome",
    columns=("model_a", "model_b", "winner_model_a", "winner_model_b", "winner_tie"),
    defaults=ConversionMap(
        participant="",
        answers=(
            AnswerColumn(
                left="model_a",
                right="model_b",
                one_of={"winner_model_a": "A", "winner_model_b": "B", "winner_tie": "equal"},
            ),
        ),
    ),
    tell="nothing",
)
