"""Comproved, comparisons, CSV or spreadsheet: the winner first.

Products are named by their files, and several may share a name, so what was compared has to be told.
"""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="comproved",
    title="Comproved, comparisons",
    columns=("Assessor email", "Better product", "Lesser product"),
    defaults=ConversionMap(
        participant="Assessor email",
        answers=(AnswerColumn(left="Better product", always="A>B", sides="unknown"),),
    ),
    tell="what was compared: the products (--left 'Better product' --right 'Lesser product') or the "
    "participants behind them (--left '#4' --right '#6'); several products may share a file name",
)
