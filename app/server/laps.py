"""The laps that participants watch: run in processes of their own, each once, and kept.

The web process never runs the robot: a lap is computed in a worker process, so that pages stay quick.
"""

import threading
from collections import OrderedDict
from collections.abc import Iterable
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.server.robot_pool import RobotPool
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
        self.pool = RobotPool(workers)
        self._laps: OrderedDict[tuple[str, Slot, int], Future[WatchedLap]] = OrderedDict()
        self._lock = threading.Lock()

    def warm_up(self) -> None:
        """Let the workers compile and load what a lap needs before anyone waits for it."""
        for _ in range(self.pool.size):
            self.pool.submit(warm_up, self._study)

    def lap(self, key: LapKey) -> Future[WatchedLap]:
        """A lap to come; the same key gives the same lap."""
        name = (key.comparison.id, key.slot, key.lap)
        with self._lock:
            known = self._laps.get(name)
            if known is not None and not (known.done() and (known.cancelled() or known.exception())):
                self._laps.move_to_end(name)
                return known
            future = self.pool.submit(
                run_lap,
                self._study,
                key.comparison.mode_of(key.slot),
                key.seed,
                key.lap,
                self._recordings / key.recording,
            )
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
        self.pool.close()
