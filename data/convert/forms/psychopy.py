"""PsychoPy, CSV of the desktop version: a row a trial, and further rows without one."""

import ast

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap
from data.convert.table import Cell, Row, Table

SEVERAL = "(several keys)"
_KEYS = ".keys"


def _with_single_keys(table: Table, mapping: ConversionMap) -> Table:
    """Keys that PsychoPy stored as a list: one of them alone, or marked as several."""
    places = {place for place, name in enumerate(table.names) if name.endswith(_KEYS)}
    rows = tuple(
        Row(row.path, row.line, tuple(_key(c) if place in places else c for place, c in enumerate(row.cells)))
        for row in table.rows
    )
    return Table(table.path, table.names, rows, table.notes)


def _key(cell: Cell) -> Cell:
    if cell is None or not cell.startswith("["):
        return cell
    try:
        keys = ast.literal_eval(cell)
    except (ValueError, SyntaxError):
        return cell
    if not isinstance(keys, list) or not all(isinstance(key, str) for key in keys):
        return cell
    return keys[0] if len(keys) == 1 else SEVERAL


FORM = Form(
    name="psychopy",
    title="PsychoPy",
    columns=("psychopyVersion", "expName", "participant", "date"),
    defaults=ConversionMap(
        participant="participant",
        answers=(AnswerColumn(column="key_resp.keys"),),
        words={"None": "none: trial without a key", SEVERAL: "none: trial with several keys"},
        empty="no trial in this row",
    ),
    prepare=_with_single_keys,
    tell="the columns of the two sides, what each key means; the keys' column unless it is key_resp.keys",
)
