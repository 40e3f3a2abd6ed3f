"""The server under load: a process of its own, on a store that is thrown away."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import urlsplit

from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.live.worker import PROCESS_NAME
from app.server.visitors import admit, new_participant_cookie
from data.errors import ElbowroomError
from data.store import Store
from data.study import Study

_GOODBYE_S = 120
_STUDY, _STORE, _LOG = "study.toml", "load.sqlite", "log.txt"


@dataclass(frozen=True)
class CpuTime:
    """Processor time used so far [s]: by all live workers, how many they are, and by the web process."""

    workers: float
    number: int
    web: float

    def since(self, before: "CpuTime", seconds: float) -> "CpuTime":
        """By the second: how many cores each of the two kept busy since an earlier moment."""
        return CpuTime(
            (self.workers - before.workers) / seconds, self.number, (self.web - before.web) / seconds
        )


@dataclass(frozen=True)
class ServerUnderLoad:
    """A running server."""

    base: str
    token: str
    store: Store
    process: subprocess.Popen[str]

    def admit(self, study: Study, participants: int) -> list[str]:
        """Let participants in and open their first comparison; their cookies."""
        (stored,) = self.store.studies()
        # Nothing is run here, so that the pool of laps never starts a process.
        desk = Desk(
            replace(stored, study=study), self.store, LapKeeper(study, self.store.recordings_folder, 1)
        )
        cookies = []
        for _ in range(participants):
            cookie = new_participant_cookie(desk, self.token)
            assert cookie is not None
            participant = admit(desk, cookie)
            self.store.start_comparison(f"{participant.id}.c1", self.store.clock())
            cookies.append(cookie)
        return cookies

    def cpu_s(self) -> CpuTime | None:
        """Processor time used so far; None where the system doesn't tell."""
        own = _process(self.process.pid)
        if own is None:
            return None
        found = [_process(int(folder.name)) for folder in Path("/proc").glob("[0-9]*")]
        workers = [one.cpu_s for one in found if one and (one.parent, one.name) == (own.pid, PROCESS_NAME)]
        return CpuTime(sum(workers), len(workers), own.cpu_s)


@contextmanager
def served(folder: Path, study_text: str, workers: int | None) -> Iterator[ServerUnderLoad]:
    """Serve a study on a free port until the block ends.

    Raises
    ------
    ElbowroomError
        If the server doesn't start; with the last line that it said.
    """
    (folder / _STUDY).write_text(study_text, encoding="utf-8")
    command = [sys.executable, "-m", "app.cli", "serve", "--study", _STUDY, "--store", _STORE, "--port", "0"]
    if workers is not None:
        command += ["--workers", str(workers)]
    with (folder / _LOG).open("w") as log:
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=log, text=True)
    try:
        assert process.stdout is not None
        link = process.stdout.readline().partition(": ")[2].strip()
        if not link:
            said = (folder / _LOG).read_text().strip().splitlines()
            raise ElbowroomError(f"the server did not start: {said[-1] if said else 'it said nothing'}")
        parts = urlsplit(link)
        with Store.open(folder / _STORE) as store:
            yield ServerUnderLoad(
                f"{parts.scheme}://{parts.netloc}", parts.path.rpartition("/")[2], store, process
            )
    finally:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=_GOODBYE_S)


@dataclass(frozen=True)
class _Process:
    pid: int
    name: str
    parent: int
    cpu_s: float


def _process(pid: int) -> _Process | None:
    """What Linux tells of a process; None if it is gone, or the system is another."""
    try:
        line = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return None
    name, _, rest = line.partition("(")[2].rpartition(")")
    fields = rest.split()
    ticks = int(fields[11]) + int(fields[12])
    return _Process(pid, name, int(fields[1]), ticks / os.sysconf("SC_CLK_TCK"))
