"""Comparison Interface, comparison table: the state, and which item was selected."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="comparison-interface",
    title="Comparison Interface, comparison table",
    columns=("comparison_id", "participant_id", "item_1_id", "item_2_id", "selected_item_id", "state"),
    defaults=ConversionMap(
        participant="participant_id",
        answers=(
            AnswerColumn(column="state", left="item_1_id", right="item_2_id", chosen="selected_item_id"),
        ),
        words={"selected": "chosen", "tied": "equal", "skipped": "none: skipped"},
    ),
    tell="nothing",
)
