"""A tiny study on a real server, and requests to it."""

import asyncio
import http.client
import json
import os
import random
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Coroutine, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar
from urllib.parse import urlsplit

import pytest

from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.visitors import PARTICIPANT_COOKIE, admit, new_participant_cookie
from data.records import Participant
from data.store import Store
from tests.conftest import PATIENCE_S

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

TINY_STUDY = """
format = 1
name = "tiny"
title = "Zweifelhaft"
seed = 5
[consent]
version = "7"
text = "You will watch a robot."
[[modes]]
name = "Zwetschge"
method = "dls"
description = "Quitte"
parameters = { lambda0 = 0.2, sigma_t = 0.25 }
[[modes]]
name = "Mirabelle"
method = "dls"
description = "Quitte"
parameters = { lambda0 = 0.6, sigma_t = 0.25 }
[[questions]]
name = "Q1"
wording = "Which method was the smoothest to use?"
short = "smoothest"
emphasis = "smoothest"
levels = 5
answers = ["A much smoother", "A smoother", "About the same", "B smoother", "B much smoother"]
[[questions]]
name = "Q2"
wording = "Which method felt safest to use?"
short = "safest"
levels = 3
[protocol]
trial_source = "observed"
repetitions = 1
laps_per_condition = 1
minimum_exposure_s = 0.5
"""
GUIDED_STUDY = TINY_STUDY.replace('trial_source = "observed"', 'trial_source = "guided"') + (
    "[maze]\nright_y_m = 0.1\nbottom_z_m = 0.3\n[practice]\nlaps = 1\nright_y_m = 0.2\n"
)
"""The tiny study for people who guide the robot themselves, on a maze that takes seconds."""
BACKGROUND = """
[[background]]
name = "before"
wording = "Have you guided a robot by hand before?"
choices = ["Never", "Often"]
[[background]]
name = "years"
wording = "How old are you?"
kind = "number"
lowest = 18
highest = 99
"""
"""Two questions about the person, to append to a study."""
SECRETS = ("Zwetschge", "Mirabelle", "Quitte", "Zweifelhaft", "lambda", "dls", "sigma", "damping")
"""What no participant's browser may ever receive of the tiny study, in any case of letters."""


@dataclass(frozen=True)
class Reply:
    """An answer of the server."""

    status: int
    headers: Mapping[str, str]
    body: bytes


@dataclass(frozen=True)
class Server:
    """A server under test, and the store behind it."""

    participant_url: str
    researcher_url: str
    store: Store
    log: Path
    process: subprocess.Popen[str]

    @property
    def base(self) -> str:
        parts = urlsplit(self.participant_url)
        return f"{parts.scheme}://{parts.netloc}"

    def ask(
        self,
        path: str,
        method: str = "GET",
        *,
        cookie: str = "",
        origin: str | None = "own",
        content: object = None,
        raw: str | None = None,
        headers: Mapping[str, str] | None = None,
    ) -> Reply:
        """Send a request, without following a redirect."""
        sent = dict(headers or {})
        if cookie:
            sent["Cookie"] = f"{PARTICIPANT_COOKIE}={cookie}"
        if origin is not None:
            sent["Origin"] = self.base if origin == "own" else origin
        body = raw if content is None else json.dumps(content)
        if body is not None:
            sent["Content-Type"] = "application/json"
        connection = http.client.HTTPConnection(urlsplit(self.base).netloc, timeout=PATIENCE_S)
        try:
            connection.request(method, path, body, sent)
            answer = connection.getresponse()
            return Reply(answer.status, dict(answer.getheaders()), answer.read())
        finally:
            connection.close()

    def join(self, *, starts: bool = True) -> tuple[str, Participant]:
        """A new participant, whose first comparison is open if it starts: the cookie and who it is."""
        stored = self.store.studies()[0]
        desk = Desk(stored, self.store, LapKeeper(stored.study, self.store.recordings_folder, 1))
        cookie = new_participant_cookie(desk, self.participant_url.rpartition("/")[2])
        assert cookie is not None
        participant = admit(desk, cookie)
        if starts:
            self.store.start_comparison(f"{participant.id}.c1", self.store.clock())
        return cookie, participant


Start = Callable[[str], Server]


def free_port() -> int:
    """A port that stays free until it is asked for: the system gives none of these away by itself."""
    while True:
        port = random.randrange(20_000, 30_000)
        with suppress(OSError), socket.create_server(("127.0.0.1", port)):
            return port


@contextmanager
def serving(folder: Path, study: str, *options: str) -> Iterator[Server]:
    """Run ``elbowroom serve`` on a free port, until the block ends."""
    (folder / "study.toml").write_text(study, encoding="utf-8")
    command = [sys.executable, "-m", "app.cli", "serve", "--study", "study.toml", "--store", "study.sqlite"]
    log = folder / "log.txt"
    with log.open("w") as errors:
        process = subprocess.Popen(
            [*command, "--port", "0", "--workers", "1", *options],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
            # The variables of Streamlit and of a proxy must not matter.
            env={**os.environ, "STREAMLIT_CLIENT_SHOW_ERROR_DETAILS": "full"},
        )
    try:
        assert process.stdout is not None
        said = dict(
            line.split(": ", 1) for line in (process.stdout.readline(), process.stdout.readline()) if line
        )
        assert list(said) == ["participant", "researcher"], log.read_text()
        with Store.open(folder / "study.sqlite") as store:
            yield Server(said["participant"].strip(), said["researcher"].strip(), store, log, process)
    finally:
        process.send_signal(signal.SIGTERM)
        try:
            process.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            raise


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One server for all tests that don't end it."""
    with serving(tmp_path_factory.mktemp("served"), TINY_STUDY) as running:
        yield running


@pytest.fixture(scope="session")
def guided_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One server of the guided study for all tests that don't end it."""
    with serving(tmp_path_factory.mktemp("guided"), GUIDED_STUDY) as running:
        yield running


@pytest.fixture(scope="module")
def stage_page(chromium: "Browser", server: Server) -> Iterator["Page"]:
    """A page of the server, to import the stage's modules from."""
    context = chromium.new_context()
    opened = context.new_page()
    opened.goto(f"{server.base}/healthz")
    yield opened
    context.close()


def run_module(page: "Page", module: str, script: str, argument: object = None) -> object:
    """What a script returns that finds a module of the stage as ``m``, and the argument as ``given``."""
    return page.evaluate(
        f"async (given) => {{ const m = await import('/stage/{module}.js'); {script} }}", argument
    )


Answer = TypeVar("Answer")


def run_in_a_loop(coming: Coroutine[None, None, Answer]) -> Answer:
    """In a thread: where browser tests ran before, this one has an event loop already."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, coming).result()
