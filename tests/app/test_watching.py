"""Laps, reports of what was watched, and answers, as the participant's page sends them."""

import json
import struct
from datetime import timedelta

import pytest

from app.participant.blinding import questions_data
from app.participant.progress import progress_of
from app.participant.watching import BadReport, WatchReport
from data.records import Participant
from data.study_file import parse_study

from .conftest import SECRETS, TINY_STUDY, Server

ANSWERS = {"Q1": "A>B", "Q2": "B>A"}


def run(slot: str, seconds: float, number: int = 1) -> dict[str, object]:
    return {"kind": "run", "slot": slot, "lap": 1, "number": number, "watched_s": seconds}


def report(*events: dict[str, object]) -> dict[str, object]:
    return {"comparison": 1, "events": list(events)}


@pytest.fixture
def watcher(server: Server) -> tuple[str, Participant]:
    """A participant whose first comparison has been open for a minute."""
    cookie, participant = server.join()
    with server.store.transaction() as connection:
        from sqlalchemy import update

        from data.store.tables import comparisons

        earlier = server.store.clock() - timedelta(minutes=1)
        here = comparisons.c.id == f"{participant.id}.c1"
        connection.execute(update(comparisons).where(here).values(started_at=earlier))
    return cookie, participant


def test_a_lap_is_motion_and_nothing_else(server: Server, watcher: tuple[str, Participant]) -> None:
    cookie, _ = watcher
    replies = {slot: server.ask(f"/laps/{slot}/1", cookie=cookie) for slot in "AB"}
    headers = [
        {name: value for name, value in reply.headers.items() if name not in ("content-length", "date")}
        for reply in replies.values()
    ]
    assert headers[0] == headers[1]
    for reply in replies.values():
        magic, version, columns, rows, hz, duration, outcome = struct.unpack("<4sHHIffB3x", reply.body[:24])
        assert (magic, version, columns, hz) == (b"ELAP", 1, 16, 25.0)
        assert outcome in (0, 1, 2)
        assert len(reply.body) == 24 + 4 * columns * rows
        assert (rows - 1) / hz == pytest.approx(duration, abs=1.001 / hz)
        assert not any(secret.encode() in reply.body for secret in SECRETS)
    assert replies["A"].body != replies["B"].body
    assert server.ask("/laps/A/1", cookie=cookie).body == replies["A"].body


@pytest.mark.parametrize("path", ["/laps/C/1", "/laps/A/2", "/laps/A/0", "/laps/Zwetschge/1"])
def test_a_lap_that_there_is_not_is_not_found(
    server: Server, watcher: tuple[str, Participant], path: str
) -> None:
    assert server.ask(path, cookie=watcher[0]).status == 404


def test_what_was_watched_becomes_trials_and_switches(
    server: Server, watcher: tuple[str, Participant]
) -> None:
    cookie, participant = watcher
    turn = {"kind": "switch", "number": 1, "slot": "B"}
    body = report(run("A", 3.25), turn, run("B", 2.0))
    assert server.ask("/watched", "POST", cookie=cookie, content=body).status == 200
    assert server.ask("/watched", "POST", cookie=cookie, content=body).status == 200
    comparison = server.store.comparison(f"{participant.id}.c1")
    trials = server.store.trials(comparison=comparison.id)
    assert [(t.id, t.mode, t.outcome, t.duration_s, t.source, dict(t.metrics)) for t in trials] == [
        (f"{comparison.id}.A1", comparison.mode_a, "abandoned", 3.25, "observed", {"lap": 1.0}),
        (f"{comparison.id}.B1", comparison.mode_b, "abandoned", 2.0, "observed", {"lap": 1.0}),
    ]
    assert trials[0].seed == trials[1].seed
    assert all(server.store.recording_path(trial).is_file() for trial in trials)
    assert [(s.number, s.slot) for s in server.store.switches(comparison.id)] == [(1, "B")]


def test_a_lap_watched_to_its_end_has_its_outcome_and_metrics(
    server: Server, watcher: tuple[str, Participant]
) -> None:
    cookie, participant = watcher
    duration, outcome = struct.unpack("<fB", server.ask("/laps/A/1", cookie=cookie).body[16:21])
    server.ask("/watched", "POST", cookie=cookie, content=report(run("A", duration)))
    (trial,) = server.store.trials(comparison=f"{participant.id}.c1")
    assert trial.outcome == ("completed", "stuck", "failed")[outcome]
    assert [event.kind for event in trial.events if event.kind == "stuck"] == ["stuck"] * (outcome == 1)
    assert trial.metrics["duration_s"] == pytest.approx(duration, abs=0.02)


def test_a_second_window_s_run_of_the_same_number_is_kept_as_well(
    server: Server, watcher: tuple[str, Participant]
) -> None:
    cookie, participant = watcher
    for seconds in (1.0, 2.0):
        server.ask("/watched", "POST", cookie=cookie, content=report(run("A", seconds)))
    trials = server.store.trials(comparison=f"{participant.id}.c1")
    assert [(trial.number, trial.duration_s) for trial in trials] == [(1, 1.0), (2, 2.0)]


