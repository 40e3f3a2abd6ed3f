"""What a live session leaves in the store: trials with their recordings, switches, practice.

Nothing is given up while the server runs: a full disk or a busy store is tried again until it takes what
there is to keep, and the browser is told only then.
"""

import asyncio
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from contextlib import nullcontext
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from starlette.concurrency import run_in_threadpool

from app.participant.watching import counting_trials
from app.server.access_log import LOG
from app.server.live.guided_lap import GuidedLap, finish_lap
from app.server.robot_pool import RobotPool
from data.errors import ElbowroomError, InputError
from data.records import Comparison, Slot, Switch, Trial
from data.store import Store
from data.study import Study

if TYPE_CHECKING:
    from sim_trials.trace import LapInputs

SLOTS: tuple[Slot, Slot] = ("A", "B")
SHORTEST_TRIAL_S = 0.1
"""A trial in which the robot was held for less is none [s]."""

_PAUSES_S = (0.5, 1.0, 2.0, 4.0)
_MOST_CRASHES = 3
"""A lap that brings its process down so often is stored without a recording."""

_T = TypeVar("_T")


class Gone(Exception):
    """The participant has withdrawn: nothing more is stored."""


@dataclass(frozen=True)
class Standing:
    """Where a comparison stands, by what is stored.

    Attributes
    ----------
    exposure : dict
        To each slot [s].
    laps : dict
        Laps of each slot that came to an end by themselves.
    numbers : dict
        The last trial of each slot.
    slot : Slot or None
        Which was open last.
    switches : int
        The last switch.
    trials, stuck : int
        Trials in all, and those that ended stuck.
    """

    exposure: dict[Slot, float]
    laps: dict[Slot, int]
    numbers: dict[Slot, int]
    slot: Slot | None = None
    switches: int = 0
    trials: int = 0
    stuck: int = 0

    @property
    def told_exposure(self) -> dict[Slot, float]:
        """Exposure as the browser is told it [s]."""
        return {slot: round(seconds, 3) for slot, seconds in self.exposure.items()}


def nothing_yet() -> Standing:
    """Of practice, of which nothing is stored, and of a comparison that has just begun."""
    return Standing(dict.fromkeys(SLOTS, 0.0), dict.fromkeys(SLOTS, 0), dict.fromkeys(SLOTS, 0))


@dataclass(frozen=True)
class FinishedTrial:
    """A trial that is over, before it is stored.

    Attributes
    ----------
    duration_s : float
        As far as it was seen; what the inputs come to counts more.
    metrics : dict
        Of the connection and the page (``quality``).
    inputs : LapInputs or None
        None if they are gone with their worker.
    """

    comparison: Comparison
    slot: Slot
    number: int
    lap: int
    started_at: datetime
    duration_s: float
    metrics: dict[str, float]
    inputs: "LapInputs | None"

    @property
    def id(self) -> str:
        """Name of the trial in the store."""
        return f"{self.comparison.id}.{self.slot}{self.number}"

    def trial(self, lap: GuidedLap | None) -> Trial:
        """The record; without a lap it failed, and only how long it took is known."""
        return Trial(
            id=self.id,
            comparison=self.comparison.id,
            slot=self.slot,
            number=self.number,
            mode=self.comparison.mode_of(self.slot),
            source="guided",
            outcome=lap.outcome if lap else "failed",
            started_at=self.started_at,
            duration_s=lap.duration_s if lap else self.duration_s,
            seed=0,
            metrics={**(lap.metrics if lap else {}), **self.metrics},
            events=lap.events if lap else (),
            recording=lap.recording if lap else None,
            recording_sha256=lap.recording_sha256 if lap else None,
        )


def held_s(inputs: "LapInputs") -> float:
    """For how long the robot was held [s]."""
    from sim_trials.admittance import CONTROL_PERIOD_S
    from sim_trials.loop import ENABLE

    return float(np.count_nonzero(inputs.triggers & ENABLE)) * CONTROL_PERIOD_S


