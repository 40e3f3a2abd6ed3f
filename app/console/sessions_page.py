"""Sessions: who is where right now, how well it runs for them, and withdrawing somebody's data."""

from datetime import datetime

import streamlit as st

from app.console.people import Seat, ago, seats
from app.console.style import Cell, Mark, card, heading, headline, table
from app.console.withdrawing import withdraw_button
from app.server.desk import Desk

REFRESH_S = 2
SLOW_MS = 50.0
"""A delay from hand to picture above which guiding feels heavy: the trial is marked. Untuned."""
SKIPPED_SHARE = 0.01
FEW_FRAMES_HZ = 45.0

_HEAD = ("Participant", "Where", "Comparison", "Input", "Stuck", "Delay", "Frames", "Connection", "Last seen")


def show(desk: Desk) -> None:
    """Those in a session now, and below everybody who ever joined."""
    headline("Sessions")
    with card("now"):
        _now(desk)
    with card("everyone"):
        heading("Everyone who joined")
        everyone = seats(desk)
        _everyone(desk, everyone)
    withdraw_button(desk, everyone)


@st.fragment(run_every=REFRESH_S)
def _now(desk: Desk) -> None:
    heading("In a session now", f"updates every {REFRESH_S} s")
    now = desk.clock()
    present = [seat for seat in seats(desk) if seat.is_present(now)]
    if not present:
        st.caption("Nobody at the moment. Links for participants are on the page Links.")
        return
    sessions_table(present, now)


def sessions_table(present: list[Seat], now: datetime) -> None:
    """One row for everybody who is there."""
    table(_HEAD, [session_row(seat, now) for seat in present], numbers=(4, 5))


def session_row(seat: Seat, now: datetime) -> tuple[Cell, ...]:
    """What is shown of one participant's session."""
    live = seat.live
    return (
        seat.name,
        seat.where,
        f"{seat.comparison} of {seat.comparisons}" if seat.comparison else f"{seat.answered} answered",
        seat.device or "–",
        str(seat.stuck),
        _delay(seat),
        _frames(seat),
        connection(seat),
        "now" if live and live.is_connected else ago(now - seat.seen_at),
    )


def connection(seat: Seat) -> Cell:
    """How the connection is: a sign and a word."""
    live = seat.live
    if live is None:
        return Mark("off", "not at the robot")
    if not live.is_connected:
        return Mark("off", "away")
    if live.latency_p95_ms is not None and live.latency_p95_ms > SLOW_MS:
        return Mark("warn", "slow")
    if live.skipped_share > SKIPPED_SHARE:
        return Mark("warn", f"{100 * live.skipped_share:.1f} % of ticks skipped")
    if live.frame_rate_hz is not None and live.frame_rate_hz < FEW_FRAMES_HZ:
        return Mark("warn", "few frames")
    return Mark("good", "connected")


def _delay(seat: Seat) -> str:
    live = seat.live
    if live is None or live.latency_median_ms is None or live.latency_p95_ms is None:
        return "–"
    return f"{live.latency_median_ms:.0f}, {live.latency_p95_ms:.0f} ms"


def _frames(seat: Seat) -> str:
    live = seat.live
    if live is None:
        return "–"
    skipped = f"{100 * live.skipped_share:.1f} % skipped"
    return f"{live.frame_rate_hz:.0f}/s, {skipped}" if live.frame_rate_hz is not None else skipped


def _everyone(desk: Desk, everyone: tuple[Seat, ...]) -> None:
    if not everyone:
        st.caption("Nobody has joined yet.")
        return
    now = desk.clock()
    table(
        ("Participant", "Where", "Answered", "Trials", "Stuck", "Input", "Joined", "Last seen"),
        [
            (
                seat.name,
                seat.where,
                f"{seat.answered} of {seat.comparisons}",
                str(seat.trials),
                str(seat.stuck),
                seat.device or "–",
                seat.participant.joined_at.strftime("%Y-%m-%d %H:%M UTC"),
                ago(now - seat.seen_at),
            )
            for seat in everyone
        ],
        numbers=(2, 3, 4),
    )
