"""The load test: a server of its own, real sockets, a table."""

import subprocess
import sys
from pathlib import Path

from app.load.rehearsal import drawn_answers, guided_text
from data.response_csv import read_response_csv
from data.study_file import parse_study
from tests.conftest import PATIENCE_S

from .conftest import GUIDED_STUDY, TINY_STUDY
from .live_browser import STUDY


def test_a_few_hands_for_a_few_seconds_give_a_table(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(GUIDED_STUDY)
    options = ["--study", "study.toml", "--participants", "3", "--seconds", "3", "--workers", "1"]
    result = subprocess.run(
        [sys.executable, "-m", "app.cli", "load", *options],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=5 * PATIENCE_S,
    )
    assert result.returncode == 0, result.stderr
    assert "3 people at the robot" in result.stdout
    for row in (
        "control ticks skipped",
        "input to state, median",
        "states received",
        "CPU of each live worker",
    ):
        assert row in result.stdout
    assert "Traceback" not in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_a_study_of_watched_laps_is_guided_in_a_load_test() -> None:
    study = parse_study(guided_text(TINY_STUDY), where="test")
    assert study.protocol.trial_source == "guided"
    assert study.mode_names == STUDY.mode_names


def test_the_answers_for_the_reports_fit_the_study(tmp_path: Path) -> None:
    path = tmp_path / "answers.csv"
    path.write_text(drawn_answers(STUDY))
    table = read_response_csv(path, STUDY)
    assert len(table.rows) == 20 * len(STUDY.pairs) * len(STUDY.questions)
