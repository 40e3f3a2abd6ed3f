"""What happens to trials when processes die or hang, or the server stops."""

import os
import signal
import threading
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from app.server.live.worker import PROCESS_NAME
from data.records import Trial

from .conftest import GUIDED_STUDY, Server, serving
from .live_browser import LiveBrowser
from .processes import children, is_running


def live_worker(server: Server) -> int:
    """The one live worker's process id."""
    (found,) = [child.pid for child in children(server.process.pid) if child.name == PROCESS_NAME]
    return found


def trials_of(server: Server, participant_id: str) -> list[Trial]:
    """Of somebody's first comparison, in the order in which they were begun."""
    found = server.store.trials(comparison=f"{participant_id}.c1")
    return sorted(found, key=lambda trial: trial.started_at)


@pytest.mark.parametrize(
    ("number", "outcome"),
    [(signal.SIGKILL, "failed"), (signal.SIGSTOP, "failed"), (signal.SIGTERM, "abandoned")],
    ids=["killed", "hung", "told to go"],
)
def test_a_lost_worker_costs_its_trial_at_most_and_another_takes_over(
    guided_server: Server, number: signal.Signals, outcome: str
) -> None:
    cookie, participant = guided_server.join()
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        browser.wait_for_the_robot()
        browser.guide(1.0)
        worker = live_worker(guided_server)
        os.kill(worker, number)
        ended = browser.until("ended")
        assert (ended["outcome"], ended["slot"]) == ("stopped", "A")
        browser.until("stored")
        (trial,) = trials_of(guided_server, participant.id)
        assert (trial.outcome, trial.recording is None) == (outcome, outcome == "failed")
        assert 0.5 < trial.duration_s < 2.5
        browser.until("trial", 60)
        browser.wait_for_the_robot()
        browser.guide(0.5)
        assert browser.state is not None
        assert browser.state.view.is_enabled
        browser.tell("finish")
        browser.until("finished")
    found = trials_of(guided_server, participant.id)
    assert [(trial.number, trial.outcome) for trial in found] == [(1, outcome), (2, "abandoned")]
    assert live_worker(guided_server) != worker


def test_a_killed_server_leaves_no_process_behind(tmp_path: Path) -> None:
    with serving(tmp_path, GUIDED_STUDY) as server:
        cookie, _ = server.join()
        with LiveBrowser(server, cookie) as browser:
            browser.open("A")
            browser.wait_for_the_robot()
            processes = children(server.process.pid)
            assert len(processes) >= 2
            server.process.kill()
            server.process.wait(30)
    end = time.monotonic() + 30
    while any(map(is_running, processes)) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(map(is_running, processes))


@pytest.mark.parametrize("everyone", [False, True], ids=["the server alone", "its processes too"])
def test_a_server_that_is_told_to_stop_stores_what_is_under_way(tmp_path: Path, everyone: bool) -> None:
    with serving(tmp_path, GUIDED_STUDY) as server, ExitStack() as stack:
        people = [server.join() for _ in range(5)]
        browsers = [stack.enter_context(LiveBrowser(server, cookie)) for cookie, _ in people]
        for browser in browsers:
            browser.open("A")
            browser.wait_for_the_robot()
        threads = [threading.Thread(target=browser.guide, args=(1.0,)) for browser in browsers]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        told = [server.process.pid]
        if everyone:
            told += [child.pid for child in children(server.process.pid)]
        for pid in told:
            os.kill(pid, signal.SIGTERM)
        assert server.process.wait(60) == 0
        for _, participant in people:
            (trial,) = trials_of(server, participant.id)
            assert (trial.outcome, trial.slot) == ("abandoned", "A")
            assert trial.duration_s > 0.5
            assert server.store.recording_path(trial).is_file()
        assert "Traceback" not in server.log.read_text()
