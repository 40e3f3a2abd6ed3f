"""Label Studio, CSV of a pairwise task: the answer is JSON in the column of the control tag."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="label-studio",
    title="Label Studio, pairwise",
    columns=("annotation_id", "annotator", "lead_time"),
    defaults=ConversionMap(
        participant="annotator",
        answers=(AnswerColumn(column="pw.0.selected"),),
        words={"left": "A", "right": "B"},
        empty="submitted without answer",
    ),
    tell="the columns of the two sides; the control tag unless it is pw: --answer TAG.0.selected",
)
