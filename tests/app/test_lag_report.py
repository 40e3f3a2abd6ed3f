"""A report of guided trials: laggy comparisons are left out on demand, and what that changes is told."""

import json
from datetime import UTC, datetime
from pathlib import Path

import pandas as pd
import pytest

from app.cli.main import run
from data.records import Comparison, Participant, Trial
from data.store import Store
from data.study_file import parse_study

AT = datetime(2026, 3, 4, 12, 0, tzinfo=UTC)
STUDY = """format = 1
name = "lag"
title = "Lag"
[consent]
version = "1"
text = "Agreed?"
[[modes]]
name = "M1"
method = "dls"
[[modes]]
name = "M2"
method = "dls"
parameters = { lambda0 = 0.6 }
[[questions]]
name = "Q1"
wording = "Which?"
short = "which"
levels = 3
"""
PEOPLE = 6


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six people who prefer M2 where M1 lags, in half of all comparisons, and M1 elsewhere."""
    path = tmp_path_factory.mktemp("lag") / "study.sqlite"
    with Store.open(path) as kept, kept.transaction():
        stored = kept.add_study(parse_study(STUDY, "lag"), STUDY)
        for number in range(1, PEOPLE + 1):
            who = f"p{number}"
            kept.add_participant(stored, Participant(who, number, "human", AT))
            for position in (1, 2, 3, 4):
                name, is_laggy = f"{who}.c{position}", position > 2
                modes = ("M1", "M2") if position % 2 else ("M2", "M1")
                kept.add_comparisons([Comparison(name, who, position, 1, *modes, False, AT)])
                for slot, mode in zip(("A", "B"), modes, strict=True):
                    slow = is_laggy and mode == "M1"
                    metrics = {
                        "latency_median_ms": 80.0 if slow else 20.0,
                        "latency_p95_ms": 150.0 if slow else 45.0,
                        "frame_rate_hz": 60.0,
                        "ticks": 1000.0,
                        "skipped_ticks": 30.0 if slow else 0.0,
                    }
                    outcome = "stuck" if slow else "completed"
                    kept.add_trial(
                        Trial(f"{name}.{slot}1", name, slot, 1, mode, "guided", outcome, AT, 40.0, 0, metrics)
                    )
                preferred = "M2" if is_laggy else "M1"
                answer = "A>B" if modes[0] == preferred else "B>A"
                kept.submit_responses(name, {"Q1": answer}, AT)
    return path


def report(store: Path, out: Path, *options: str) -> pd.DataFrame:
    assert run(["report", "--store", str(store), "--out", str(out), *options]) == 0
    return pd.read_csv(out / "worth.csv").set_index("mode")


@pytest.mark.parametrize("options", [("--max-latency-ms", "100"), ("--max-skipped", "2")])
def test_without_the_laggy_comparisons_the_other_mode_is_first(
    store: Path, tmp_path: Path, options: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    everything = report(store, tmp_path / "all")
    assert everything["worth_mean"]["M1"] == pytest.approx(0.5, abs=0.1)
    prompt = report(store, tmp_path / "prompt", *options)
    assert prompt["p_best"]["M1"] > 0.95
    assert "12 of 24 comparisons are left out because of lag" in capsys.readouterr().err
    lag = pd.read_csv(tmp_path / "prompt" / "lag.csv").set_index("mode")
    assert lag["worth_with"].to_dict() == everything["worth_mean"].to_dict()
    assert lag["worth_without"].to_dict() == prompt["worth_mean"].to_dict()
    stuck = [pd.read_csv(tmp_path / name / "stuck.csv").set_index("mode") for name in ("all", "prompt")]
    assert [s["stuck"]["M1"] for s in stuck] == [12, 0]
    assert [s["comparisons"]["M1"] for s in stuck] == [24, 12]
    summary = json.loads((tmp_path / "prompt" / "summary.json").read_text())
    assert summary["counts"]["comparisons"] == 12
    assert len(summary["left_out_for_lag"]["comparisons"]) == 12


def test_limits_that_nothing_exceeds_change_nothing(store: Path, tmp_path: Path) -> None:
    everything = report(store, tmp_path / "all")
    same = report(store, tmp_path / "same", "--max-latency-ms", "1000")
    assert same.equals(everything)
    assert "0 of 24." in (tmp_path / "same" / "report.html").read_text()


def test_limits_that_leave_nothing_are_wrong_input_and_write_nothing(
    store: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "r"
    assert run(["report", "--store", str(store), "--max-latency-ms", "10", "--out", str(out)]) == 2
    assert "all 24 comparisons have a lap with" in capsys.readouterr().err
    assert not out.exists()


def test_limits_on_a_store_without_guided_trials_are_wrong_input(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "answers.csv"
    path.write_text("participant,question,mode_a,mode_b,response\np,Q1,M1,M2,A>B\n")
    study, store = tmp_path / "lag.toml", str(tmp_path / "s.sqlite")
    study.write_text(STUDY)
    assert run(["import", "--responses", str(path), "--study", str(study), "--store", store]) == 0
    assert run(["report", "--store", store, "--max-skipped", "1", "--out", str(tmp_path / "r")]) == 2
    assert "trials that people guided, and none is known here" in capsys.readouterr().err
