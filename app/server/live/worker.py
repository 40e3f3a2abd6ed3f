"""A live worker: the process that runs the robots in participants' hands.

One thread, one schedule: every 8 ms all its trials take a control tick. Inputs are read right before the
tick that uses them, and the states that come of it are sent right after. A process that comes too late
takes one tick more to catch up; what it missed beyond that is skipped and counted, so that a robot is
never moved in fast motion.
"""

import gc
import select
import signal
import socket
import sys
import time
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from app.server.live import channel
from app.server.live.channel import Beginning, Inbox, Order, Tidings
from app.server.live.live_run import LiveRun
from app.server.worker_process import be_a_worker

if TYPE_CHECKING:
    from data.study import Study
    from sim_trials.live import LiveTrial

PROCESS_NAME = "elbowroom-live"
"""What the system's list of processes calls a worker, where it can be set (15 characters)."""
TICK_S = 0.008
"""``sim_trials.admittance.CONTROL_PERIOD_S``, which is not imported before the process is under way."""
MOST_TICKS = 2
"""The most control ticks that are taken at once."""

_NICENESS = -10
_IDLE_S = 1.0
"""So often a worker without trials looks whether it was told to go [s]."""
_MOST_UNSENT = 1 << 18
"""States are left out while so many bytes wait to be sent."""
_READ = 1 << 16


def work(connection: socket.socket, study: "Study") -> None:
    """Run trials until the web process is gone; what a spawned process does."""
    be_a_worker(_NICENESS)
    with suppress(OSError):
        Path("/proc/self/comm").write_text(PROCESS_NAME)
    worker = Worker(connection, study)
    worker.warm_up()
    # Nothing that exists by now is garbage; what comes later is collected between trials.
    gc.collect()
    gc.freeze()
    gc.disable()
    # Only the thread that follows the parent is there beside this one, and it waits.
    sys.setswitchinterval(1.0)
    signal.signal(signal.SIGTERM, worker.leave)
    worker.run()


class Worker:
    """All trials of one process, and its socket to the web process."""

    def __init__(self, connection: socket.socket, study: "Study") -> None:
        connection.setblocking(False)
        self._connection = connection
        self._study = study
        self._inbox = Inbox()
        self._unsent = bytearray()
        self._runs: dict[int, LiveRun] = {}
        self._is_open = True
        self._is_leaving = False
        self._ticks = 0

    def warm_up(self) -> None:
        """Compile and load what a trial needs, by one that nobody sees."""
        from sim_trials.live import warm_up

        warm_up(self._study)
        beginning = Beginning(0, 0, self._study.practice_mode, 1, is_practice=True)
        run = LiveRun(beginning, self._new_trial(beginning))
        run.trial.abandon()
        run.tick(0.0)
        list(run.news(0, may_leave_out=False))
        self._send([channel.message(Tidings.READY, b"")])

    def leave(self, number: int = signal.SIGTERM, frame: FrameType | None = None) -> None:
        """Give up all laps, hand them over and go: what stops a server may tell each of its processes."""
        del number, frame
        self._is_leaving = True

    def run(self) -> None:
        """Take ticks while there are trials, else wait; until the web process hangs up, or it is to leave."""
        due = time.monotonic()
        while self._is_open and not (self._is_leaving and not self._runs and not self._unsent):
            if not self._runs:
                gc.collect()
                writers = [self._connection] if self._unsent else []
                select.select([self._connection], writers, [], _IDLE_S)
                self._send([])
                due = time.monotonic() + TICK_S
            else:
                time.sleep(max(due - time.monotonic(), 0.0))
            self._read()
            if self._is_leaving:
                for run in self._runs.values():
                    run.trial.abandon()
            now = time.monotonic()
            late = int((now - due) / TICK_S) + 1 if now >= due else 0
            if late and self._runs:
                due += late * TICK_S
                self._take(late, now)

    def _take(self, late: int, now: float) -> None:
        """Take the ticks that are due, as far as there may be any at once."""
        self._ticks += 1
        told: list[bytes] = []
        is_slow = len(self._unsent) > _MOST_UNSENT
        for name, run in list(self._runs.items()):
            try:
                for _ in range(min(late, MOST_TICKS)):
                    if run.trial.ending is None:
                        run.tick(now)
                if late > MOST_TICKS:
                    run.skip(late - MOST_TICKS)
                told.extend(run.news(self._ticks, may_leave_out=is_slow))
                if run.trial.ending is not None:
                    del self._runs[name]
            except Exception as error:
                # One trial that cannot go on must not stop the others.
                told.append(self._failure(name, error))
                del self._runs[name]
        self._send(told)

    def _read(self) -> None:
        now = time.monotonic()
        while True:
            try:
                piece = self._connection.recv(_READ)
            except BlockingIOError:
                return
            except OSError:
                piece = b""
            if not piece:
                self._is_open = False
                return
            for kind, content in self._inbox.take(piece):
                self._obey(kind, content, now)

    def _obey(self, kind: int, content: bytes, now: float) -> None:
        if kind == Order.BEGIN:
            self._begin(channel.unpickled(content, Beginning))
            return
        run = self._runs.get(channel.RUN.unpack_from(content)[0])
        if run is None:
            # It has ended meanwhile.
            return
        if kind == Order.INPUT:
            run.take_input(content[channel.RUN.size :], now)
        elif kind == Order.RELEASE:
            run.release()
        elif kind == Order.END:
            run.trial.abandon()

    def _begin(self, beginning: Beginning) -> None:
        try:
            self._runs[beginning.run] = LiveRun(beginning, self._new_trial(beginning))
        except Exception as error:
            self._send([self._failure(beginning.run, error)])

    def _new_trial(self, beginning: Beginning) -> "LiveTrial":
        from sim_trials.live import LiveTrial

        study = self._study.practice_study if beginning.is_practice else self._study
        return LiveTrial(study, beginning.mode, lap=beginning.lap)

    def _failure(self, run: int, error: Exception) -> bytes:
        why = f"{type(error).__name__}: {error}".encode()
        return channel.message(Tidings.FAILED, channel.RUN.pack(run) + why)

    def _send(self, told: list[bytes]) -> None:
        """Send what the socket takes; the rest waits for the next tick."""
        for part in told:
            self._unsent += part
        if not self._unsent:
            return
        try:
            sent = self._connection.send(self._unsent)
        except BlockingIOError:
            return
        except OSError:
            self._is_open = False
            return
        del self._unsent[:sent]
