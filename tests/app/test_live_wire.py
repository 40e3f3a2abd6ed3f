"""The binary frames, the messages between the processes, and what a slow receiver gets."""

import asyncio
import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.server.live import wire
from app.server.live.channel import Inbox, Order, message
from app.server.live.connection import REFUSED, Connection, Strokes
from app.server.live.limits import Allowance
from app.server.live.route import BadMessage, parse_command
from app.server.live.wire import BadFrame, InputFrame, StateFrame, pack_input, pack_state, unpack_input
from sim_trials.live import LiveView

from .conftest import run_in_a_loop

GOOD = InputFrame(3, "touch", 7, -1.0, 0.25, 4.0, -8.0, 33.5, 120, 1234.5)
VIEW = LiveView(
    1.5, -0.5, 0.25, 4.0, -8.0, -0.75, 0.5, 0.625, 0.125, 0.25, (1, 2, 3, 4, 5, 6), True, False, True
)


def test_an_input_is_40_bytes_and_comes_out_as_it_went_in() -> None:
    content = pack_input(GOOD)
    assert content == struct.pack("<4BI5fId", 1, 1, 3, 2, 7, -1.0, 0.25, 4.0, -8.0, 33.5, 120, 1234.5)
    assert len(content) == 40
    assert unpack_input(content) == GOOD


@pytest.mark.parametrize(
    ("at", "form", "value"),
    [
        (0, "<B", 2),
        (1, "<B", 2),
        (2, "<B", 4),
        (3, "<B", 4),
        (4, "<I", 0),
        (8, "<f", math.nan),
        (8, "<f", 5.1),
        (12, "<f", -math.inf),
        (16, "<f", 91.0),
        (20, "<f", math.nan),
        (24, "<f", -2.0),
        (24, "<f", math.nan),
        (32, "<d", math.inf),
        (32, "<d", -1.0),
    ],
)
def test_an_input_with_a_wrong_number_is_refused(at: int, form: str, value: float) -> None:
    content = bytearray(pack_input(GOOD))
    struct.pack_into(form, content, at, value)
    with pytest.raises(BadFrame):
        unpack_input(bytes(content))


@given(st.binary(max_size=64))
def test_whatever_arrives_is_an_input_in_range_or_refused(content: bytes) -> None:
    try:
        said = unpack_input(content)
    except BadFrame:
        return
    assert len(content) == 40
    assert abs(said.hand_y_m) <= 5
    assert abs(said.tilt_z_deg) <= 90


def test_a_state_is_80_bytes_in_the_order_that_the_browser_reads() -> None:
    content = pack_state(StateFrame(7, 9, 11, True, VIEW))
    expected = (2, 1, 1 | 4 | 8, 0, 7, 9, 11, *VIEW[:10], *VIEW.q_rad)
    assert struct.unpack("<4B3I16f", content) == expected
    assert wire.unpack_state(content) == StateFrame(7, 9, 11, True, VIEW)
    assert wire.state_time_s(content) == 1.5


def test_strokes_are_numbered_points() -> None:
    points = struct.pack("<8f", 1, 2, 3, 0, 4, 5, 6, 1)
    assert wire.pack_strokes(7, 30, points) == struct.pack("<BBHII", 3, 1, 2, 7, 30) + points


@given(st.lists(st.binary(max_size=90), max_size=12), st.data())
def test_messages_come_out_whole_however_they_are_cut(contents: list[bytes], data: st.DataObject) -> None:
    stream = b"".join(message(Order.INPUT, content) for content in contents)
    inbox, found, at = Inbox(), [], 0
    while at < len(stream):
        end = data.draw(st.integers(at + 1, len(stream)))
        found += [content for _, content in inbox.take(stream[at:end])]
        at = end
    assert found == contents


def _sent(connection: Connection, *, takes: int) -> list[str | bytes]:
    """What a receiver that takes so many messages gets."""
    got: list[str | bytes] = []

    async def send(event: dict[str, str | bytes]) -> None:
        if len(got) == takes:
            await asyncio.Event().wait()
        got.append(event.get("text") or event.get("bytes") or str(event["code"]))

    async def pump() -> None:
        task = asyncio.ensure_future(connection.pump(send))  # type: ignore[arg-type]
        await asyncio.wait({task}, timeout=0.05)
        task.cancel()

    run_in_a_loop(pump())
    return got


def test_a_slow_receiver_gets_the_newest_state_and_all_strokes() -> None:
    strokes = Strokes(1)
    connection = Connection()
    connection.tell({"type": "trial"})
    connection.follow(strokes)
    for number in range(100):
        strokes.add(struct.pack("<4f", number, 0, 0, 0))
        connection.paint()
        connection.show(pack_state(StateFrame(1, number, 0, False, VIEW)))
    trial, painted, state = _sent(connection, takes=10)
    assert trial == '{"type":"trial"}'
    assert painted == strokes.frame(0)
    assert isinstance(state, bytes)
    assert wire.unpack_state(state).frame == 99


def test_what_a_lap_s_end_says_comes_after_its_last_stroke_and_state() -> None:
    strokes, last = Strokes(1), pack_state(StateFrame(1, 5, 0, True, VIEW))
    connection = Connection()
    connection.follow(strokes)
    strokes.add(struct.pack("<4f", 1, 0, 0, 1))
    connection.show(last)
    connection.flush()
    connection.tell({"type": "ended"})
    assert _sent(connection, takes=10) == [strokes.frame(0), last, '{"type":"ended"}']


def test_who_asks_and_does_not_listen_is_closed_and_nothing_piles_up() -> None:
    connection = Connection()
    for _ in range(10_000):
        connection.tell({"type": "trial"})
    assert connection.is_closing
    assert _sent(connection, takes=10) == [str(REFUSED)]


def test_strokes_longer_than_a_frame_come_in_several() -> None:
    strokes = Strokes(1)
    strokes.add(b"\0" * 16 * (wire.MOST_POINTS + 5))
    connection = Connection()
    connection.follow(strokes)
    connection.paint()
    sizes = [(len(frame) - 12) // 16 for frame in _sent(connection, takes=10)]
    assert sizes == [wire.MOST_POINTS, 5]


def test_an_allowance_lets_saved_up_messages_pass_but_no_steady_excess() -> None:
    now = 0.0
    allowance = Allowance(250.0, 1250.0, lambda: now)
    assert sum(allowance.take() for _ in range(400)) == 250
    now = 5.0
    assert sum(allowance.take() for _ in range(2000)) == 1250
    passed = 0
    for _ in range(1000):
        now += 0.002
        passed += allowance.take()
    assert passed == pytest.approx(500, abs=2)


@pytest.mark.parametrize(
    "text",
    [
        "", "null", "[]", "3", '"open"', "{}", '{"type":"open"}', '{"type":"open","slot":"C"}',
        '{"type":"open","slot":["A"]}', '{"type":"open","slot":"A","mode":"x"}', '{"type":"finish","x":1}',
        '{"type":["open"],"slot":"A"}', '{"type":"halt"}', "[" * 1000, " " * 2000 + '{"type":"finish"}',
    ],
)  # fmt: skip
def test_a_message_that_our_page_never_sends_is_refused(text: str) -> None:
    with pytest.raises(BadMessage):
        parse_command(text)


def test_our_own_messages_are_understood() -> None:
    assert parse_command('{"type":"open","slot":"B"}') == ("open", "B")
    assert parse_command('{"type":"restart"}') == ("restart", None)
    assert parse_command('{"type":"finish"}') == ("finish", None)
