"""What happens to trials when processes die or the server stops."""

import os
import signal
import time
from pathlib import Path

from app.server.live.worker import PROCESS_NAME

from .conftest import GUIDED_STUDY, Server, serving
from .live_browser import LiveBrowser


def live_workers(server: Server) -> list[int]:
    """The live workers' process ids (Linux)."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            name, _, rest = (folder / "stat").read_text().partition("(")[2].rpartition(")")
            if int(rest.split()[1]) == server.process.pid and name == PROCESS_NAME:
                found.append(int(folder.name))
        except OSError:
            continue
    return found


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_killed_worker_costs_its_trial_and_nothing_else_and_a_killed_server_leaves_none(
    tmp_path: Path,
) -> None:
    with serving(tmp_path, GUIDED_STUDY) as server:
        cookie, participant = server.join()
        with LiveBrowser(server, cookie) as browser:
            browser.open("A")
            browser.wait_for_the_robot()
            browser.guide(1.0)
            (worker,) = live_workers(server)
            os.kill(worker, signal.SIGKILL)
            ended = browser.until("ended")
            assert (ended["outcome"], ended["slot"]) == ("stopped", "A")
            browser.until("stored")
            (trial,) = server.store.trials(comparison=f"{participant.id}.c1")
            assert (trial.outcome, trial.recording) == ("failed", None)
            assert 0.5 < trial.duration_s < 2.5
            browser.until("trial")
            browser.wait_for_the_robot()
            browser.guide(0.5)
            assert browser.state is not None
            assert browser.state.view.is_enabled
            browser.tell("finish")
            browser.until("finished")
        trials = server.store.trials(comparison=f"{participant.id}.c1")
        assert [(trial.number, trial.outcome) for trial in trials] == [(1, "failed"), (2, "abandoned")]

        workers = live_workers(server)
        server.process.kill()
        server.process.wait(30)
        end = time.monotonic() + 30
        while any(is_running(pid) for pid in workers) and time.monotonic() < end:
            time.sleep(0.05)
        assert not any(is_running(pid) for pid in workers)


def test_a_server_that_is_told_to_stop_stores_what_is_under_way(tmp_path: Path) -> None:
    with serving(tmp_path, GUIDED_STUDY) as server:
        cookie, participant = server.join()
        with LiveBrowser(server, cookie) as browser:
            browser.open("A")
            browser.wait_for_the_robot()
            browser.guide(1.0)
            server.process.send_signal(signal.SIGTERM)
            assert server.process.wait(60) == 0
        (trial,) = server.store.trials(comparison=f"{participant.id}.c1")
        assert (trial.outcome, trial.slot) == ("abandoned", "A")
        assert trial.duration_s > 0.8
        assert server.store.recording_path(trial).is_file()
        assert "Traceback" not in server.log.read_text()
