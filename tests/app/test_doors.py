"""Who gets in: links, cookies, origins."""

import asyncio
import http.client
import logging
from urllib.parse import urlsplit

import pytest

from app.server.access_log import Discretion, masked
from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.visitors import RESEARCHER_COOKIE, is_researcher, visitor
from tests.conftest import PATIENCE_S

from .conftest import Server


def desk_of(server: Server) -> Desk:
    stored = server.store.studies()[0]
    return Desk(stored, server.store, LapKeeper(stored.study, server.store.recordings_folder, 1))


@pytest.mark.parametrize("door", ["join", "researcher"])
def test_a_guessed_token_opens_nothing(server: Server, door: str) -> None:
    reply = server.ask(f"/{door}/guessed")
    assert reply.status == 403
    assert "set-cookie" not in reply.headers


def test_a_link_is_traded_for_a_hidden_cookie_and_leaves_the_address(server: Server) -> None:
    reply = server.ask(urlsplit(server.participant_url).path)
    assert (reply.status, reply.headers["location"]) == (303, "/")
    cookie = reply.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=lax" in cookie


def test_following_a_link_makes_no_participant_before_consent(server: Server) -> None:
    before = len(server.store.participants(server.store.studies()[0]))
    server.ask(urlsplit(server.participant_url).path)
    assert len(server.store.participants(server.store.studies()[0])) == before


def test_the_researcher_s_link_opens_once_and_looking_at_it_does_not_use_it_up(server: Server) -> None:
    path = urlsplit(server.researcher_url).path
    assert server.ask(path, "HEAD").status == 405
    first, second = server.ask(path), server.ask(path)
    assert (first.status, first.headers["location"]) == (303, "/overview")
    assert second.status == 403
    assert "opens once" in second.body.decode()
    assert "set-cookie" not in second.headers


def test_a_researcher_s_token_is_no_participant_s_link(server: Server) -> None:
    assert server.ask("/join/" + server.researcher_url.rpartition("/")[2]).status == 403
    assert server.ask("/researcher/" + server.participant_url.rpartition("/")[2]).status == 403


def test_a_participant_s_cookie_does_not_open_the_console(server: Server) -> None:
    cookie, _ = server.join()
    assert not is_researcher(desk_of(server), {RESEARCHER_COOKIE: cookie})


def test_a_made_up_cookie_is_nobody_s(server: Server) -> None:
    assert visitor(desk_of(server), {"elbowroom_participant": "made.up"}) is None
    assert server.ask("/laps/A/1", cookie="made.up").status == 403
    assert server.ask("/watched", "POST", cookie="made.up", content={}).status == 403


def test_a_personal_link_leads_back_to_its_participant_from_another_browser(server: Server) -> None:
    from app.server.visitors import admit, new_participant_cookie, new_token
    from data.store import token_sha256

    desk, token = desk_of(server), new_token()
    server.store.create_link("personal", desk.stored_study, token_sha256(token))
    first = new_participant_cookie(desk, token)
    assert first is not None
    who = admit(desk, first)
    second = new_participant_cookie(desk, token)
    assert second is not None
    assert second != first
    again = visitor(desk, {"elbowroom_participant": second})
    assert again is not None
    assert again.participant == who


@pytest.mark.parametrize("origin", [None, "http://evil.example", "null", "", "http://["])
@pytest.mark.parametrize("path", ["/watched", "/answers", "/_stcore/upload_file/x/y"])
def test_a_write_from_another_origin_is_refused(server: Server, path: str, origin: str | None) -> None:
    cookie, _ = server.join()
    reply = server.ask(path, "POST", cookie=cookie, origin=origin, content={"comparison": 1, "events": []})
    assert (reply.status, reply.body) == (403, b"forbidden")


@pytest.mark.parametrize(("origin", "status"), [("http://evil.example", 403), ("own", 101)])
def test_streamlit_s_socket_opens_for_our_own_pages_alone(server: Server, origin: str, status: int) -> None:
    connection = http.client.HTTPConnection(urlsplit(server.base).netloc, timeout=PATIENCE_S)
    headers = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        "Origin": server.base if origin == "own" else origin,
    }
    try:
        connection.request("GET", "/_stcore/stream", headers=headers)
        assert connection.getresponse().status == status
    finally:
        connection.close()


@pytest.mark.parametrize("path", ["/", "/healthz", "/stage/watch.js", "/join/guessed", "/_stcore/health"])
def test_every_answer_carries_the_security_headers(server: Server, path: str) -> None:
    headers = server.ask(path).headers
    assert "frame-ancestors 'none'" in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "same-origin"


def test_the_log_masks_tokens(server: Server) -> None:
    token = server.participant_url.rpartition("/")[2]
    server.ask(f"/join/{token}")
    server.ask("/healthz")
    log = server.log.read_text()
    assert "/join/***" in log
    assert token not in log
    assert masked("/researcher/abc?x=1") == "/researcher/***?x=1"


@pytest.mark.parametrize(("error", "is_told"), [(asyncio.CancelledError(), False), (KeyError("x"), True)])
def test_what_is_broken_off_when_the_server_stops_is_no_fault(error: BaseException, is_told: bool) -> None:
    failed = (type(error), error, None)
    record = logging.LogRecord("uvicorn.error", logging.ERROR, __file__, 1, "failed", (), failed)
    assert Discretion().filter(record) is is_told
