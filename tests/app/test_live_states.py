"""What a session does when: its states, with a crew that only notes what it is asked."""

import asyncio
import json
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from app.server.live import session as live_session
from app.server.live.archive import Archive, nothing_yet
from app.server.live.channel import Ending
from app.server.live.connection import Connection
from app.server.live.crew import Crew, Follower, Handle
from app.server.live.session import Session
from app.server.live.wire import InputFrame, pack_input
from app.server.robot_pool import RobotPool
from data.records import Comparison, Participant
from data.store import Store
from sim_trials.loop import COMPLETED, STUCK, TIMED_OUT
from sim_trials.trace import LapInputs
from tests.conftest import PATIENCE_S

from .conftest import GUIDED_STUDY, run_in_a_loop
from .live_browser import STUDY

NOW = datetime(2026, 1, 1, tzinfo=UTC)
SAID = InputFrame(3, "mouse", 1, 0.3, 0.45, 0.0, 0.0, -1.0, 1, 1.0)


@dataclass
class NotedHandle(Handle):
    """A trial that nobody runs."""

    follower: Follower
    run: int
    calls: list[str] = field(default_factory=list)

    def send_input(self, frame: bytes) -> None:
        self.calls.append("input")

    def release(self) -> None:
        self.calls.append("release")

    def end(self) -> None:
        self.calls.append("end")
        self.over(TIMED_OUT, 50)

    def over(self, ending: int, ticks: int) -> None:
        inputs = LapInputs(np.zeros((ticks, 6), np.int16), np.ones(ticks, np.uint8), ending)
        self.follower.on_ending(Ending(self.run, ticks, 0, inputs))


class NotedCrew(Crew):
    """Starts nothing."""

    def __init__(self) -> None:
        self.trials: list[NotedHandle] = []
        self.modes: list[str] = []
        self.has_workers = True

    @property
    def is_ready(self) -> bool:
        return self.has_workers

    def begin(
        self, follower: Follower, *, trial: int, mode: str, lap: int, is_practice: bool
    ) -> Handle | None:
        self.trials.append(NotedHandle(follower, trial))
        self.modes.append(mode)
        return self.trials[-1]


class Scene:
    """A session, the crew that it asks and what its windows were told."""

    def __init__(self, store: Store, pool: RobotPool) -> None:
        stored = store.add_study(STUDY, GUIDED_STUDY)
        self.store = store
        self.participant = store.add_participant(stored, Participant("p1", 1, "human", NOW))
        self.comparison = Comparison("p1.c1", "p1", 1, 1, *STUDY.mode_names, check=False)
        store.add_comparisons([self.comparison])
        store.start_comparison("p1.c1", NOW)
        self.comparison = store.comparison("p1.c1")
        self.crew = NotedCrew()
        self.settled: list[Session] = []
        self.session = Session(
            self.participant,
            self.comparison,
            nothing_yet(),
            study=STUDY,
            crew=self.crew,
            archive=Archive(STUDY, store, pool),
            clock=lambda: NOW,
            on_settled=self.settled.append,
        )

    def window(self) -> Connection:
        connection = Connection()
        self.session.attach(connection, self.comparison, nothing_yet())
        return connection

    def hold(self) -> None:
        self.session.take_input(SAID, pack_input(SAID))


def told(connection: Connection) -> list[str]:
    return [json.loads(text)["type"] for text in connection._messages if isinstance(text, str)]


