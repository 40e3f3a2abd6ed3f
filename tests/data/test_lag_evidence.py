"""What the store tells the analysis of trials that people guided, and of those on a robot in the lab."""

import math
from dataclasses import replace
from datetime import datetime, timedelta

import pytest

from data.records import Comparison, Participant, StuckEvent, Trial
from data.store import Store, StoredStudy
from data.study import Study
from data.study_file import study_text

MEASURED = {
    "latency_median_ms": 21.0,
    "latency_p95_ms": 48.0,
    "latency_samples": 900.0,
    "frame_rate_hz": 59.9,
    "ticks": 4000.0,
    "skipped_ticks": 8.0,
    "lap": 1.0,
    "force_mean_n": 17.5,
}


@pytest.fixture
def stored(store: Store, study: Study, noon: datetime) -> StoredStudy:
    kept = store.add_study(study, study_text("carmichael2017"))
    store.add_participant(kept, Participant("anna", 1, "human", noon))
    store.add_comparisons(
        [
            Comparison("anna.c1", "anna", 1, 1, "M1", "M3", False, noon),
            Comparison("anna.c2", "anna", 2, 0, "M2", "M2", True, noon),
        ]
    )
    return kept


def trial(noon: datetime, comparison: str = "anna.c1", slot: str = "A", number: int = 1, **more) -> Trial:
    mode = {"anna.c1": {"A": "M1", "B": "M3"}, "anna.c2": {"A": "M2", "B": "M2"}}[comparison][slot]
    given = Trial(
        f"{comparison}.{slot}{number}", comparison, slot, number, mode, "guided", "completed", noon, 40.0, 0
    )
    return replace(given, **{"metrics": MEASURED, **more})


def test_the_lag_table_has_a_row_for_each_guided_trial_of_a_real_comparison(store, stored, noon):
    for slot in ("B", "A"):
        store.add_trial(trial(noon, slot=slot))
        store.add_trial(trial(noon, "anna.c2", slot))
    store.add_trial(trial(noon, number=2, source="observed"))
    rows = store.lag_table(stored).rows
    assert rows[["comparison", "mode"]].to_numpy().tolist() == [["anna.c1", "M1"], ["anna.c1", "M3"]]
    assert rows.iloc[0].to_dict() == {
        "participant": "anna",
        "comparison": "anna.c1",
        "mode": "M1",
        "latency_median_ms": 21.0,
        "latency_p95_ms": 48.0,
        "frame_rate_hz": 59.9,
        "ticks": 4000.0,
        "skipped_ticks": 8.0,
    }


def test_what_was_not_measured_is_nan(store, stored, noon):
    store.add_trial(trial(noon, metrics={"latency_p95_ms": -1.0, "ticks": 12.0}))
    row = store.lag_table(stored).rows.iloc[0]
    assert row["ticks"] == 12.0
    assert all(math.isnan(row[name]) for name in ("latency_median_ms", "latency_p95_ms", "skipped_ticks"))


def test_trials_from_before_a_comparison_was_begun_anew_say_nothing_of_its_lag(store, stored, noon):
    store.add_trial(trial(noon, metrics=MEASURED | {"latency_p95_ms": 900.0}))
    store.restart_comparison("anna.c1", noon + timedelta(hours=1))
    assert store.lag_table(stored) is None
    store.add_trial(trial(noon + timedelta(hours=1), number=2))
    assert store.lag_table(stored).rows["latency_p95_ms"].tolist() == [48.0]


def test_without_guided_trials_there_is_no_lag_table(store, fill):
    assert store.lag_table(fill(store, 1)) is None


def test_stuck_comparisons_are_known_of_guided_and_of_external_trials(store, stored, noon):
    event = StuckEvent("stuck", 12.5, 0.004, "edge", "sigma-dwell/1")
    store.add_trial(trial(noon, outcome="stuck", events=(event,)))
    store.add_trial(trial(noon, number=2, outcome="abandoned", duration_s=5.0))
    store.add_trial(trial(noon, slot="B", source="external", duration_s=61.5, metrics={}))
    rows = store.stuck_table(stored).rows
    assert rows[["mode", "stuck", "exposure_s"]].to_numpy().tolist() == [
        ["M1", True, 45.0],
        ["M3", False, 61.5],
    ]
    guided, again, external = store.trials(stored)
    assert (guided.metrics["lap"], again.outcome, external.metrics) == (1.0, "abandoned", {})


def test_tables_without_some_comparisons_keep_modes_questions_and_order(store, fill):
    stored = fill(store, 1)
    table, stuck = store.responses_table(stored), store.stuck_table(stored)
    out = table.rows["comparison"].unique()[:2]
    left, left_stuck = table.without(out), stuck.without(out)
    assert set(left.rows["comparison"]) | set(out) == set(table.rows["comparison"])
    assert not set(left.rows["comparison"]) & set(out)
    assert (left.modes, left.questions, len(left.rows)) == (table.modes, table.questions, 24)
    assert set(left_stuck.rows["comparison"]) == set(left.rows["comparison"])
    assert left.sha256 != table.sha256
    assert table.without(()).sha256 == table.sha256


def test_the_pace_counts_from_the_end_of_the_last_trial_to_the_submission(store, stored, study, noon):
    store.add_trial(trial(noon))
    store.add_trial(trial(noon, slot="B", started_at=noon + timedelta(seconds=60)))
    answers = {question.name: "A=B" for question in study.questions}
    store.submit_responses("anna.c1", answers, noon + timedelta(seconds=103))
    (row,) = store.pace_table(stored).rows.to_dict("records")
    assert row == {"participant": "anna", "comparison": "anna.c1", "seconds": 3.0, "questions": 6}


def test_a_trial_of_unknown_duration_leaves_the_pace_unknown(store, stored, study, noon):
    assert store.pace_table(stored) is None
    store.add_trial(trial(noon, duration_s=math.nan))
    store.add_trial(trial(noon, slot="B"))
    answers = {question.name: "A=B" for question in study.questions}
    store.submit_responses("anna.c1", answers, noon + timedelta(seconds=103))
    assert store.pace_table(stored) is None
