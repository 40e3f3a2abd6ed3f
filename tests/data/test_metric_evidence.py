"""What the store tells the analysis of the laps behind the answers, and of the people who gave them."""

import math
from dataclasses import replace
from datetime import datetime, timedelta

import pytest

from data.records import Comparison, Participant, Trial
from data.store import Store, StoredStudy
from data.study import Study
from data.study_file import study_text


@pytest.fixture
def stored(store: Store, study: Study, noon: datetime) -> StoredStudy:
    """Anna with an answered comparison, an attention check and one that she left."""
    kept = store.add_study(study, study_text("carmichael2017"))
    said = {"imported_as": "A", "robots": "Often", "hand": ""}
    store.add_participant(kept, Participant("anna", 1, "human", noon, said))
    store.add_participant(kept, Participant("ben", 2, "human", noon))
    store.record_consent("anna", "1", noon)
    store.add_comparisons(
        [
            Comparison("anna.c1", "anna", 1, 1, "M1", "M3", False, noon),
            Comparison("anna.c2", "anna", 2, 0, "M2", "M2", True, noon),
            Comparison("anna.c3", "anna", 3, 1, "M1", "M2", False, noon),
        ]
    )
    return kept


def trial(noon: datetime, comparison: str = "anna.c1", slot: str = "A", number: int = 1, **more) -> Trial:
    mode = {"anna.c1": ("M1", "M3"), "anna.c2": ("M2", "M2"), "anna.c3": ("M1", "M2")}[comparison]
    given = Trial(
        f"{comparison}.{slot}{number}",
        comparison,
        slot,
        number,
        mode[slot == "B"],
        "guided",
        "completed",
        noon,
        40.0,
        0,
        {"duration_s": 40.0, "force_mean_n": 17.0},
    )
    return replace(given, **more)


def answered(store: Store, study: StoredStudy, comparison: str, noon: datetime) -> None:
    store.submit_responses(comparison, {q.name: "A>B" for q in study.study.questions}, noon)


def test_a_row_is_the_mean_over_the_laps_of_a_mode_in_an_answered_comparison(store, stored, noon):
    store.add_trial(trial(noon))
    store.add_trial(trial(noon, number=2, metrics={"duration_s": 50.0, "force_mean_n": 19.0}))
    store.add_trial(trial(noon, number=3, outcome="abandoned", metrics={"force_mean_n": 90.0}))
    store.add_trial(trial(noon, slot="B", metrics={"force_mean_n": 12.0}))
    store.add_trial(trial(noon, "anna.c2"))
    store.add_trial(trial(noon, "anna.c3"))
    answered(store, stored, "anna.c1", noon)
    rows = store.metric_table(stored).rows
    assert rows[["comparison", "mode"]].to_numpy().tolist() == [["anna.c1", "M1"], ["anna.c1", "M3"]]
    assert rows["force_mean_n"].tolist() == [18.0, 12.0]
    assert rows["duration_s"].iloc[0] == 45.0
    assert math.isnan(rows["duration_s"].iloc[1])


def test_a_lap_that_was_cut_short_is_no_measure_of_how_long_a_lap_takes(store, stored, noon):
    store.add_trial(trial(noon))
    store.add_trial(trial(noon, number=2, outcome="stuck", metrics={"duration_s": 9.0, "force_mean_n": 21.0}))
    answered(store, stored, "anna.c1", noon)
    row = store.metric_table(stored).rows.iloc[0]
    assert (row["duration_s"], row["force_mean_n"]) == (40.0, 19.0)


def test_laps_from_before_a_comparison_was_begun_anew_are_no_evidence(store, stored, noon):
    later = noon + timedelta(hours=1)
    store.add_trial(trial(noon, metrics={"force_mean_n": 90.0}))
    store.restart_comparison("anna.c1", later)
    store.add_trial(trial(later, number=2))
    answered(store, stored, "anna.c1", later)
    assert store.metric_table(stored).rows["force_mean_n"].tolist() == [17.0]


def test_without_metrics_of_answered_comparisons_there_is_no_table(store, stored, noon):
    store.add_trial(trial(noon))
    assert store.metric_table(stored) is None


def test_the_background_is_what_was_said_to_the_studys_own_questions(store, stored, study):
    background = store.background_table(stored)
    assert background.questions == study.background
    assert background.answers == {"anna": {"robots": "Often"}}
