"""What happens to trials when processes die or hang, or the server stops."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import pytest

from app.server.live.worker import PROCESS_NAME, TICK_S
from data.records import Trial
from tests.conftest import PATIENCE_S

from .conftest import GUIDED_STUDY, Server, serving
from .live_browser import LiveBrowser
from .processes import children, until_gone


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
        assert browser.state is not None
        seen_s = browser.state.view.time_s
        worker, begun = live_worker(guided_server), len(browser.told)
        os.kill(worker, number)
        ended = browser.until("ended", since=begun)
        assert (ended["outcome"], ended["slot"]) == ("stopped", "A")
        browser.until("stored", since=begun)
        (trial,) = trials_of(guided_server, participant.id)
        assert (trial.outcome, trial.recording is None) == (outcome, outcome == "failed")
        assert trial.duration_s >= seen_s - TICK_S
        browser.until("trial", since=begun)
        browser.guide(0.5)
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
            server.process.wait(PATIENCE_S)
    until_gone(processes)


@pytest.mark.parametrize("everyone", [False, True], ids=["the server alone", "its processes too"])
def test_a_server_that_is_told_to_stop_stores_what_is_under_way(tmp_path: Path, everyone: bool) -> None:
    with serving(tmp_path, GUIDED_STUDY) as server, ExitStack() as stack:
        # A server that is stopped waits for laps to be finished, but not for what finishes them to be loaded.
        with LiveBrowser(server, server.join()[0]) as first:
            first.open("A")
            first.guide(0.5)
            first.tell("finish")
            assert first.until("finished")["exposure"]["A"] > 0.0
        people = [server.join() for _ in range(5)]
        browsers = [stack.enter_context(LiveBrowser(server, cookie)) for cookie, _ in people]
        for browser in browsers:
            browser.open("A")
            browser.wait_for_the_robot()
        with ThreadPoolExecutor() as threads:
            for done in [threads.submit(browser.guide, 1.0) for browser in browsers]:
                done.result()
        told = [server.process.pid]
        if everyone:
            told += [child.pid for child in children(server.process.pid)]
        for pid in told:
            os.kill(pid, signal.SIGTERM)
        assert server.process.wait(PATIENCE_S) == 0
        for _, participant in people:
            (trial,) = trials_of(server, participant.id)
            assert (trial.outcome, trial.slot) == ("abandoned", "A")
            assert trial.duration_s > 0.5
            assert server.store.recording_path(trial).is_file()
        assert "Traceback" not in server.log.read_text()
