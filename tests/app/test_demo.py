"""The main job, end to end, on a small cohort."""

import json
import time
from pathlib import Path

import pandas as pd
import pytest

from app.cli.main import run
from tests.frictionless_report import validated

PEOPLE = "1"


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("demo") / "out"
    assert run(["demo", "--out", str(out), "--participants", PEOPLE, "--seed", "5"]) == 0
    return out


def test_the_demo_ends_in_a_store_a_report_and_an_export(demo: Path) -> None:
    assert (demo / "study.sqlite").stat().st_size > 0
    worth = pd.read_csv(demo / "report" / "worth.csv")
    assert len(worth) == 18
    assert worth.groupby("question")["worth_mean"].sum().to_numpy() == pytest.approx(1.0)
    responses = pd.read_csv(demo / "export" / "responses.csv")
    assert len(responses) == 6 * 6
    assert set(responses["source"]) == {"simulated"}


def test_the_demo_says_everywhere_that_it_is_simulated(demo: Path) -> None:
    assert "simulated" in (demo / "report" / "report.html").read_text().lower()
    assert json.loads((demo / "report" / "summary.json").read_text())["simulated"] is True


def test_the_export_is_a_valid_data_package_with_all_meanings_and_is_validated_fast(demo: Path) -> None:
    started = time.perf_counter()
    report = validated(demo / "export")
    # Seven people's, of 275 files, must be valid in less than 15 s.
    assert time.perf_counter() - started < 15.0
    assert report.valid, report.to_summary()
    assert report.stats["tasks"] == 6 * 2 * 3 + 7 + 13 + 3
    tables = json.loads((demo / "export" / "codebook.json").read_text())["tables"]
    metrics = {name: about for name, about in tables["trials.csv"]["columns"].items() if "metric_" in name}
    assert len(metrics) > 40
    assert all(about["unit"] and "not a metric" not in about["meaning"] for about in metrics.values())


def test_every_comparison_was_run_under_both_methods_lap_by_lap(demo: Path) -> None:
    trials = pd.read_csv(demo / "export" / "trials.csv")
    comparisons = pd.read_csv(demo / "export" / "comparisons.csv").set_index("id")
    assert len(trials) == 6 * 2 * 3
    for trial in trials.itertuples():
        shown = comparisons.loc[trial.comparison]
        assert trial.mode == (shown.mode_a if trial.slot == "A" else shown.mode_b)
        assert (demo / "export" / "recordings" / trial.recording).is_file()


def test_the_same_seed_gives_the_same_bytes_in_every_csv(demo: Path, tmp_path: Path) -> None:
    again = tmp_path / "again"
    assert run(["demo", "--out", str(again), "--participants", PEOPLE, "--seed", "5"]) == 0
    files = sorted(path.relative_to(demo) for path in demo.rglob("*.csv"))
    assert len(files) >= 10
    for name in files:
        assert (demo / name).read_bytes() == (again / name).read_bytes(), name


def test_an_interrupted_cohort_is_completed_and_a_complete_one_left_alone(
    demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = str(demo / "study.sqlite")
    before = (demo / "export" / "responses.csv").read_bytes()
    assert run(["simulate", "--store", store, "--participants", PEOPLE, "--seed", "5"]) == 0
    assert "1 were there already" in capsys.readouterr().out
    out = demo.parent / "export again"
    assert run(["export", "--store", store, "--include-simulated", "--out", str(out)]) == 0
    assert (out / "responses.csv").read_bytes() == before


def test_simulated_answers_are_not_used_unless_asked_for(
    demo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = str(demo / "study.sqlite")
    assert run(["report", "--store", store, "--out", str(tmp_path / "r")]) == 2
    assert "--include-simulated" in capsys.readouterr().err
    assert not (tmp_path / "r").exists()