async def until(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < end, "it didn't happen"
        await asyncio.sleep(0.01)


Play = Callable[[Callable[[Scene], Awaitable[None]]], None]


@pytest.fixture
def play(tmp_path: Path) -> Play:
    """Run a scene in an event loop of its own."""

    def run(plot: Callable[[Scene], Awaitable[None]]) -> None:
        async def main() -> None:
            with Store.open(tmp_path / "live.sqlite") as store:
                await plot(Scene(store, RobotPool(1)))

        run_in_a_loop(main())

    return run


def test_a_trial_waits_for_its_window_and_is_given_up_after_that(
    play: Play, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_session, "GRACE_S", 0.05)

    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        scene.session.detach(window)
        assert scene.crew.trials[0].calls[-1] == "release"
        assert not scene.session.is_over
        back = scene.window()
        await asyncio.sleep(0.1)
        assert not scene.session.is_over
        scene.session.open("A")
        assert len(scene.crew.trials) == 1
        scene.session.detach(back)
        await until(lambda: scene.session.is_over)
        assert scene.crew.trials[0].calls[-1] == "end"

    play(plot)


def test_a_new_window_moves_nothing_before_it_has_opened_a_slot(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        scene.window()
        scene.session.open("A")
        scene.hold()
        scene.window()
        scene.hold()
        assert scene.crew.trials[0].calls == ["input", "release"]

    play(plot)


@pytest.mark.parametrize(
    ("ending", "outcome", "pause"), [(COMPLETED, "completed", 1.5), (STUCK, "stuck", 4.0)]
)
def test_after_a_lap_s_end_the_next_begins_by_itself(
    play: Play, monkeypatch: pytest.MonkeyPatch, ending: int, outcome: str, pause: float
) -> None:
    assert live_session.PAUSE_S[outcome] == pause  # type: ignore[index]
    monkeypatch.setitem(live_session.PAUSE_S, outcome, 0.02)

    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        # Never held, so that there is nothing to store.
        scene.crew.trials[0].over(ending, 50)
        assert told(window) == ["welcome", "trial", "ended"]
        await until(lambda: len(told(window)) > 3)
        assert told(window) == ["welcome", "trial", "ended", "trial"]
        assert scene.session.row().lap == 2

    play(plot)


def test_without_a_worker_a_trial_begins_as_soon_as_there_is_one(
    play: Play, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_session, "_HIRING_S", 0.02)

    async def plot(scene: Scene) -> None:
        scene.crew.has_workers = False
        window = scene.window()
        scene.session.open("A")
        await asyncio.sleep(0.05)
        assert told(window) == ["welcome"]
        scene.crew.has_workers = True
        await until(lambda: len(told(window)) > 1)
        assert told(window) == ["welcome", "trial"]

    play(plot)


def test_each_slot_is_run_under_its_own_mode(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        scene.window()
        scene.session.open("A")
        scene.session.open("B")
        assert scene.crew.modes == [scene.comparison.mode_a, scene.comparison.mode_b]

    play(plot)


def test_a_lost_trial_is_stored_as_failed_and_finish_waits_for_it(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        scene.hold()
        scene.session.on_state(
            scene.session._turn,  # type: ignore[arg-type]
            bytes(16) + np.float32(2.5).tobytes() + bytes(60),
            300,
            12,
        )
        scene.crew.trials[0].follower.on_lost()
        scene.session.finish()
        assert "finished" not in told(window)
        await until(lambda: "finished" in told(window))
        assert told(window)[-2:] == ["stored", "finished"]
        (trial,) = scene.store.trials(comparison="p1.c1")
        assert (trial.outcome, trial.duration_s, trial.recording) == ("failed", 2.5, None)
        assert (trial.metrics["ticks"], trial.metrics["skipped_ticks"]) == (300, 12)

    play(plot)


def test_after_a_withdrawal_nothing_more_is_stored(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        scene.hold()
        await until(lambda: scene.store.switches("p1.c1") != ())
        scene.store.withdraw("p1", "test")
        scene.session.open("B")
        await until(lambda: bool(scene.settled))
        assert told(window)[-1] == "moved"
        assert scene.store.trials() == ()

    play(plot)


def test_a_full_disk_is_waited_for_and_the_page_is_told_only_then(
    play: Play, caplog: pytest.LogCaptureFixture
) -> None:
    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        scene.hold()
        folder = scene.store.recordings_folder
        folder.rmdir()
        # Nobody can write into a folder that is a file.
        folder.touch()
        scene.session.finish()
        await until(lambda: "file exists" in caplog.text)
        await asyncio.sleep(0.1)
        assert told(window) == ["welcome", "trial"]
        assert scene.store.trials() == ()
        folder.unlink()
        folder.mkdir()
        await until(lambda: "finished" in told(window))
        (trial,) = scene.store.trials(comparison="p1.c1")
        assert trial.outcome == "abandoned"
        assert scene.store.recording_path(trial).is_file()

    play(plot)


def test_a_lap_that_cannot_be_finished_still_counts_for_how_long_it_took(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        scene.hold()
        seen = bytes(16) + np.float32(2.5).tobytes() + bytes(60)
        scene.session.on_state(scene.session._turn, seen, 300, 12)  # type: ignore[arg-type]
        broken = LapInputs(np.zeros((50, 4), np.int16), np.ones(50, np.uint8), COMPLETED)
        scene.crew.trials[0].follower.on_ending(Ending(1, 50, 0, broken))
        scene.session.finish()
        await until(lambda: "finished" in told(window))
        (trial,) = scene.store.trials(comparison="p1.c1")
        assert (trial.outcome, trial.duration_s, trial.recording) == ("failed", 2.5, None)

    play(plot)


def test_nothing_begins_once_the_study_s_hours_are_over(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("A")
        protocol = STUDY.protocol.model_copy(update={"returning_within_h": 2.0})
        scene.session._study = STUDY.model_copy(update={"protocol": protocol})
        scene.session._clock = lambda: NOW + timedelta(hours=2)
        scene.session.open("B")
        assert scene.crew.modes == [scene.comparison.mode_a]
        assert told(window)[-1] == "moved"
        await until(lambda: bool(scene.settled))

    play(plot)


def test_what_was_read_before_a_trial_was_stored_does_not_take_it_back(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        scene.window()
        scene.session.open("A")
        scene.hold()
        scene.session.open("B")
        await until(lambda: scene.store.trials() != () and scene.session._ledger.is_idle)
        window = scene.window()
        assert told(window) == ["welcome"]
        (welcome,) = (json.loads(text) for text in window._messages if isinstance(text, str))
        assert welcome["exposure"]["A"] == pytest.approx(50 * 0.008)

    play(plot)


def test_the_board_says_who_is_there_and_no_mode(play: Play) -> None:
    async def plot(scene: Scene) -> None:
        window = scene.window()
        scene.session.open("B")
        scene.hold()
        row = scene.session.row()
        assert (row.number, row.comparison, row.slot, row.lap) == (1, 1, "B", 1)
        assert (row.is_connected, row.device, row.since) == (True, "mouse", NOW)
        assert not any(mode in repr(row) for mode in STUDY.mode_names)
        scene.session.detach(window)
        assert not scene.session.row().is_connected

    play(plot)
