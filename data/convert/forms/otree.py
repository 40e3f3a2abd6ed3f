"""oTree, all apps in one wide table: a row a participant, a column a field of a round."""

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule

FORM = Form(
    name="otree",
    title="oTree, all apps (wide)",
    columns=("participant.code", "participant._is_bot", "session.is_demo", "session.code"),
    defaults=ConversionMap(
        participant="participant.code",
        rows=(
            RowRule(column="participant._is_bot", without=("1", "True"), reason="bot", optional=True),
            RowRule(column="session.is_demo", without=("1", "True"), reason="demo session", optional=True),
            RowRule(column="participant.visited", without=("0", "False"), reason="never came", optional=True),
        ),
    ),
    tell="the fields of answer, left and right, with * for the round, and what each word means",
)
