"""A new question is one entry of the study file: it is asked, stored, ranked and exported."""

from pathlib import Path

import pandas as pd
import pytest

from app.cli.main import run
from data.study_file import study_text

NEW_QUESTION = """
[[questions]]
name = "Q7"
wording = "Which method was the quickest to get used to?"
short = "quickest to learn"
levels = 2
rehearsal = { gain_exit = 1.0 }

[protocol]"""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The 2017 study with one more question, and as few laps as a ranking needs."""
    path = tmp_path_factory.mktemp("study") / "more.toml"
    text = study_text("carmichael2017").replace("\n[protocol]", NEW_QUESTION)
    text = text.replace("laps_per_condition = 3", "laps_per_condition = 1")
    path.write_text(text.replace("repetitions = 2", "repetitions = 1"))
    return path


def test_a_question_added_to_the_study_file_reaches_report_and_export(study: Path) -> None:
    folder = study.parent
    store = str(folder / "study.sqlite")
    assert run(["simulate", "--study", str(study), "--store", store, "--participants", "2"]) == 0
    report, export = folder / "report", folder / "export"
    assert run(["report", "--store", store, "--include-simulated", "--out", str(report)]) == 0
    assert run(["export", "--store", store, "--include-simulated", "--out", str(export)]) == 0
    responses = pd.read_csv(export / "responses.csv")
    new = responses[responses["question"] == "Q7"]
    assert len(new) == 2 * 3
    assert set(new["response"]) <= {"A>B", "B>A"}
    worth = pd.read_csv(report / "worth.csv").query("question == 'Q7'")
    assert worth["worth_mean"].sum() == pytest.approx(1.0)
    assert "quickest to learn" in (report / "report.html").read_text()
