"""The processes that run whole laps, watched or finished; a killed one is replaced."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from types import FrameType
from typing import ParamSpec, TypeVar

from app.server.worker_process import be_a_worker

_NICENESS = 5
"""Whole laps may wait: neither pages nor the robots that people hold in hand should wait for them."""

_LINGER_S = 25.0
"""For so long a process that was told to go still finishes laps [s]: what stops a server may tell all its
processes at once, and a new one would have to load everything first."""

_P = ParamSpec("_P")
_T = TypeVar("_T")


class RobotPool:
    """Worker processes for laps, started when the first lap is asked for."""

    def __init__(self, size: int) -> None:
        self.size = size
        self._lock = threading.Lock()
        self._pool = self._new_pool()

    def submit(self, job: Callable[_P, _T], *args: _P.args, **kwargs: _P.kwargs) -> Future[_T]:
        """A job's result to come."""
        with self._lock:
            try:
                return self._pool.submit(job, *args, **kwargs)
            except BrokenProcessPool:
                # A worker was killed from outside: the others are gone with it, new ones take over.
                self._pool = self._new_pool()
                return self._pool.submit(job, *args, **kwargs)

    def close(self) -> None:
        """Stop the workers; jobs under way are given up."""
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _new_pool(self) -> ProcessPoolExecutor:
        # Spawned, never forked: the web process has threads.
        return ProcessPoolExecutor(
            self.size,
            mp_context=multiprocessing.get_context("spawn"),
            initializer=_be_a_lap_worker,
        )


def _be_a_lap_worker() -> None:
    be_a_worker(_NICENESS)
    signal.signal(signal.SIGTERM, _go_soon)


def _go_soon(number: int, frame: FrameType | None) -> None:
    del number, frame
    last_call = threading.Timer(_LINGER_S, os._exit, [0])
    last_call.daemon = True
    last_call.start()
