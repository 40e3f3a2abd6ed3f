"""The ranking in a terminal."""

import io

import pandas as pd
import pytest
from rich.cells import cell_len
from rich.console import Console

from analysis.console_ranking import print_ranking
from analysis.fit import fit
from analysis.results import FitSettings
from data.responses import QuestionScale, ResponseTable


@pytest.fixture(scope="module")
def preferences():
    modes = ("M1", "a mode with a [red]name[/red] much longer than its column", "M3")
    rows = [
        (f"p{person}", question, a, b, "A>B", 1, f"c{person}{k}", 1, "human", False)
        for person in range(4)
        for question in ("Q1", "Q2")
        for k, (a, b) in enumerate([(modes[0], modes[1]), (modes[0], modes[2]), (modes[2], modes[1])])
        if not (question == "Q2" and modes[2] in (a, b))
    ]
    columns = ["participant", "question", "mode_a", "mode_b", "response", "count", "comparison", "repetition",
               "source", "check"]  # fmt: skip
    scales = tuple(QuestionScale(name, f"{name} in short", "?", 2) for name in ("Q1", "Q2"))
    table = ResponseTable(pd.DataFrame(rows, columns=columns), modes, scales, True, False, "0" * 64, "t")
    return fit(table, FitSettings(draws=400, tune=300, chains=2))


def printed(preferences, *, encoding="utf-8", is_simulated=False):
    file = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    print_ranking(preferences, Console(file=file, width=80, no_color=True), is_simulated=is_simulated)
    file.seek(0)
    return file.read()


def test_every_mode_has_its_worth_its_bar_and_its_chance_within_eighty_columns(preferences):
    text = printed(preferences)
    assert all(cell_len(line) <= 80 for line in text.splitlines())
    line = next(line for line in text.splitlines() if line.strip().startswith("M1"))
    assert f"{preferences.questions[0].modes[0].worth_mean:.2f}" in line
    assert "█" in line
    assert line.endswith("%")
    assert "a mode with a [red]na" in text


def test_a_question_that_cannot_be_ranked_says_why(preferences):
    text = printed(preferences)
    assert "(not ranked)" in text
    assert "M3 was never compared" in text


def test_simulated_answers_are_marked_and_others_are_not(preferences):
    assert "SIMULATED" in printed(preferences, is_simulated=True)
    assert "SIMULATED" not in printed(preferences)


def test_a_terminal_without_block_signs_gets_plain_ones(preferences):
    text = printed(preferences, encoding="ascii")
    assert "█" not in text
    assert "O" in text
