"""The documentation of the ground floor says what the code says."""

import re
from pathlib import Path

import pytest
from pydantic_core import PydanticUndefined

from data.response_csv import OPTIONAL, REQUIRED
from data.store.tables import metadata
from data.study import (
    BackgroundQuestion,
    Consent,
    Controller,
    Feedback,
    Maze,
    Mode,
    Part,
    Practice,
    Protocol,
    Question,
    Stuck,
    Study,
)

README = (Path(__file__).resolve().parents[2] / "data" / "README.md").read_text(encoding="utf-8")
PARTS: dict[str, type[Part]] = {
    "": Study,
    "consent.": Consent,
    "modes.": Mode,
    "background.": BackgroundQuestion,
    "questions.": Question,
    "protocol.": Protocol,
    "practice.": Practice,
    "maze.": Maze,
    "feedback.": Feedback,
    "stuck.": Stuck,
    "controller.": Controller,
}
ROWS = dict(re.findall(r"^\| `([a-z_.0-9]+)` \| ([^|]+?) \| [^|]*\| [^|]*\|$", README, re.MULTILINE))


@pytest.mark.parametrize("prefix", PARTS)
def test_every_key_of_the_study_file_is_documented_with_its_default(prefix):
    for name, field in PARTS[prefix].model_fields.items():
        if f"{name}." in PARTS or name in ("modes", "questions"):
            continue
        default = field.get_default(call_default_factory=True)
        if default is PydanticUndefined:
            expected = "required"
        elif isinstance(default, str):
            expected = f'"{default}"'
        elif isinstance(default, int | float):
            expected = str(default)
        else:
            assert prefix + name in ROWS
            continue
        assert ROWS[prefix + name] == expected, prefix + name


def test_no_key_is_documented_that_does_not_exist():
    valid = {prefix + name for prefix, part in PARTS.items() for name in part.model_fields}
    assert set(ROWS) <= valid


def test_every_table_and_every_column_of_the_response_csv_is_documented():
    for name in (*metadata.tables, *REQUIRED, *OPTIONAL):
        assert f"`{name}`" in README
