"""The page about conversion names every option and key, and shows a command a form that is tested."""

import re
import shlex
from pathlib import Path

from typer.main import get_command

from app.cli.main import cli
from data.convert import forms
from data.convert.map import AnswerColumn, ConversionMap, Ranking, RowRule, Scale
from tests.app.test_convert_forms import CASES

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "data" / "convert" / "README.md").read_text(encoding="utf-8")


def test_every_command_of_the_page_is_a_tested_case_and_every_form_has_one() -> None:
    blocks = re.findall(r"```sh\n(elbowroom convert .*?)```", PAGE.partition("## The forms")[2], re.DOTALL)
    shown = [shlex.split(block.replace("\\\n", " ")) for block in blocks]
    tested = {
        ("elbowroom", "convert", *case.files, "--from", case.form, *shlex.split(case.options)): case.right
        for case in CASES
        if case.right
    }
    assert all(command[-2:] == ["--out", "responses.csv"] for command in shown)
    assert [command for command in shown if tuple(command[:-2]) not in tested] == []
    assert {tested[tuple(command[:-2])] for command in shown} == set(tested.values())
    refusing = {form.name for form in forms().values() if form.refusal}
    assert {command[command.index("--from") + 1] for command in shown} == set(forms()) - refusing
    assert all(f"(`{name}`" in PAGE for name in forms())


def test_every_option_is_explained() -> None:
    command = get_command(cli).commands["convert"]
    options = {name for parameter in command.params for name in parameter.opts if name.startswith("--")}
    table = PAGE.partition("## What is told")[2].partition("## The forms")[0]
    assert [name for name in options - {"--help"} if f"`{name}`" not in table] == []


def test_every_key_of_a_map_is_explained() -> None:
    table = PAGE.partition("| key of a map")[2].partition("## The forms")[0]
    models = (ConversionMap, AnswerColumn, Ranking, RowRule, Scale)
    keys = {name for model in models for name in model.model_fields}
    assert [key for key in keys if f"`{key}`" not in table] == []
