"""No More Marking, decisions: the winner first; which side it was on is not documented."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap, RowRule

FORM = Form(
    name="no-more-marking",
    title="No More Marking, decisions",
    columns=("judgeId", "chosen", "notChosen", "isLeft", "exclude"),
    defaults=ConversionMap(
        participant="judgeId",
        answers=(AnswerColumn(left="chosen", right="notChosen", always="A>B", sides="unknown"),),
        rows=(RowRule(column="exclude", without=("TRUE",), reason="excluded", optional=True),),
    ),
    tell="nothing; if you know that isLeft is the side of the chosen one: --order isLeft=TRUE,FALSE",
)
