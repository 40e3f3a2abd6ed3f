"""Small fits of planted preferences by the real engine, shared by the tests of the report."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.fit import fit
from analysis.report import write_report
from analysis.results import Fit, FitSettings
from data.answers import SCALES
from data.responses import QuestionScale, ResponseTable, StuckTable
from data.study_file import read_study

QUICK = FitSettings(draws=600, tune=300, chains=2)
HOSTILE_MODES = (
    'comma, "quote" and a name of sixty characters, no one knows why',
    "=cmd|' /C calc'!A0",
    "<script>document.title='owned'</script>",
    "$\\frac{a}{b}$ $x",
    "line\nbreak\ttab",
    "שלום \u202eמודוס",
    "",
)
HOSTILE_QUESTIONS = (
    QuestionScale("<img src=x onerror=alert(1)>", "<b>&amp;", "?", 5, "lower_is_better"),
    QuestionScale("@sum(1)", "$x_", "?", 2, "neutral", True),
)


@dataclass(frozen=True)
class Case:
    """A response table, its fit and, where known, when the robot got stuck."""

    table: ResponseTable
    fit: Fit
    stuck: StuckTable | None = None


def planted_table(
    modes: Sequence[str],
    questions: Sequence[QuestionScale],
    *,
    people: int = 6,
    repetitions: int = 2,
    source: str = "human",
    seed: int = 1,
) -> ResponseTable:
    """Answers drawn from abilities that fall from the first mode to the last."""
    rng = np.random.default_rng(seed)
    ability = np.linspace(1.0, -1.0, len(modes))
    rows = []
    for person in range(people):
        for repetition in range(repetitions):
            for i in range(len(modes)):
                for j in range(i + 1, len(modes)):
                    a, b = (i, j) if (person + repetition) % 2 else (j, i)
                    for question in questions:
                        cuts = {2: [0.0], 3: [-0.5, 0.5], 5: [-1.5, -0.4, 0.4, 1.5]}[question.levels]
                        level = int(np.searchsorted(cuts, ability[a] - ability[b] + rng.logistic()))
                        rows.append(
                            {
                                "participant": f"p{person}",
                                "question": question.name,
                                "mode_a": modes[a],
                                "mode_b": modes[b],
                                "response": SCALES[question.levels][::-1][level],
                                "count": 1,
                                "comparison": f"p{person}.r{repetition}.{i}{j}",
                                "repetition": repetition + 1,
                                "source": source,
                                "check": False,
                            }
                        )
    frame = pd.DataFrame(rows)
    sha256 = hashlib.sha256(frame.to_csv().encode()).hexdigest()
    return ResponseTable(
        frame, tuple(modes), tuple(questions), True, source == "simulated", sha256, "Planted preferences"
    )


def stuck_table(table: ResponseTable, mode: str, times: int) -> StuckTable:
    """The robot stuck under one mode in its first comparisons, never under another."""
    rows = []
    left = times
    for row in table.rows.drop_duplicates("comparison").itertuples():
        for name in (row.mode_a, row.mode_b):
            is_stuck = name == mode and left > 0
            left -= is_stuck
            rows.append((row.participant, row.comparison, name, is_stuck, 60.0))
    return StuckTable(
        pd.DataFrame(rows, columns=["participant", "comparison", "mode", "stuck", "exposure_s"])
    )


STUDY_QUESTIONS = (
    QuestionScale("Q2", "most responsive", "Which method was the most responsive?", 5, "higher_is_better"),
    QuestionScale("Q3", "most force", "Which method required the most force to use?", 5, "lower_is_better"),
    QuestionScale("Q6", "safest", "Which method felt safest to use?", 3, "higher_is_better"),
)


@pytest.fixture(scope="session")
def study_case() -> Case:
    """Three modes, three questions, six people."""
    table = planted_table(("M1", "M2", "M3"), STUDY_QUESTIONS)
    return Case(table, fit(table, QUICK), stuck_table(table, "M1", 5))


@pytest.fixture(scope="session")
def simulated_case(study_case: Case) -> Case:
    """The same answers, said to be simulated."""
    rows = study_case.table.rows.assign(source="simulated")
    return replace(study_case, table=replace(study_case.table, rows=rows, is_simulated=True))


@pytest.fixture(scope="session")
def refused_case() -> Case:
    """Q3 never compares M3 with anything."""
    table = planted_table(("M1", "M2", "M3"), STUDY_QUESTIONS[:2])
    rows = table.rows
    dropped = (rows["question"] == "Q3") & ((rows["mode_a"] == "M3") | (rows["mode_b"] == "M3"))
    table = replace(table, rows=rows[~dropped].reset_index(drop=True))
    return Case(table, fit(table, QUICK))


@pytest.fixture(scope="session")
def hostile_case() -> Case:
    """Names that break tables, pages, spreadsheets, formulas and the direction of text."""
    table = planted_table(HOSTILE_MODES, HOSTILE_QUESTIONS, people=3, repetitions=1)
    return Case(table, fit(table, QUICK), stuck_table(table, HOSTILE_MODES[2], 2))


@pytest.fixture(scope="session")
def many_case() -> Case:
    """Twelve modes, more than there are marker shapes."""
    table = planted_table([f"mode {k:02}" for k in range(12)], STUDY_QUESTIONS[2:], people=2, repetitions=1)
    case = Case(table, fit(table))
    assert case.fit.ranked
    return case


def written(case: Case, folder: Path, **more: object) -> Path:
    """The case's report folder."""
    write_report(case.table, case.fit, folder / "report", case.stuck, **more)
    return folder / "report"


@pytest.fixture(scope="session")
def study_report(study_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Report of the study of 2017 on planted answers of people."""
    return written(study_case, tmp_path_factory.mktemp("study"), study=read_study("carmichael2017"))


@pytest.fixture(scope="session")
def simulated_report(simulated_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Report of the same answers, simulated."""
    return written(simulated_case, tmp_path_factory.mktemp("simulated"))


@pytest.fixture(scope="session")
def refused_report(refused_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Report in which one question is not ranked."""
    return written(refused_case, tmp_path_factory.mktemp("refused"))


@pytest.fixture(scope="session")
def hostile_report(hostile_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Report of hostile names."""
    return written(hostile_case, tmp_path_factory.mktemp("hostile"))


@pytest.fixture(scope="session")
def write_case() -> Callable[[Case, Path], Path]:
    """Writes the report of any case below a folder."""
    return written