@pytest.mark.parametrize("seconds", [9e9, -1.0, 300.0])
def test_nobody_watches_longer_than_there_was_time_for(
    server: Server, watcher: tuple[str, Participant], seconds: float
) -> None:
    cookie, participant = watcher
    assert server.ask("/watched", "POST", cookie=cookie, content=report(run("A", seconds))).status == 422
    assert server.store.trials(comparison=f"{participant.id}.c1") == ()


def test_answers_wait_for_the_least_time_with_both(server: Server, watcher: tuple[str, Participant]) -> None:
    cookie, participant = watcher
    answers = {"comparison": 1, "answers": ANSWERS}
    server.ask("/watched", "POST", cookie=cookie, content=report(run("A", 5.0)))
    assert server.ask("/answers", "POST", cookie=cookie, content=answers).status == 422
    assert server.store.responses(f"{participant.id}.c1") == ()


def test_answers_are_stored_once_and_the_last_ones_finish(
    server: Server, watcher: tuple[str, Participant]
) -> None:
    cookie, participant = watcher
    server.ask("/watched", "POST", cookie=cookie, content=report(run("A", 5.0), run("B", 5.0)))
    sent = {"comparison": 1, "answers": ANSWERS}
    assert server.ask("/answers", "POST", cookie=cookie, content=sent).status == 200
    assert server.ask("/answers", "POST", cookie=cookie, content=sent).status == 409
    stored = server.store.responses(f"{participant.id}.c1")
    assert {response.question: response.answer for response in stored} == ANSWERS
    assert server.store.participant(participant.id).finished_at is not None


@pytest.mark.parametrize(
    "answers", [{"Q1": "A>B"}, {"Q1": "A>B", "Q2": "A>>B"}, {**ANSWERS, "Q9": "A>B"}, [], None]
)
def test_incomplete_or_unknown_answers_are_refused_whole(
    server: Server, watcher: tuple[str, Participant], answers: object
) -> None:
    cookie, participant = watcher
    server.ask("/watched", "POST", cookie=cookie, content=report(run("A", 5.0), run("B", 5.0)))
    sent = {"comparison": 1, "answers": answers}
    assert server.ask("/answers", "POST", cookie=cookie, content=sent).status == 422
    assert server.store.responses(f"{participant.id}.c1") == ()


@pytest.mark.parametrize(
    "event",
    [
        "run",
        {},
        {"kind": "run", "slot": "C", "lap": 1, "number": 1, "watched_s": 1},
        {"kind": "run", "slot": "A", "lap": 2, "number": 1, "watched_s": 1},
        {"kind": "run", "slot": "A", "lap": 1, "number": 0, "watched_s": 1},
        {"kind": "run", "slot": "A", "lap": True, "number": 1, "watched_s": 1},
        {"kind": "run", "slot": "A", "lap": 1, "number": 1, "watched_s": float("nan")},
        {"kind": "run", "slot": "A", "lap": 1, "number": 1, "watched_s": "1"},
        {"kind": "jump", "slot": "A", "number": 1},
    ],
)
def test_a_report_that_no_page_sends_is_refused(event: object) -> None:
    study = parse_study(TINY_STUDY, "tiny")
    with pytest.raises(BadReport):
        WatchReport.parse({"events": [event]}, study)


@pytest.mark.parametrize("body", ["[" * 60_000, '{"a":' * 10_000, '{"comparison": ' + "9" * 5_000 + "}"])
@pytest.mark.parametrize("path", ["/watched", "/answers"])
def test_a_body_that_no_parser_likes_is_refused_quietly(
    server: Server, watcher: tuple[str, Participant], path: str, body: str
) -> None:
    assert server.ask(path, "POST", cookie=watcher[0], raw=body).status == 422


def test_seconds_beyond_every_number_are_refused() -> None:
    with pytest.raises(BadReport, match="seconds from 0 to 3600"):
        WatchReport.parse(report(run("A", 10**400)), parse_study(TINY_STUDY, "tiny"))


def test_a_flood_of_events_is_refused_as_a_whole_and_the_page_learns_what_counts(
    server: Server, watcher: tuple[str, Participant]
) -> None:
    cookie, participant = watcher
    for first in range(1, 2001, 500):
        turns = [{"kind": "switch", "number": first + i, "slot": "A"} for i in range(500)]
        assert server.ask("/watched", "POST", cookie=cookie, content=report(*turns)).status == 200
    reply = server.ask("/watched", "POST", cookie=cookie, content=report(run("A", 1.0)))
    assert reply.status == 422
    assert json.loads(reply.body)["watched"] == {"A": 0.0, "B": 0.0}
    assert server.store.trials(comparison=f"{participant.id}.c1") == ()


def test_the_questions_are_told_nothing_of_the_study_s_hash(
    server: Server, watcher: tuple[str, Participant]
) -> None:
    _, participant = watcher
    stored = server.store.studies()[0]
    progress = progress_of(server.store, participant)
    assert progress.comparison is not None
    told = json.dumps(questions_data(stored.study, progress, progress.comparison))
    assert stored.sha256[:6] not in told