class Archive:
    """Keeps what happens in live sessions."""

    def __init__(self, study: Study, store: Store, pool: RobotPool) -> None:
        self._study = study
        self._store = store
        self._pool = pool
        self._is_closing = False
        self._alone = asyncio.Lock()

    def close(self) -> None:
        """From now on give up what is refused."""
        self._is_closing = True

    def read_standing(self, comparison: Comparison) -> Standing:
        """Where a comparison stands."""
        return _standing(self._store, comparison.id)

    async def keep_trial(self, finished: FinishedTrial) -> Standing:
        """Finish a trial and commit it; where its comparison stands now.

        Raises
        ------
        Gone
            If the participant has withdrawn: nothing of the trial is left.
        """
        lap = await self._lap(finished)
        trial = finished.trial(lap)

        def commit() -> Standing:
            self._store.add_trial(trial)
            return _standing(self._store, trial.comparison)

        try:
            return await self._insist(f"trial {trial.id}", finished.comparison.participant, commit)
        except Gone:
            if trial.recording is not None:
                (self._store.recordings_folder / trial.recording).unlink(missing_ok=True)
            raise

    async def keep_switch(self, switch: Switch, participant_id: str) -> None:
        """Commit a participant's switch; raises as `keep_trial` does."""
        name = f"switch {switch.number} of {switch.comparison}"
        await self._insist(name, participant_id, lambda: self._store.add_switch(switch))

    async def keep_practice(self, participant_id: str, at: datetime) -> None:
        """Commit that a participant has practised; raises as `keep_trial` does."""
        name = f"practice of {participant_id}"
        await self._insist(name, participant_id, lambda: self._store.record_practice(participant_id, at))

    async def _lap(self, finished: FinishedTrial) -> GuidedLap | None:
        """What the inputs come to; None if that cannot be known."""
        from sim_trials.recording import ReplayError

        inputs = finished.inputs
        if inputs is None:
            return None
        mode = finished.comparison.mode_of(finished.slot)

        async def replay() -> GuidedLap | None:
            path = self._store.recordings_folder / f"{finished.id}.parquet"
            for crashes in range(_MOST_CRASHES):
                # Laps that were under way at a crash are run one by one: only one of them may be to blame.
                async with self._alone if crashes else nullcontext():
                    try:
                        job = self._pool.submit(finish_lap, self._study, mode, inputs, finished.lap, path)
                        return await asyncio.wrap_future(job)
                    except BrokenProcessPool:
                        LOG.error("trial %s: the process that finished it is gone", finished.id)
            return None

        attempt = 0
        while True:
            try:
                return await replay()
            except ElbowroomError as error:
                LOG.error("trial %s: %s", finished.id, error)
                # What differs once it is run again always will; a full disk may have room later.
                if isinstance(error, InputError | ReplayError) or self._is_closing:
                    return None
            except Exception:
                # Whatever it is, for how long the robot was in hand is known, and counts.
                LOG.exception("trial %s cannot be finished", finished.id)
                return None
            await asyncio.sleep(_PAUSES_S[min(attempt, len(_PAUSES_S) - 1)])
            attempt += 1

    async def _insist(self, what: str, participant_id: str, commit: Callable[[], _T]) -> _T:
        """Commit, again and again until it is done."""
        attempt = 0
        while True:
            try:
                return await run_in_threadpool(commit)
            except ElbowroomError as error:
                if await run_in_threadpool(_has_withdrawn, self._store, participant_id):
                    raise Gone from None
                LOG.error("%s is not stored yet: %s", what, error)
                if self._is_closing:
                    raise
            await asyncio.sleep(_PAUSES_S[min(attempt, len(_PAUSES_S) - 1)])
            attempt += 1


def _standing(store: Store, comparison_id: str) -> Standing:
    """Read where a comparison stands."""
    comparison = store.comparison(comparison_id)
    exposure, laps = dict.fromkeys(SLOTS, 0.0), dict.fromkeys(SLOTS, 0)
    counting = counting_trials(store, comparison)
    for trial in counting:
        exposure[trial.slot] += trial.duration_s
        laps[trial.slot] += trial.outcome in ("completed", "stuck")
    numbers = dict.fromkeys(SLOTS, 0)
    for trial in store.trials(comparison=comparison_id):
        numbers[trial.slot] = max(numbers[trial.slot], trial.number)
    switches, anew = store.switches(comparison_id), comparison.restarted_at
    last = switches[-1] if switches else None
    return Standing(
        exposure=exposure,
        laps=laps,
        numbers=numbers,
        slot=last.slot if last and (anew is None or last.at >= anew) else None,
        switches=last.number if last else 0,
        trials=len(counting),
        stuck=sum(trial.outcome == "stuck" for trial in counting),
    )


def _has_withdrawn(store: Store, participant_id: str) -> bool:
    """Whether a participant has withdrawn; not as long as the store cannot be asked."""
    try:
        return store.participant(participant_id).withdrawn_at is not None
    except ElbowroomError:
        return False
