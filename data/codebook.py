"""What each column of an export means: made from the store's tables, which say it once."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from sqlalchemy import Column as SqlColumn
from sqlalchemy import Table
from sqlalchemy.types import Boolean, Integer, Text

from data.answers import SCALES
from data.metric_meanings import meaning_of
from data.store import tables
from data.store.tables import Real, UtcTime
from data.study import Study


@dataclass(frozen=True)
class Field:
    """A column of an export's CSV file.

    Attributes
    ----------
    type : str
        ``string``, ``integer``, ``number``, ``boolean`` or ``datetime``, as Frictionless names them.
    unit : str
        Unit of a number, zone of a time, or "".
    valid : tuple of str
        The values there can be, or none if they are not a closed set.
    is_required : bool
        False if a cell may be empty.
    """

    name: str
    meaning: str
    type: str
    unit: str = ""
    valid: tuple[str, ...] = ()
    is_required: bool = True


@dataclass(frozen=True)
class Sheet:
    """One CSV file of an export.

    Attributes
    ----------
    keys : tuple of str
        The columns that identify a row.
    references : mapping of str to (str, str)
        Columns whose values are a column of another sheet.
    """

    name: str
    meaning: str
    fields: tuple[Field, ...]
    keys: tuple[str, ...]
    references: Mapping[str, tuple[str, str]]

    @property
    def file(self) -> str:
        """Its file's name."""
        return f"{self.name}.csv"


def sheets_of(
    study: Study, metrics: Mapping[str, str], background: Mapping[str, str], pooled: bool = False
) -> tuple[Sheet, ...]:
    """The CSV files of a study's export.

    Parameters
    ----------
    metrics : mapping of str to str
        Names of the metrics that any trial has, with the column of each.
    background : mapping of str to str
        Names of the background questions that any participant answered, with the column of each.
    pooled : bool
        True if it is not known who gave which response: the responses then name no participant.
    """
    questions = tuple(question.name for question in study.questions)
    participant = Field("participant", "Who answered", "string")
    return (
        _sheet(
            tables.participants,
            "One row a participant",
            [
                Field(column, f"Background: {name}", "string", is_required=False)
                for name, column in background.items()
            ],
            leave_out=("study", "background"),
        ),
        _sheet(tables.comparisons, "One row a comparison: a blinded A/B pair shown to one participant"),
        Sheet(
            "responses",
            "One row a response; valid as input of `elbowroom report --responses`",
            (
                *(() if pooled else (participant,)),
                Field("question", "Name of the question", "string", valid=questions),
                Field("mode_a", "Mode shown as A", "string", valid=study.mode_names),
                Field("mode_b", "Mode shown as B", "string", valid=study.mode_names),
                Field("response", "Which of A and B, and how much", "string", valid=SCALES[5]),
                Field("count", "How many responses the row stands for", "integer"),
                Field("comparison", "The comparison that was judged", "string"),
                Field("repetition", "Which showing of the pair it was; 0 for a check", "integer"),
                Field(
                    "source", "A person or a simulated participant", "string", valid=("human", "simulated")
                ),
                Field("check", "True for an attention check", "boolean"),
                Field("answered_at", "When it was submitted", "datetime", "UTC"),
            ),
            ("comparison", "question"),
            ({} if pooled else {"participant": ("participants", "id")})
            | {"comparison": ("comparisons", "id")},
        ),
        _sheet(
            tables.trials,
            "One row a trial: a run at the maze under one condition",
            [
                Field(column, meaning_of(name).meaning, "number", meaning_of(name).unit, is_required=False)
                for name, column in metrics.items()
            ],
            leave_out=("metrics",),
        ),
        Sheet(
            "stuck_events",
            "One row an event in a trial; valid as input of `elbowroom import --stuck`",
            (
                participant,
                Field("comparison", "The comparison", "string"),
                Field("mode", "The mode under which it happened", "string", valid=study.mode_names),
                *_sheet(tables.stuck_events, "").fields,
            ),
            ("trial", "number"),
            {
                "participant": ("participants", "id"),
                "comparison": ("comparisons", "id"),
                "trial": ("trials", "id"),
            },
        ),
        _sheet(tables.switches, "One row for each time a participant turned to A or to B"),
        _sheet(
            tables.audit,
            "The store's whole audit log, since its hashes are a chain",
            [Field("detail", "With what, as JSON", "string")],
            leave_out=("detail",),
        ),
    )


def column_names(prefix: str, names: Iterable[str], table: Table) -> dict[str, str]:
    """A CSV column of its own for each thing that people named: letters, digits and underscores only.

    Names that come to the same column, whatever their case, or to one that the table has anyway, are told
    apart by a number.
    """
    columns: dict[str, str] = {}
    used = {column.name for column in table.columns}
    for name in names:
        plain = column = f"{prefix}_{re.sub(r'[^A-Za-z0-9_]+', '_', name)}"
        again = 1
        while column.lower() in used:
            again += 1
            column = f"{plain}_{again}"
        used.add(column.lower())
        columns[name] = column
    return columns


def _sheet(table: Table, meaning: str, more: Sequence[Field] = (), leave_out: tuple[str, ...] = ()) -> Sheet:
    columns = [column for column in table.columns if column.name not in leave_out]
    references = {}
    for column in columns:
        for key in column.foreign_keys:
            target, name = key.target_fullname.split(".")
            references[column.name] = (target, name)
    keys = tuple(column.name for column in table.primary_key.columns)
    return Sheet(table.name, meaning, (*map(_field, columns), *more), keys, references)


def _field(column: "SqlColumn[object]") -> Field:
    return Field(
        column.name,
        column.info["meaning"],
        _type(column),
        column.info.get("unit", ""),
        tuple(column.info.get("valid", ())),
        # A free text may be empty, which a CSV file cannot tell from a missing one.
        not column.nullable and not isinstance(column.type, Text),
    )


def _type(column: "SqlColumn[object]") -> str:
    if isinstance(column.type, UtcTime):
        return "datetime"
    if isinstance(column.type, Real):
        return "number"
    if isinstance(column.type, Boolean):
        return "boolean"
    return "integer" if isinstance(column.type, Integer) else "string"


def codebook(study: Study, sheets: Sequence[Sheet]) -> dict[str, object]:
    """What every column of every file means, for people and programs."""
    return {
        "study": {"name": study.name, "version": study.version, "title": study.title, "sha256": study.sha256},
        "tables": {
            sheet.file: {
                "meaning": sheet.meaning,
                "keys": list(sheet.keys),
                "columns": {
                    field.name: {
                        "meaning": field.meaning,
                        "type": field.type,
                        "unit": field.unit,
                        "valid": list(field.valid),
                        "may_be_empty": not field.is_required,
                    }
                    for field in sheet.fields
                },
            }
            for sheet in sheets
        },
        "questions": {
            question.name: {
                "wording": question.wording,
                "polarity": question.polarity,
                "answers": dict(zip(question.scale, question.labels, strict=True)),
            }
            for question in study.questions
        },
        "modes": {
            mode.name: {
                "method": mode.method,
                "parameters": dict(mode.parameters),
                "description": mode.description,
            }
            for mode in study.modes
        },
        "conventions": {
            "empty cell": "not known or not applicable",
            "times": "ISO 8601, UTC",
            "leading apostrophe": "a text that a spreadsheet could run as a formula; raw/ has it as it was",
            "raw": "every table of the store as JSON lines, without loss",
        },
    }
