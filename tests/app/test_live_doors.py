"""Who gets to the robot, and what happens to those who send what they must not; nobody else feels it."""

import json
import struct
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.live.wire import InputFrame, pack_input
from app.server.visitors import new_researcher_cookie, new_token
from data.store import token_sha256
from tests.conftest import PATIENCE_S

from .conftest import Server
from .live_browser import LiveBrowser

INPUT = pack_input(InputFrame(3, "mouse", 1, 0.3, 0.45, 0.0, 0.0, -1.0, 1, 1.0))
NOT_A_NUMBER = INPUT[:8] + struct.pack("<f", float("nan")) + INPUT[12:]


@contextmanager
def somebody_guiding(server: Server) -> Iterator[None]:
    """Another participant guides the robot meanwhile, and notices nothing."""
    cookie, _ = server.join()
    said_by_then: list[int] = []

    def is_obeyed() -> bool:
        """Whether the robot does by now what was said after all that happened."""
        state = other.state
        return bool(said_by_then and state and state.view.is_enabled and state.input_seq > said_by_then[0])

    with LiveBrowser(server, cookie) as other, ThreadPoolExecutor(1) as thread:
        other.open("A")
        other.guide(0.1)
        guiding = thread.submit(other.guide_until, is_obeyed)
        try:
            yield
        finally:
            said_by_then.append(other.seq)
            guiding.result()
        assert other.close_code is None
        assert [said["type"] for said in other.told] == ["welcome", "trial"]


@pytest.mark.parametrize(
    "messages",
    [
        pytest.param([INPUT[:-1]], id="too short"),
        pytest.param([INPUT + b"\0"], id="too long"),
        pytest.param([b""], id="empty"),
        pytest.param([NOT_A_NUMBER], id="not a number"),
        pytest.param([b"\x02" + INPUT[1:]], id="a state"),
        pytest.param([INPUT, INPUT], id="the same number twice"),
        pytest.param(["{"], id="no JSON"),
        pytest.param(['{"type":"open","slot":"M1"}'], id="no slot"),
        pytest.param(["x" * 1025], id="an oversized text"),
        pytest.param([b"x" * 200_000], id="an oversized frame"),
        pytest.param(['{"type":"finish"}'] * 200, id="texts too fast"),
    ],
)
def test_what_our_page_never_sends_closes_the_socket(
    guided_server: Server, messages: list[str | bytes]
) -> None:
    cookie, _ = guided_server.join()
    with somebody_guiding(guided_server), LiveBrowser(guided_server, cookie) as forger:
        forger.open("A")
        try:
            for message in messages:
                forger.socket.send(message)
        except ConnectionClosed:
            pass
        assert forger.until_closed() == 1008
    assert "live: refused" in guided_server.log.read_text()
    assert cookie.partition(".")[0] not in guided_server.log.read_text()


def test_frames_that_come_too_fast_close_the_socket(guided_server: Server) -> None:
    cookie, _ = guided_server.join()
    with somebody_guiding(guided_server), LiveBrowser(guided_server, cookie) as hasty:
        hasty.open("A")
        try:
            for _ in range(3000):
                hasty.hold(0.3, 0.45)
        except ConnectionClosed:
            pass
        assert hasty.until_closed() == 1008


def test_laps_begun_by_the_dozen_are_put_off_and_not_run(guided_server: Server) -> None:
    cookie, _ = guided_server.join()
    with somebody_guiding(guided_server), LiveBrowser(guided_server, cookie) as hasty:
        begun = time.monotonic()
        hasty.open("A")
        for _ in range(15):
            hasty.tell("restart")
        hasty.tell("finish")
        hasty.until("finished")
        passed_s = time.monotonic() - begun
        # Eight at once, and one more a second.
        assert sum(said["type"] == "trial" for said in hasty.told) <= 8 + passed_s
        assert hasty.close_code is None


def test_another_origin_is_refused_before_the_socket_opens(guided_server: Server) -> None:
    cookie, _ = guided_server.join()
    for origin in ("http://evil.example", "null"):
        with pytest.raises(InvalidStatus) as refused, LiveBrowser(guided_server, cookie, origin=origin):
            pass
        assert refused.value.response.status_code == 403


@pytest.mark.parametrize("cookie", ["", "guessed", "guessed.nonce"])
def test_a_guessed_cookie_opens_nothing(guided_server: Server, cookie: str) -> None:
    with LiveBrowser(guided_server, cookie) as nobody:
        assert nobody.until_closed() == 4003
        assert nobody.received == []


def test_a_researcher_s_cookie_does_not_open_it(guided_server: Server) -> None:
    store = guided_server.store
    stored, token = store.studies()[0], new_token()
    store.create_link("researcher", stored, token_sha256(token))
    desk = Desk(stored, store, LapKeeper(stored.study, store.recordings_folder, 1))
    with LiveBrowser(guided_server, new_researcher_cookie(desk, token)) as researcher:
        assert researcher.until_closed() == 4003


def test_a_visitor_before_consent_is_nobody_yet(guided_server: Server) -> None:
    cookie = guided_server.participant_url.rpartition("/")[2] + ".nonce"
    with LiveBrowser(guided_server, cookie) as visitor:
        assert visitor.until_closed() == 4003


def test_sockets_by_the_dozen_are_refused(guided_server: Server) -> None:
    cookie, _ = guided_server.join()

    def code_of_another(_: int) -> int | None:
        with LiveBrowser(guided_server, cookie) as browser:
            browser.read(PATIENCE_S)
            return browser.close_code

    # At once, so that a server that has little time counts them within a second, too.
    with ThreadPoolExecutor(12) as threads:
        assert 1008 in threads.map(code_of_another, range(12))


def test_no_live_route_where_laps_are_watched(server: Server) -> None:
    cookie, _ = server.join()
    with pytest.raises(InvalidStatus), LiveBrowser(server, cookie):
        pass


def test_a_command_says_a_slot_and_never_a_mode(guided_server: Server) -> None:
    cookie, participant = guided_server.join()
    mode = guided_server.store.comparison(f"{participant.id}.c1").mode_a
    with LiveBrowser(guided_server, cookie) as curious:
        curious.socket.send(json.dumps({"type": "open", "slot": "A", "mode": mode}))
        assert curious.until_closed() == 1008
