"""The console's door with a passphrase."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.parse import urlencode

import pytest
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import Message

from app.server import passphrase
from app.server.desk import Desk, open_desk
from app.server.laps import LapKeeper
from app.server.passphrase import (
    FORGOTTEN_AFTER_S,
    MOST_TRIES,
    Passphrase,
    knock,
    read_passphrase,
    set_passphrase,
    show_door,
)
from app.server.visitors import RESEARCHER_COOKIE, is_researcher
from data.errors import InputError
from data.store import Store
from data.study_file import parse_study

from .conftest import TINY_STUDY, run_in_a_loop

RIGHT = "seven green apples"


class Watch:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now = datetime(2026, 5, 4, 9, 0, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.now

    def wait(self, seconds: float) -> None:
        self.now += timedelta(seconds=seconds)


@pytest.fixture
def watch() -> Watch:
    return Watch()


@pytest.fixture
def desk(tmp_path: Path, watch: Watch, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.setattr(passphrase, "WRONG_AFTER_S", 0.0)
    with Store.open(tmp_path / "study.sqlite", clock=watch) as store:
        stored = store.add_study(parse_study(TINY_STUDY, "tiny.toml"), TINY_STUDY)
        desk = Desk(stored, store, LapKeeper(stored.study, store.recordings_folder, 1))
        open_desk(desk)
        set_passphrase(RIGHT, watch)
        yield desk
    set_passphrase(None, watch)


def knock_with(
    text: str, address: str = "192.0.2.1", kind: str = "application/x-www-form-urlencoded"
) -> Response:
    async def receive() -> Message:
        return {"type": "http.request", "body": urlencode({"passphrase": text}).encode(), "more_body": False}

    scope = {
        "type": "http",
        "method": "POST",
        "path": "/researcher",
        "headers": [(b"content-type", kind.encode())],
        "client": (address, 50000),
    }
    return run_in_a_loop(knock(Request(scope, receive)))


def actions(desk: Desk) -> list[str]:
    return [entry.action for entry in desk.store.audit_log()]


def test_the_right_passphrase_is_traded_for_the_researcher_s_cookie_and_logged(desk: Desk) -> None:
    answer = knock_with(RIGHT)
    assert (answer.status_code, answer.headers["location"]) == (303, "/overview")
    given = answer.headers["set-cookie"]
    assert "HttpOnly" in given
    assert "SameSite=lax" in given
    cookie = given.partition("=")[2].partition(";")[0]
    assert is_researcher(desk, {RESEARCHER_COOKIE: cookie})
    assert actions(desk) == ["open console"]
    assert desk.store.audit_log()[0].detail["by"] == "passphrase"


@pytest.mark.parametrize("text", ["", "seven green apple", "Seven green apples", "ä" * 2000])
def test_a_wrong_passphrase_opens_nothing_and_is_logged(desk: Desk, text: str) -> None:
    answer = knock_with(text)
    assert answer.status_code == 403
    assert "set-cookie" not in answer.headers
    assert b"not the passphrase" in bytes(answer.body)
    assert actions(desk) == ["wrong passphrase"]


def test_what_is_sent_otherwise_than_by_the_form_opens_nothing(desk: Desk) -> None:
    assert knock_with(RIGHT, kind="application/json").status_code == 403


def test_after_some_wrong_ones_even_the_right_passphrase_waits_a_minute(desk: Desk, watch: Watch) -> None:
    assert [knock_with("wrong").status_code for _ in range(MOST_TRIES)] == [403] * MOST_TRIES
    assert knock_with(RIGHT).status_code == 429
    assert knock_with(RIGHT, address="192.0.2.2").status_code == 303
    assert len(actions(desk)) == MOST_TRIES + 1
    watch.wait(FORGOTTEN_AFTER_S + 1)
    assert knock_with(RIGHT).status_code == 303


def test_many_addresses_together_are_held_up_as_well(watch: Watch) -> None:
    door = Passphrase(RIGHT, watch)
    tries = 0
    while not door.is_locked_for("192.0.2.9") and tries < 1000:
        door.opens("wrong", f"198.51.100.{tries}")
        tries += 1
    assert MOST_TRIES < tries < 1000


def test_without_a_passphrase_the_door_stays_closed(desk: Desk, watch: Watch) -> None:
    set_passphrase(None, watch)
    assert knock_with("").status_code == 403
    assert b"<form" not in bytes(run_in_a_loop(show_door(Request({"type": "http", "headers": []}))).body)
    assert actions(desk) == []


def test_the_passphrase_comes_from_the_file_before_the_variable(tmp_path: Path) -> None:
    file = tmp_path / "secret"
    file.write_text("from the file, long\n", encoding="utf-8")
    environment = {"ELBOWROOM_PASSPHRASE": "from the variable"}
    assert read_passphrase(file, environment) == "from the file, long"
    assert read_passphrase(None, environment) == "from the variable"
    assert read_passphrase(None, {}) is None


def test_a_short_or_unreadable_passphrase_is_refused_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="ELBOWROOM_PASSPHRASE: a passphrase has at least 12 characters"):
        read_passphrase(None, {"ELBOWROOM_PASSPHRASE": "short"})
    with pytest.raises(InputError, match=r"--passphrase-file: .*: cannot be read: no such file"):
        read_passphrase(tmp_path / "missing", {})
