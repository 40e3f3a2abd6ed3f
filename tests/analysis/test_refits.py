"""What a full report adds, gathered: each part, or why it is not there."""

from dataclasses import replace

import pandas as pd
import pytest

from analysis.fit import fit
from analysis.refits import refits
from analysis.report.refitted import metric_sections, people_sections, refit_sections
from analysis.results import FitSettings
from data.responses import LagTable

SETTINGS = FitSettings(draws=1000, tune=500, chains=2)


def laps(comparisons, laggy):
    return LagTable(
        pd.DataFrame(
            {
                "participant": "p",
                "comparison": comparisons,
                "mode": "M1",
                "latency_median_ms": 20.0,
                "latency_p95_ms": [500.0 if name in laggy else 40.0 for name in comparisons],
                "frame_rate_hz": 60.0,
                "ticks": 1000.0,
                "skipped_ticks": 0.0,
            }
        )
    )


@pytest.fixture(scope="module")
def case(simulated):
    table = simulated(2, participants=4)
    names = [f"c{k}" for k in range(len(table.rows))]
    table = replace(table, rows=table.rows.assign(comparison=names))
    return table, fit(table, SETTINGS), names


def test_laggy_comparisons_are_left_out_and_what_that_changes_is_told(case):
    table, fitted, names = case
    stages = []

    def stage(name):
        stages.append(name)
        return lambda done, total, now: None

    found = refits(table, fitted, lag=laps(names, names[:6]), progress=stage)
    assert found.lag.comparisons == tuple(names[:6])
    again = fit(table.without(names[:6]), SETTINGS).questions[0]
    assert [c.worth_without for c in found.lag.changes] == [m.worth_mean for m in again.modes]
    assert [c.worth_with for c in found.lag.changes] == [m.worth_mean for m in fitted.questions[0].modes]
    assert "Without laggy comparisons" in stages
    assert found.scores[0].model == "as reported"
    assert {s.prior for s in found.shifts} >= {"ability ~ ZeroSumNormal(2)", "subject_sd ~ HalfNormal(2)"}
    assert metric_sections(found, fitted, "") == []
    (metrics,) = metric_sections(replace(found, no_effects="With 3 modes it is so."), fitted, "")
    assert metrics.words == ("With 3 modes it is so.",)
    (people,) = people_sections(found, fitted, "")
    assert "came without what participants said" in people.words[0]
    headings = [section.heading for section in refit_sections(found) if section is not None]
    assert "Do the priors decide?" in headings
    said = " ".join(w for section in refit_sections(found) if section is not None for w in section.words)
    assert "nothing is fitted again, the report's draws are weighted" in said


def test_where_every_comparison_is_laggy_there_is_no_change_to_show(case):
    table, fitted, names = case
    excluded = refits(table, fitted, lag=laps(names, names)).lag
    assert (len(excluded.comparisons), excluded.changes) == (len(names), ())


def test_a_report_that_is_not_full_has_none_of_these_sections(case):
    assert (
        refit_sections(None) == metric_sections(None, case[1], "") == people_sections(None, case[1], "") == []
    )
