"""Who is where, and withdrawing somebody."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from app.console.people import RECENTLY, Seat, ago, seats
from app.console.sessions_page import connection, session_row
from app.console.style import Mark
from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.live.board import LiveRow
from app.server.visitors import admit, new_token
from data.records import Trial
from data.store import Store, token_sha256
from data.study_file import parse_study

from .conftest import TINY_STUDY

NOW = datetime(2026, 5, 4, 9, 0, tzinfo=UTC)


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    with Store.open(tmp_path / "study.sqlite", clock=lambda: NOW) as store:
        stored = store.add_study(parse_study(TINY_STUDY, "tiny.toml"), TINY_STUDY)
        yield Desk(stored, store, LapKeeper(stored.study, store.recordings_folder, 1))


def joined(desk: Desk) -> str:
    """A participant whose first comparison is open, with one stuck trial."""
    token = new_token()
    desk.store.create_link("participant", desk.stored_study, token_sha256(token))
    person = admit(desk, f"{token}.nonce")
    first = desk.store.comparisons(participant=person.id)[0]
    desk.store.start_comparison(first.id, NOW)
    desk.store.add_trial(
        Trial(f"{first.id}.A1", first.id, "A", 1, first.mode_a, "observed", "stuck", NOW, 12.0, 1)
    )
    return person.id


def live_row(**changes: object) -> LiveRow:
    row = LiveRow(
        participant="p",
        number=1,
        comparison=1,
        slot="A",
        lap=2,
        is_connected=True,
        since=NOW,
        device="mouse",
        latency_median_ms=13.6,
        latency_p95_ms=21.2,
        frame_rate_hz=59.9,
        skipped_share=0.0,
        trials=3,
        stuck=1,
    )
    return replace(row, **changes)  # type: ignore[arg-type]


def seat_of(desk: Desk, live: LiveRow | None = None) -> Seat:
    joined(desk)
    (seat,) = seats(desk)
    return replace(seat, live=live)


def test_a_seat_says_where_somebody_is_by_what_is_stored(desk: Desk) -> None:
    seat = seat_of(desk)
    assert (seat.name, seat.where, seat.comparison, seat.comparisons) == ("P01", "comparing", 1, 1)
    assert (seat.trials, seat.stuck, seat.answered) == (1, 1, 0)
    assert seat.seen_at == NOW + timedelta(seconds=12)


def test_a_trial_that_is_stored_later_is_counted(desk: Desk) -> None:
    person = joined(desk)
    assert seats(desk)[0].trials == 1
    first = desk.store.comparisons(participant=person)[0]
    desk.store.add_trial(
        Trial(f"{first.id}.B1", first.id, "B", 1, first.mode_b, "observed", "completed", NOW, 40.0, 1)
    )
    (seat,) = seats(desk)
    assert (seat.trials, seat.stuck) == (2, 1)
    assert seat.seen_at == NOW + timedelta(seconds=40)


def test_at_the_robot_the_slot_and_the_lap_are_told_and_no_mode(desk: Desk) -> None:
    row = session_row(seat_of(desk, live_row()), NOW)
    assert row[:5] == ("P01", "guiding A, lap 2", "1 of 1", "mouse", "1")
    assert row[5:7] == ("14, 21 ms", "60/s, 0.0 % skipped")
    assert not any(mode in str(row) for mode in ("Zwetschge", "Mirabelle"))


@pytest.mark.parametrize(
    ("changes", "mark"),
    [
        ({}, Mark("good", "connected")),
        ({"is_connected": False}, Mark("off", "away")),
        ({"latency_p95_ms": 90.0}, Mark("warn", "slow")),
        ({"frame_rate_hz": 20.0}, Mark("warn", "few frames")),
        ({"skipped_share": 0.04}, Mark("warn", "4.0 % of ticks skipped")),
        (
            {"latency_median_ms": None, "latency_p95_ms": None, "frame_rate_hz": None},
            Mark("good", "connected"),
        ),
    ],
)
def test_a_poor_connection_is_marked(desk: Desk, changes: dict[str, object], mark: Mark) -> None:
    assert connection(seat_of(desk, live_row(**changes))) == mark


def test_who_left_hours_ago_is_not_in_a_session(desk: Desk) -> None:
    seat = seat_of(desk)
    assert seat.is_present(NOW)
    assert not seat.is_present(NOW + RECENTLY + timedelta(minutes=1))


def test_who_has_withdrawn_is_in_no_session_and_nothing_is_left_of_them(desk: Desk) -> None:
    person = joined(desk)
    desk.store.withdraw(person, "researcher", NOW)
    (seat,) = seats(desk)
    assert (seat.where, seat.trials, seat.comparisons) == ("withdrawn", 0, 0)
    assert not seat.is_present(NOW)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0, "now"),
        (30, "30 s ago"),
        (90, "1 min ago"),
        (7300, "2 h ago"),
        (90_000, "25 h ago"),
        (200_000, "2 days ago"),
    ],
)
def test_how_long_ago_is_said_in_the_largest_unit_that_fits(seconds: float, words: str) -> None:
    assert ago(timedelta(seconds=seconds)) == words
