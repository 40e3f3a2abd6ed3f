"""Runs on a robot in the lab, on a real store with a clock of the test's own."""

import math
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from app.operator import session
from app.operator.roster import roster
from data.errors import ElbowroomError
from data.records import Comparison, Participant
from data.store import Store, StoredStudy
from data.study_file import parse_study

NOON = datetime(2026, 3, 4, 12, 0, tzinfo=UTC)
LAB_STUDY = """
format = 1
name = "lab"
title = "Zweifelhaft"
seed = 5
[consent]
version = "7"
text = "You will guide a robot."
[[modes]]
name = "Zwetschge"
description = "Quitte"
parameters = { lambda0 = 0.2 }
[[modes]]
name = "Mirabelle"
description = "Holler"
parameters = { lambda0 = 0.6 }
[[questions]]
name = "Q1"
wording = "Which method felt safest to use?"
short = "safest"
levels = 3
[protocol]
trial_source = "external"
repetitions = 1
minimum_exposure_s = 2
"""


def at(seconds: float) -> datetime:
    return NOON + timedelta(seconds=seconds)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path / "study.sqlite", clock=lambda: NOON) as opened:
        yield opened


@pytest.fixture
def study(store: Store) -> StoredStudy:
    return store.add_study(parse_study(LAB_STUDY, where="lab"), LAB_STUDY)


@pytest.fixture
def comparison(store: Store, study: StoredStudy) -> Comparison:
    """A comparison that was begun at noon and is not answered."""
    store.add_participant(study, Participant("anna", 1, "human", NOON))
    store.record_consent("anna", "7", NOON)
    store.add_comparisons([Comparison("anna.c1", "anna", 1, 1, "Zwetschge", "Mirabelle", False)])
    return store.start_comparison("anna.c1", NOON)


def run(store: Store, comparison: Comparison, slot: str, begin_s: float) -> None:
    session.turn_to(store, comparison, slot, at(begin_s))
    session.loaded(store, comparison, slot)
    session.start(store, comparison, slot, at(begin_s))


def steps(store: Store, comparison: Comparison) -> str:
    return session.standing(store, comparison).step


def test_a_lap_goes_from_loading_to_a_trial_with_the_mode_behind_its_slot(store, comparison):
    assert steps(store, comparison) == "load"
    session.loaded(store, comparison, "A")
    assert steps(store, comparison) == "start"
    session.start(store, comparison, "A", at(10))
    assert steps(store, comparison) == "run"
    session.end(store, comparison, at(10), "completed", at(52.5))
    (trial,) = store.trials(comparison=comparison.id)
    assert (trial.id, trial.mode, trial.source, trial.outcome) == (
        "anna.c1.A1", "Zwetschge", "external", "completed",
    )  # fmt: skip
    assert (trial.started_at, trial.duration_s, trial.events, trial.recording) == (at(10), 42.5, (), None)
    assert steps(store, comparison) == "start"


def test_a_stuck_run_has_an_event_of_the_operators_and_asks_for_a_reset(store, comparison):
    run(store, comparison, "A", 0)
    session.end(store, comparison, at(0), "stuck", at(12))
    (trial,) = store.trials(comparison=comparison.id)
    (event,) = trial.events
    assert (event.kind, event.time_s, event.phase, event.definition) == ("stuck", 12.0, "", "operator/1")
    assert math.isnan(event.sigma_min)
    assert steps(store, comparison) == "reset"
    session.start(store, comparison, "A", at(13))
    assert steps(store, comparison) == "reset"
    session.loaded(store, comparison, "A")
    assert steps(store, comparison) == "start"


def test_turning_to_the_other_method_abandons_the_run_and_its_time_counts(store, comparison):
    run(store, comparison, "A", 0)
    session.turn_to(store, comparison, "B", at(7))
    (trial,) = store.trials(comparison=comparison.id)
    assert (trial.slot, trial.outcome, trial.duration_s) == ("A", "abandoned", 7.0)
    assert [(s.number, s.slot, s.at) for s in store.switches(comparison.id)] == [(1, "B", at(7))]
    assert session.standing(store, comparison).exposure_s == {"A": 7.0, "B": 0.0}
    assert steps(store, comparison) == "load"
    session.turn_to(store, comparison, "A", at(8))
    assert steps(store, comparison) == "reset"


def test_clicks_that_come_twice_or_too_late_change_nothing(store, comparison):
    run(store, comparison, "B", 3)
    session.start(store, comparison, "B", at(9))
    assert store.external_run(comparison.id).started_at == at(3)
    session.loaded(store, comparison, "A")
    assert store.external_run(comparison.id).loaded == "B"
    session.turn_to(store, comparison, "B", at(4))
    session.end(store, comparison, at(3), "completed", at(20))
    session.end(store, comparison, at(3), "stuck", at(21))
    session.start(store, comparison, "B", at(30))
    session.end(store, comparison, at(3), "stuck", at(31))
    session.end(store, comparison, None, "stuck", at(32))
    assert [trial.outcome for trial in store.trials(comparison=comparison.id)] == ["completed"]
    assert store.external_run(comparison.id).started_at == at(30)
    assert len(store.switches(comparison.id)) == 1


