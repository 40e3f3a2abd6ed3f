"""Whatever a participant does in whatever order, what is stored is what happened, once."""

import time
from contextlib import ExitStack
from dataclasses import dataclass, field
from itertools import pairwise

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from data.records import Participant
from sim_trials.recording import file_sha256

from .conftest import Server
from .live_browser import LiveBrowser, still, to_the_right

SOCKETS_APART_S = 0.4
"""A participant who opens sockets faster is refused."""
SURELY_HELD_S = 0.15
"""A trial in which the robot was held for 0.1 s is stored."""
LATE_S = 0.25
"""So much later than the end of a lap is told, a worker may hear of it [s]."""

STEPS = st.one_of(
    st.sampled_from(["open A", "open B", "restart", "finish", "drop", "reload", "second window"]),
    st.tuples(st.sampled_from(["guide", "look on"]), st.floats(0.02, 0.5)),
)


@dataclass
class Person:
    """Somebody at the robot, and what they saw."""

    server: Server
    cookie: str
    windows: ExitStack
    window: LiveBrowser | None = None
    connected_at: float = 0.0
    slots: dict[int, str] = field(default_factory=dict)
    """Of each trial."""
    held: set[int] = field(default_factory=set)
    """Trials in which the robot was in hand for long enough."""

    def connect(self) -> LiveBrowser:
        time.sleep(max(self.connected_at + SOCKETS_APART_S - time.monotonic(), 0.0))
        self.window = self.windows.enter_context(LiveBrowser(self.server, self.cookie))
        self.window.until("welcome")
        # By now the server has counted it, however long that took.
        self.connected_at = time.monotonic()
        return self.window

    def do(self, step: str | tuple[str, float]) -> None:
        window = self.window or self.connect()
        if step == "drop":
            window.socket.close()
            self.window = None
        elif step in ("reload", "second window"):
            if step == "reload":
                window.socket.close()
            self.connect()
        elif isinstance(step, tuple):
            kind, seconds = step
            trial, before = window.trial, window.state
            window.press(seconds, *((to_the_right, 3) if kind == "guide" else (still, 0)))
            after = window.state
            if (
                trial == window.trial
                and before
                and after
                and before.view.is_enabled
                and after.view.is_enabled
            ):
                passed_s = after.view.time_s - before.view.time_s
                self.held |= {trial} if passed_s >= SURELY_HELD_S and kind == "guide" else set()
        else:
            kind, _, slot = step.partition(" ")
            window.tell(kind, **({"slot": slot} if slot else {}))
        self.look(window)

    def look(self, window: LiveBrowser) -> None:
        """Take note of what the window was told."""
        for said in window.told:
            if said["type"] == "trial":
                assert self.slots.setdefault(said["trial"], said["slot"]) == said["slot"]

    def finish(self) -> dict[str, object]:
        window = self.window or self.connect()
        window.tell("finish")
        finished = window.until("finished")
        self.look(window)
        return finished


@pytest.fixture(scope="module")
def warm_server(guided_server: Server) -> Server:
    """Its worker has compiled what it needs."""
    cookie, _ = guided_server.join()
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
    return guided_server


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(steps=st.lists(STEPS, min_size=2, max_size=12))
def test_what_is_stored_is_what_happened_once(
    warm_server: Server, steps: list[str | tuple[str, float]]
) -> None:
    begun = time.monotonic()
    cookie, participant = warm_server.join()
    with ExitStack() as windows:
        person = Person(warm_server, cookie, windows)
        for step in ["open A", *steps]:
            person.do(step)
        finished = person.finish()
    check_store(warm_server, participant, person, finished, time.monotonic() - begun)


def check_store(
    server: Server, participant: Participant, person: Person, finished: dict[str, object], passed_s: float
) -> None:
    """Compare what is stored with what was seen."""
    store, comparison = server.store, f"{participant.id}.c1"
    trials = sorted(store.trials(comparison=comparison), key=lambda trial: trial.started_at)
    for slot in "AB":
        mine = [trial for trial in trials if trial.slot == slot]
        assert [trial.number for trial in mine] == list(range(1, len(mine) + 1))
        assert finished["exposure"][slot] == pytest.approx(  # type: ignore[index]
            sum(trial.duration_s for trial in mine), abs=1e-3
        )
    assert sum(trial.duration_s for trial in trials) <= passed_s
    for before, after in pairwise(trials):
        assert (after.started_at - before.started_at).total_seconds() >= before.duration_s - LATE_S
    for trial in trials:
        assert trial.outcome == "abandoned"
        assert file_sha256(store.recording_path(trial)) == trial.recording_sha256
    switches = store.switches(comparison)
    assert [switch.number for switch in switches] == list(range(1, len(switches) + 1))
    assert all(before.slot != after.slot for before, after in pairwise(switches))
    seen = [slot for _, slot in sorted(person.slots.items())]
    held = [slot for trial, slot in sorted(person.slots.items()) if trial in person.held]
    stored = [trial.slot for trial in trials]
    assert is_within(held, stored)
    assert is_within(stored, seen)


def is_within(some: list[str], of: list[str]) -> bool:
    """Whether one sequence is the other with parts left out."""
    rest = iter(of)
    return all(each in rest for each in some)
