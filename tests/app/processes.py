"""The processes that a server has started (Linux)."""

import time
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import PATIENCE_S


@dataclass(frozen=True)
class Process:
    """A process; one that gets its number later is another one.

    Attributes
    ----------
    started : int
        When, in ticks of the system's clock.
    """

    pid: int
    name: str
    command: str
    started: int


def children(parent: int) -> list[Process]:
    """The processes that a process has started itself."""
    return [found for found, of in _all() if of == parent]


def is_running(process: Process) -> bool:
    """Whether it still is there; who is dead and was not asked for is not."""
    return any(found.pid == process.pid and found.started == process.started for found, _ in _all())


def until_gone(processes: Collection[Process]) -> None:
    """Wait until none of them is there."""
    end = time.monotonic() + PATIENCE_S
    while any(map(is_running, processes)) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(map(is_running, processes))


def _all() -> list[tuple[Process, int]]:
    """All living processes, each with its parent's number."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            name, _, rest = (folder / "stat").read_text().partition("(")[2].rpartition(")")
            command = (folder / "cmdline").read_text()
        except OSError:
            continue
        state, parent, *more = rest.split()
        if state != "Z":
            found.append((Process(int(folder.name), name, command, int(more[17])), int(parent)))
    return found