def test_what_was_loaded_for_the_other_method_does_not_start(store, comparison):
    session.loaded(store, comparison, "A")
    session.turn_to(store, comparison, "B", at(1))
    session.start(store, comparison, "A", at(2))
    session.start(store, comparison, "B", at(2))
    assert store.external_run(comparison.id).started_at is None
    assert steps(store, comparison) == "load"


def test_runs_are_numbered_by_slot_and_add_up_to_the_exposure(store, comparison):
    for slot, begin, finish in (("A", 0, 10), ("B", 20, 25), ("A", 30, 33)):
        run(store, comparison, slot, begin)
        session.end(store, comparison, at(begin), "completed", at(finish))
    standing = session.standing(store, comparison)
    assert [trial.id for trial in standing.trials] == ["anna.c1.A1", "anna.c1.B1", "anna.c1.A2"]
    assert standing.exposure_s == {"A": 13.0, "B": 5.0}
    session.start(store, comparison, "A", at(40))
    standing = session.standing(store, comparison)
    assert standing.running_s(at(44)) == 4.0
    assert standing.exposure_by(at(44)) == {"A": 17.0, "B": 5.0}


def test_a_run_goes_on_where_a_killed_server_left_it(store, comparison, tmp_path):
    run(store, comparison, "B", 4)
    with Store.open(tmp_path / "study.sqlite") as after:
        assert steps(after, comparison) == "run"
        session.end(after, comparison, at(4), "completed", at(34))
    assert [(t.slot, t.duration_s) for t in store.trials(comparison=comparison.id)] == [("B", 30.0)]


def test_time_before_a_new_beginning_does_not_count(store, comparison):
    run(store, comparison, "A", 0)
    session.end(store, comparison, at(0), "completed", at(10))
    session.start(store, comparison, "A", at(20))
    begun_anew = store.restart_comparison(comparison.id, at(30))
    assert session.standing(store, begun_anew).exposure_by(at(60)) == {"A": 0.0, "B": 0.0}


def test_going_on_to_the_questions_ends_the_run(store, comparison):
    run(store, comparison, "A", 0)
    session.finish(store, comparison.id, at(5))
    session.finish(store, comparison.id, at(6))
    assert [(t.outcome, t.duration_s) for t in store.trials(comparison=comparison.id)] == [("abandoned", 5.0)]


def test_nothing_begins_after_the_answers(store, comparison):
    run(store, comparison, "A", 0)
    store.submit_responses(comparison.id, {"Q1": "A>B"}, at(9))
    session.finish(store, comparison.id, at(9))
    session.turn_to(store, comparison, "B", at(10))
    session.loaded(store, comparison, "A")
    session.start(store, comparison, "A", at(11))
    assert store.switches(comparison.id) == ()
    assert store.external_run(comparison.id).started_at is None


def test_a_corrected_outcome_is_what_counts_and_the_audit_log_keeps_both(store, study, comparison):
    run(store, comparison, "A", 0)
    session.end(store, comparison, at(0), "completed", at(8))
    (trial,) = store.trials(comparison=comparison.id)
    for _ in range(2):
        session.correct(store, trial, "stuck", at(9))
    (corrected,) = store.trials(comparison=comparison.id)
    assert replace(corrected, outcome="completed", events=()) == trial
    assert (corrected.outcome, corrected.events[0].time_s) == ("stuck", 8.0)
    table = store.stuck_table(study)
    assert table is not None
    assert dict(zip(table.rows["mode"], table.rows["stuck"], strict=True)) == {
        "Zwetschge": True, "Mirabelle": False,
    }  # fmt: skip
    (entry,) = store.audit_log()
    assert (entry.action, entry.detail["from"], entry.detail["to"]) == (
        "correct outcome", "completed", "stuck",
    )  # fmt: skip
    session.correct(store, corrected, "completed", at(10))
    assert store.trial(trial.id) == trial
    store.submit_responses(comparison.id, {"Q1": "A>B"}, at(11))
    session.correct(store, trial, "stuck", at(12))
    assert store.trial(trial.id) == trial


def test_an_outcome_that_was_measured_cannot_be_corrected(store, comparison):
    run(store, comparison, "A", 0)
    session.end(store, comparison, at(0), "completed", at(8))
    (trial,) = store.trials(comparison=comparison.id)
    store.add_trial(replace(trial, id="anna.c1.A2", number=2, source="observed"))
    with pytest.raises(ElbowroomError, match="measured"):
        store.correct_outcome("anna.c1.A2", "stuck", ())


def test_the_roster_begins_with_who_began_last_and_leaves_out_who_is_done(store, study, comparison):
    for number, name in enumerate(("bert", "cleo", "dora", "emil"), start=2):
        store.add_participant(study, Participant(name, number, "human", NOON))
        if name != "emil":
            store.record_consent(name, "7", NOON)
        store.add_comparisons([Comparison(f"{name}.c1", name, 1, 1, "Mirabelle", "Zwetschge", False)])
    store.start_comparison("bert.c1", at(60))
    store.finish_participant("dora", at(70))
    assert [progress.participant.id for progress in roster(store, study)] == ["bert", "anna", "cleo"]


def test_the_pages_and_the_session_need_no_simulator():
    code = """
import sys
import app.operator.page, app.operator.session, app.participant.external, app.server.asgi, app.server.serving
from app.studies import open_study
assert open_study("lab2017").study.protocol.trial_source == "external"
print(sorted({"mujoco", "numba", "sim_trials"} & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
