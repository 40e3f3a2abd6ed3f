"""OpenSesame, log files (OpenSesame itself and OSWeb): a row each time a logger item runs.

A logger writes every variable as it stands. So the answer in a row need not have been given there: the
counter of the item that asked (``count_X`` beside ``response_X``) says whether it ran again. Up to 4.0.24 a
quotation mark in a cell is written with a backslash, later it is doubled.

References
----------
opensesame-core 4.0.24 and 4.1.22: openexp/_log/csv.py, libopensesame/logger.py and response_store.py.
"""

import re
from dataclasses import replace

from data.convert.delimited import records
from data.convert.form import Form
from data.convert.map import ConversionMap
from data.convert.reading import Layout
from data.convert.table import Row, Table
from data.errors import InputError

AGAIN = "(not asked again)"
_RESPONSE = re.compile(r"response_(?!time(?:_|$))(.+)")
_BACKSLASHED = re.compile(r'\\"(?!,"|\r?\n"|\s*\Z)')
"""A quotation mark behind a backslash, unless the cell ends there: every cell is quoted."""


def _with_doubled_marks(text: str) -> str:
    """The text as later versions write it; one without such marks stays as it is."""
    try:
        if not any(record.has_stray_quote for record in records("", text)):
            return text
    except InputError:
        pass
    return _BACKSLASHED.sub('""', text)


def _with_new_answers_only(table: Table, wanted: ConversionMap) -> Table:
    """Answers of items that have not run since the row before are marked: nobody was asked again."""
    pairs = [
        (place, table.names.index(f"count_{match[1]}"))
        for place, name in enumerate(table.names)
        if (match := _RESPONSE.fullmatch(name)) and f"count_{match[1]}" in table.names
    ]
    rows: list[Row] = []
    before: Row | None = None
    for row in table.rows:
        cells = list(row.cells)
        if before is not None and before.path == row.path:
            for answer, count in pairs:
                if row.cells[count] == before.cells[count] != "NA":
                    cells[answer] = AGAIN
        rows.append(replace(row, cells=tuple(cells)))
        before = row
    return replace(table, rows=tuple(rows))


FORM = Form(
    name="opensesame",
    title="OpenSesame",
    columns=("subject_nr", "subject_parity", "opensesame_version", "response", "response_time"),
    defaults=ConversionMap(
        participant="subject_nr",
        words={
            "None": "none: time limit, without answer",
            "NA": "none: not asked yet",
            AGAIN: "none: row without a new answer",
        },
    ),
    choose_rows=("practice",),
    layout=Layout(mend=_with_doubled_marks),
    prepare=_with_new_answers_only,
    tell="the answer's column (response_ITEM, not response, which any item changes), the columns of the two "
    "sides, what each key means, which rows are practice",
)
