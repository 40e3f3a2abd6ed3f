"""Starting and stopping: one plain line when it can't, no noise when it ends."""

import signal
import socket
import subprocess
import sys
from pathlib import Path

from tests.conftest import PATIENCE_S

from .conftest import TINY_STUDY, serving


def attempt(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "app.cli", "serve", "--store", str(folder / "study.sqlite")]
    command += ["--port", "0", *options]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S)


def test_a_port_in_use_is_one_line_and_exit_1(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = attempt(tmp_path, "--port", str(port))
    assert result.returncode == 1
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert f"127.0.0.1:{port}: address already in use" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_host_that_is_none_is_one_line_and_exit_1(tmp_path: Path) -> None:
    result = attempt(tmp_path, "--host", "no.such.host.invalid")
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1
    assert "no.such.host.invalid" in result.stderr


def test_a_study_with_an_unknown_method_is_found_before_anyone_waits_for_its_lap(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(TINY_STUDY.replace('"dls"', '"dsl"', 1))
    result = attempt(tmp_path, "--study", "study.toml")
    assert result.returncode == 2
    assert "'dsl' is not one of" in result.stderr
    assert not (tmp_path / "study.sqlite").exists()


def test_it_stops_cleanly_when_told_to(tmp_path: Path) -> None:
    with serving(tmp_path, TINY_STUDY) as running:
        assert running.ask("/healthz").body == b'{"status":"ok"}'
        running.process.send_signal(signal.SIGINT)
        assert running.process.wait(PATIENCE_S) == 0
    assert "Traceback" not in running.log.read_text()


def test_a_worker_that_starts_after_a_page_was_shown_leaves_the_page_alone() -> None:
    """Streamlit makes its script the main module, which a spawned process imports as ``__mp_main__``."""
    script = Path(__file__).resolve().parents[2] / "app" / "server" / "page.py"
    code = f"import runpy, sys; runpy.run_path({str(script)!r}, run_name='__mp_main__')"
    result = subprocess.run(
        [sys.executable, "-c", f"{code}; assert 'streamlit' not in sys.modules"],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )
    assert (result.returncode, result.stderr) == (0, "")


def test_a_maze_out_of_reach_is_found_before_anyone_waits_for_its_lap(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(TINY_STUDY + "\n[maze]\nwall_x_m = 1.9\n")
    result = attempt(tmp_path, "--study", "study.toml")
    assert result.returncode == 2
    assert "the robot does not reach the top left corner" in result.stderr
    assert not (tmp_path / "study.sqlite").exists()
