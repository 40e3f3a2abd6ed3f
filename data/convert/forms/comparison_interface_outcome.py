"""Comparison Interface, outcome table: nobody is named, and 0 means the first item here, 1 elsewhere."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="comparison-interface-outcome",
    title="Comparison Interface, outcome table",
    columns=("item_1_id", "item_2_id", "outcome"),
    defaults=ConversionMap(
        participant="",
        answers=(AnswerColumn(column="outcome", left="item_1_id", right="item_2_id"),),
    ),
    tell="what each number means; it differs between exporters",
)
