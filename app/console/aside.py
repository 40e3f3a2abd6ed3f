"""Long work beside the web server: in a process of its own, one at a time, its progress watched.

How far it has come is kept in this process, not in a page, so that it goes on while pages change.
"""

import multiprocessing
import threading
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Literal

from app.server.worker_process import be_a_worker
from data.errors import ElbowroomError

_NICENESS = 10
"""Such work waits for the robots that people hold in hand."""
_LEAST_WAIT_S = 5.0

State = Literal["idle", "running", "done", "failed", "cancelled"]


@dataclass(frozen=True)
class Step:
    """How far a part of the work has come: ``done`` of ``total``, and a word on what is under way."""

    part: str
    done: int
    total: int
    now: str


@dataclass(frozen=True)
class _Given:
    what: object


@dataclass(frozen=True)
class _Ended:
    trouble: str = ""


class Teller:
    """What the work tells the process that asked for it."""

    def __init__(self, told: Connection) -> None:
        self._told = told

    def part(self, name: str) -> Callable[..., None]:
        """Progress of one part of the work, called as ``progress(done, total, now)``."""

        def progress(done: int, total: int, now: str = "") -> None:
            self._told.send(Step(name, done, max(total, 1), now))

        return progress

    def give(self, result: object) -> None:
        """Hand over a result, or one of several."""
        self._told.send(_Given(result))


class Aside:
    """At most one piece of work under way, and how the last one ended.

    Attributes
    ----------
    step : Step
    trouble : str
        Why the last piece failed, if it did.
    given : int
        How many results the last piece has given so far.
    """

    killed = "its process was ended from outside"
    """What is said of work whose process is gone."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: multiprocessing.process.BaseProcess | None = None
        self.state: State = "idle"
        self.step = Step("", 0, 1, "")
        self.trouble = ""
        self.given = 0

    def begin(
        self, work: Callable[..., None], arguments: tuple[object, ...], take: Callable[[object], None]
    ) -> None:
        """Start a piece of work; the caller holds the lock, and none is under way.

        Parameters
        ----------
        work : callable
            A function of a module, called in the other process as ``work(teller, *arguments)``.
        arguments : tuple
            Copied to the other process.
        take : callable
            Called here with each result that the work gives, in a thread.
        """
        # Spawned, never forked: the web process has threads.
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe(duplex=False)
        process = context.Process(target=_run, args=(theirs, work, arguments), daemon=True)
        process.start()
        theirs.close()
        self._process, self.state, self.trouble = process, "running", ""
        self.step, self.given = Step("", 0, 1, ""), 0
        threading.Thread(target=self._listen, args=(ours, process, take), daemon=True).start()

    def cancel(self) -> None:
        """Give up what is under way; what it gave so far stays."""
        with self._lock:
            if self.state != "running" or self._process is None:
                return
            self.state = "cancelled"
            self._process.terminate()

    def _listen(
        self,
        ours: Connection,
        process: multiprocessing.process.BaseProcess,
        take: Callable[[object], None],
    ) -> None:
        """Take what the process says until it has said its last."""
        ended = _Ended(self.killed)
        with ours:
            while True:
                try:
                    said = ours.recv()
                except (EOFError, OSError):
                    break
                if isinstance(said, Step):
                    self.step = said
                elif isinstance(said, _Given):
                    take(said.what)
                    self.given += 1
                else:
                    ended = said
        process.join(_LEAST_WAIT_S)
        with self._lock:
            if self._process is process and self.state == "running":
                self.state, self.trouble = ("failed" if ended.trouble else "done"), ended.trouble


def _run(told: Connection, work: Callable[..., None], arguments: tuple[object, ...]) -> None:
    """The process: its results and steps, then how it ended."""
    be_a_worker(_NICENESS)
    try:
        work(Teller(told), *arguments)
        told.send(_Ended())
    except ElbowroomError as error:
        told.send(_Ended(str(error)))
    except MemoryError:
        told.send(_Ended("not enough memory"))
    finally:
        told.close()
