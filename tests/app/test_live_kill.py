"""What a person in a browser meets when a process is killed: the same page goes on; nothing counts twice."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from app.server.live.worker import PROCESS_NAME, TICK_S

from .conftest import GUIDED_STUDY, Server, free_port, serving
from .guide_page import HELD_S, by_mouse, guiding
from .processes import Process, children, until_gone

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
OFFLINE = "No connection. The robot waits. Trying again."


def live_worker(server: Server) -> Process:
    """The one process in which people's robots run."""
    (found,) = [process for process in children(server.process.pid) if process.name == PROCESS_NAME]
    return found


def lap_worker(server: Server) -> Process:
    """The one process that finishes laps."""
    (found,) = [
        process
        for process in children(server.process.pid)
        if process.name != PROCESS_NAME and "spawn_main" in process.command
    ]
    return found


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server whose workers may be killed."""
    with serving(tmp_path_factory.mktemp("killed"), GUIDED_STUDY) as server:
        yield server


def test_after_a_kill_of_the_server_the_same_page_goes_on_with_what_was_acknowledged(
    chromium: "Browser", tmp_path: Path
) -> None:
    port = ("--port", str(free_port()))
    with serving(tmp_path, GUIDED_STUDY, *port) as killed, guiding(chromium, killed, "mouse") as guide:
        page = guide.page
        page.evaluate("window.isTheSamePage = true")
        by_mouse(guide)
        guide.turn_to("B")
        guide.until_trials(1)
        acknowledged = guide.trials
        guide.hold_with_the_mouse().keep(HELD_S)
        processes = children(killed.process.pid)
        assert {PROCESS_NAME} < {process.name for process in processes}
        killed.process.kill()
        killed.process.wait(30)
        guide.says(OFFLINE)
        guide.says("Robot waits")
        page.mouse.up()
        until_gone(processes)
        assert guide.trials == acknowledged
        with serving(tmp_path, GUIDED_STUDY, *port):
            expect(page.get_by_text(OFFLINE, exact=True).first).to_be_hidden()
            guide.is_ready("B")
            by_mouse(guide)
            guide.answer_to_the_end()
            assert page.evaluate("window.isTheSamePage")
            assert guide.comparison.answered_at is not None
            kept, after = guide.trials
            assert (kept,) == acknowledged
            assert (after.slot, after.number, after.outcome) == ("B", 1, "abandoned")
            assert killed.store.recording_path(after).is_file()
            switches = killed.store.switches(guide.comparison_id)
            assert [(switch.number, switch.slot) for switch in switches] == [(1, "A"), (2, "B")]


def test_after_a_kill_of_the_robot_s_process_the_page_says_so_and_goes_on(
    chromium: "Browser", running: Server
) -> None:
    with guiding(chromium, running, "mouse") as guide:
        guide.hold_with_the_mouse().keep(HELD_S)
        os.kill(live_worker(running).pid, signal.SIGKILL)
        guide.says("The robot has stopped and is being reset")
        guide.page.mouse.up()
        guide.until_trials(1)
        guide.is_ready("A")
        by_mouse(guide)
        guide.turn_to("B")
        by_mouse(guide)
        guide.answer_to_the_end()
        found = [(trial.slot, trial.number, trial.outcome) for trial in guide.trials]
        assert found == [("A", 1, "failed"), ("A", 2, "abandoned"), ("B", 1, "abandoned")]
        assert all(trial.duration_s >= HELD_S - TICK_S for trial in guide.trials)


def test_after_a_kill_of_the_process_that_finishes_a_lap_another_finishes_it(
    chromium: "Browser", running: Server
) -> None:
    with guiding(chromium, running, "mouse") as guide:
        by_mouse(guide)
        doomed = lap_worker(running)
        os.kill(doomed.pid, signal.SIGSTOP)
        guide.turn_to("B")
        by_mouse(guide)
        assert guide.trials == ()
        os.kill(doomed.pid, signal.SIGKILL)
        guide.until_trials(1)
        guide.answer_to_the_end()
        assert [(trial.slot, trial.outcome) for trial in guide.trials] == [
            ("A", "abandoned"),
            ("B", "abandoned"),
        ]
        assert all(running.store.recording_path(trial).is_file() for trial in guide.trials)
