"""Shiny comparative judgement: ``19,2 -> 2,19`` is left and right as shown, then winner and loser."""

import re

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap
from data.convert.table import Row, Table

_DECISION = re.compile(r"([^,]+),([^,]+) -> ([^,]+),([^,]+)")


def _split(table: Table, mapping: ConversionMap) -> Table:
    """The table with the decision's parts in columns of their own."""
    column = table.column("decision")

    def parts(row: Row) -> tuple[str, ...]:
        text = column.text(row) or ""
        match = _DECISION.fullmatch(text)
        if match is None or sorted(match.group(1, 2)) != sorted(match.group(3, 4)):
            raise column.error(row, f"{text!r} is not 'LEFT,RIGHT -> WINNER,LOSER'")
        return match.group(1, 2, 3)

    return table.with_columns(("@left", "@right", "@winner"), parts)


FORM = Form(
    name="shiny-judgements",
    title="Shiny comparative judgement",
    columns=("judge_id", "decision_id", "decision", "time_taken"),
    defaults=ConversionMap(
        participant="judge_id",
        answers=(AnswerColumn(chosen="@winner", left="@left", right="@right"),),
    ),
    prepare=_split,
    tell="nothing",
)
