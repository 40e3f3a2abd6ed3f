"""The laps that participants watch: run in processes of their own, each once, and kept.

The web process never runs the robot: a lap is computed in a worker process, so that pages stay quick.
"""

import multiprocessing
import signal
import threading
from collections import OrderedDict
from collections.abc import Iterable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.server.watched_lap import WatchedLap, run_lap, warm_up
from data.records import Comparison, Slot
from data.study import Study

KEPT_LAPS = 600
"""How many laps stay in memory, about 100 kB each; an older one is run again when it is asked for."""


@dataclass(frozen=True)
class LapKey:
    """Which lap: of a comparison, under a slot."""

    comparison: Comparison
    slot: Slot
    lap: int
    seed: int

    @property
    def recording(self) -> str:
        """Name of the lap's recording in the store's folder."""
        return f"{self.comparison.id}.{self.slot}.lap{self.lap}.parquet"


def comparison_seed(study: Study, participant_number: int, position: int) -> int:
    """The seed of a comparison's simulated operator: one person, whose hand is the same under A and B."""
    return int(np.random.SeedSequence([study.seed, 3, participant_number, position]).generate_state(1)[0])


class LapKeeper:
    """Runs laps in worker processes and keeps what they give."""

    def __init__(self, study: Study, recordings: Path, workers: int) -> None:
        self._study = study
        self._recordings = recordings
        self._workers = workers
        self._laps: OrderedDict[tuple[str, Slot, int], Future[WatchedLap]] = OrderedDict()
        self._lock = threading.Lock()
        self._pool = self._new_pool()

    def warm_up(self) -> None:
        """Let the workers compile and load what a lap needs before anyone waits for it."""
        for _ in range(self._workers):
            self._pool.submit(warm_up, self._study)

    def lap(self, key: LapKey) -> Future[WatchedLap]:
        """A lap to come; the same key gives the same lap."""
        name = (key.comparison.id, key.slot, key.lap)
        with self._lock:
            known = self._laps.get(name)
            if known is not None and not (known.done() and (known.cancelled() or known.exception())):
                self._laps.move_to_end(name)
                return known
            job = (
                self._study,
                key.comparison.mode_of(key.slot),
                key.seed,
                key.lap,
                self._recordings / key.recording,
            )
            try:
                future = self._pool.submit(run_lap, *job)
            except BrokenProcessPool:
                # A worker was killed from outside: the others are gone with it, new ones take over.
                self._pool = self._new_pool()
                future = self._pool.submit(run_lap, *job)
            self._laps[name] = future
            while len(self._laps) > KEPT_LAPS:
                self._laps.popitem(last=False)
            return future

    def prepare(self, keys: Iterable[LapKey]) -> None:
        """Get laps ready before they are asked for."""
        for key in keys:
            self.lap(key)

    def close(self) -> None:
        """Stop the workers; laps under way are given up."""
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _new_pool(self) -> ProcessPoolExecutor:
        # Spawned, never forked: the web process has threads.
        return ProcessPoolExecutor(
            self._workers, mp_context=multiprocessing.get_context("spawn"), initializer=_be_a_worker
        )


def _be_a_worker() -> None:
    """Leave Ctrl-C to the parent, and go when the parent is gone however it went."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_follow_the_parent, daemon=True).start()


def _follow_the_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        signal.raise_signal(signal.SIGTERM)
