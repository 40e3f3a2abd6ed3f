"""The report's words and tables on input delay, laggy comparisons and attention checks."""

import json
from dataclasses import replace

import pandas as pd
import pytest

from analysis.data_quality import DataQuality
from analysis.fit import fit
from analysis.lag import LagExclusion, LagLimits, ModeDelay, lag_changes
from analysis.report.cautions import cautions
from analysis.report.findings import findings
from data.responses import LagTable
from data.study_file import read_study


@pytest.fixture(scope="module")
def delays() -> LagTable:
    modes = ["M1", "M2", "M3"] * 4
    return LagTable(
        pd.DataFrame(
            {
                "participant": "p0",
                "comparison": "c",
                "mode": modes,
                "latency_median_ms": [{"M1": 20.0, "M2": 21.0, "M3": 64.0}[m] for m in modes],
                "latency_p95_ms": 90.0,
                "frame_rate_hz": 60.0,
                "ticks": 1000.0,
                "skipped_ticks": 0.0,
            }
        )
    )


def with_checks(case):
    """The case with every person's first answers given to a mode against itself as well."""
    rows = case.table.rows
    checks = rows[rows["comparison"].str.endswith(".r0.01")].assign(check=True)
    checks = checks.assign(mode_b=checks["mode_a"], comparison=checks["comparison"] + "k")
    checks.loc[checks["participant"] != "p0", "response"] = "A=B"
    checks.loc[checks["participant"] == "p0", "response"] = "A>B"
    return replace(case, table=replace(case.table, rows=pd.concat([rows, checks], ignore_index=True)))


def test_a_report_of_guided_trials_has_a_table_of_the_input_delay(study_case, delays, write_case, tmp_path):
    folder = write_case(study_case, tmp_path, lag=delays)
    page = (folder / "report.html").read_text()
    assert "<h2>Input delay</h2>" in page
    assert "<bdi>64 ms</bdi>" in page
    assert "Without the laggy comparisons" not in page
    table = pd.read_csv(folder / "delay.csv").set_index("mode")
    assert table["latency_median_ms"].to_dict() == {"M1": 20.0, "M2": 21.0, "M3": 64.0}
    assert not (folder / "lag.csv").exists()
    assert json.loads((folder / "summary.json").read_text())["left_out_for_lag"] is None


def test_a_report_without_guided_trials_says_nothing_of_delay(study_report):
    assert "Input delay" not in (study_report / "report.html").read_text()
    assert not (study_report / "delay.csv").exists()


def test_an_unequal_delay_is_said_before_anything_is_quoted(study_case):
    def said(second: float, skipped: float = 0.0) -> str:
        both = (
            ModeDelay("M1", 4, 4, 20.0, 40.0, 60.0, 0.0),
            ModeDelay("M2", 4, 4, second, 40.0, 60.0, skipped),
        )
        found = findings(study_case.fit)
        return " ".join(cautions(study_case.table, study_case.fit, found, None, 0, DataQuality(both)))

    assert "The input delay was unequal: 31 ms with M2, 20 ms with M1." in said(31.0)
    assert "The share of skipped ticks was unequal: 1.5 % with M2, 0.0 % with M1." in said(20.0, 1.5)
    assert "unequal" not in said(29.0, 0.9)
    assert "unequal" not in said(float("nan"))


def test_what_leaving_out_changes_stands_in_the_report(study_case, delays, write_case, tmp_path):
    everything = study_case
    out = tuple(study_case.table.rows["comparison"].unique()[::3])
    table = study_case.table.without(out)
    kept = replace(study_case, table=table, fit=fit(table, study_case.fit.settings))
    total = study_case.table.rows["comparison"].nunique()
    changes = lag_changes(everything.fit, kept.fit)
    excluded = LagExclusion(LagLimits(100.0, 2.0), out, total, 0, changes)
    folder = write_case(kept, tmp_path, lag=delays, excluded=excluded)
    rows = pd.read_csv(folder / "lag.csv").set_index(["question", "mode"])
    for case, name in ((everything, "with"), (kept, "without")):
        for question in case.fit.questions:
            for mode in question.modes:
                row = rows.loc[question.question.name, mode.mode]
                assert row[f"worth_{name}"] == mode.worth_mean
                assert row[f"p_best_{name}"] == mode.p_best
    assert (rows["worth_with"] != rows["worth_without"]).any()
    page = (folder / "report.html").read_text()
    assert f"of the answers and of the stuck rates: {len(out)} of {total}." in page
    assert f"{len(out)} of {total} comparisons are left out because of lag." in page
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["left_out_for_lag"] == {
        "max_latency_ms": 100.0,
        "max_skipped_percent": 2.0,
        "comparisons": list(out),
        "of": total,
    }


def test_attention_checks_are_told_person_by_person(study_case, write_case, tmp_path):
    folder = write_case(with_checks(study_case), tmp_path)
    shares = pd.read_csv(folder / "checks.csv").set_index("participant")
    assert shares["share"].to_dict() == {"p0": 0.0} | {f"p{k}": 1.0 for k in range(1, 6)}
    page = (folder / "report.html").read_text()
    assert "<h2>Attention checks</h2>" in page
    assert "Fewer than half of theirs: " in page


def test_without_attention_checks_there_is_no_table_of_them(study_report):
    assert "Attention checks" not in (study_report / "report.html").read_text()
    assert not (study_report / "checks.csv").exists()


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("guided", "Participants guided a simulated robot in the browser"),
        ("observed", "Participants watched a simulated robot."),
        ("external", "Participants used a robot in the lab."),
    ],
)
def test_where_the_trials_came_from_is_said_first(study_case, source, words):
    study = read_study("carmichael2017")
    of_source = study.model_copy(
        update={"protocol": study.protocol.model_copy(update={"trial_source": source})}
    )
    said = cautions(study_case.table, study_case.fit, findings(study_case.fit), of_source, 0)
    assert said[0].startswith(words)
