"""What a participant watched, from the browser's report to trials and switches in the store.

One trial is one stretch of a lap that was watched, from the lap's start until its end, a switch, a restart
or leaving the page; its duration is the time it was on the screen and moving, so the exposure to a method
is the sum over its trials. A lap watched to its end has the lap's outcome and metrics; one left before is
``abandoned`` and has none, since they would be of something that wasn't shown. A stuck event counts once
it was seen. The number of the lap stands among the metrics as ``lap``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Self

from app.participant.progress import SLOTS, Progress
from app.server.watched_lap import WatchedLap
from data.records import Comparison, Slot, Switch, Trial
from data.store import Store
from data.study import Study

END_TOLERANCE_S = 0.25
"""So close to its end, a lap was watched to its end."""
CLOCK_TOLERANCE_S = 3.0
"""Nobody watches longer than the comparison is open; this much may two clocks and rounding differ."""
_MOST_EVENTS = 500
MOST_KEPT = 2000
"""So many runs and turns of one comparison are kept: nobody makes more by hand."""


class BadReport(Exception):
    """A report that no page of ours would send."""


@dataclass(frozen=True)
class Run:
    """A lap, or the first part of it, that was watched; ``number`` counts per slot from 1."""

    number: int
    slot: Slot
    lap: int
    watched_s: float


@dataclass(frozen=True)
class Turn:
    """A switch to A or B; ``number`` counts from 1."""

    number: int
    slot: Slot


@dataclass(frozen=True)
class WatchReport:
    """What one request tells, in order."""

    runs: tuple[Run, ...]
    turns: tuple[Turn, ...]

    @classmethod
    def parse(cls, body: Mapping[str, object], study: Study) -> Self:
        """A report from a request's JSON; everything in it is checked."""
        events = body.get("events")
        if not isinstance(events, list) or len(events) > _MOST_EVENTS:
            raise BadReport("events: a list is needed")
        runs, turns = [], []
        for event in events:
            if not isinstance(event, dict):
                raise BadReport("events: objects are needed")
            number = _whole(event, "number", 1, 100_000)
            slot = next((slot for slot in SLOTS if slot == event.get("slot")), None)
            if slot is None:
                raise BadReport("slot: A or B is needed")
            if event.get("kind") == "switch":
                turns.append(Turn(number, slot))
            elif event.get("kind") == "run":
                lap = _whole(event, "lap", 1, study.protocol.laps_per_condition)
                runs.append(Run(number, slot, lap, _seconds(event, "watched_s")))
            else:
                raise BadReport("kind: run or switch is needed")
        return cls(tuple(runs), tuple(turns))


def watched_s(store: Store, comparison: Comparison) -> dict[Slot, float]:
    """Exposure to each slot of a comparison [s], since it was begun or begun anew."""
    watched: dict[Slot, float] = dict.fromkeys(SLOTS, 0.0)
    for trial in counting_trials(store, comparison):
        watched[trial.slot] += trial.duration_s
    return watched


def counting_trials(store: Store, comparison: Comparison) -> tuple[Trial, ...]:
    """The trials of a comparison since it was begun, or begun anew."""
    trials, anew = store.trials(comparison=comparison.id), comparison.restarted_at
    return tuple(trial for trial in trials if anew is None or trial.started_at >= anew)


def was_whole(trial: Trial) -> bool:
    """Whether an observed lap was watched to its end: only then does it have metrics."""
    return len(trial.metrics) > 1


def store_report(
    store: Store,
    progress: Progress,
    report: WatchReport,
    laps: Mapping[tuple[Slot, int], WatchedLap],
    now: datetime,
) -> None:
    """Store a report, all of it or nothing; what was stored before is not stored again.

    A page that had no answer sends its report once more, with the same numbers. A number that is taken by
    something else comes from a second window: it gets the next free one.

    Raises
    ------
    BadReport
        If more was watched than there was time for, or more of a lap than it has.
    """
    comparison = progress.comparison
    if comparison is None or comparison.started_at is None:
        raise BadReport("no comparison is open")
    with store.transaction():
        stored = {trial.id: trial for trial in store.trials(comparison=comparison.id)}
        for run in report.runs:
            trial = _trial(run, comparison, progress, laps[run.slot, run.lap], now, stored)
            if trial is not None:
                stored[trial.id] = trial
                store.add_trial(trial)
        total = sum(trial.duration_s for trial in stored.values())
        if total > (now - comparison.started_at).total_seconds() + CLOCK_TOLERANCE_S:
            raise BadReport("more was watched than there was time for")
        switches = {switch.number: switch.slot for switch in store.switches(comparison.id)}
        for turn in report.turns:
            if switches.get(turn.number) == turn.slot:
                continue
            number = turn.number if turn.number not in switches else max(switches) + 1
            switches[number] = turn.slot
            store.add_switch(Switch(comparison.id, number, turn.slot, now))
        if len(stored) + len(switches) > MOST_KEPT:
            raise BadReport("more was reported than anyone watches")


def _trial(
    run: Run,
    comparison: Comparison,
    progress: Progress,
    lap: WatchedLap,
    now: datetime,
    stored: Mapping[str, Trial],
) -> Trial | None:
    """The trial of a run, or None if it is stored already."""
    if run.watched_s > lap.duration_s + END_TOLERANCE_S:
        raise BadReport("more of a lap was watched than it has")
    is_whole = run.watched_s >= lap.duration_s - END_TOLERANCE_S
    number = run.number
    known = stored.get(_trial_id(comparison, run.slot, number))
    if known is not None:
        if known.duration_s == run.watched_s and known.metrics.get("lap") == run.lap:
            return None
        number = 1 + max(trial.number for trial in stored.values() if trial.slot == run.slot)
    key_events = tuple(event for event in lap.events if event.time_s <= run.watched_s + END_TOLERANCE_S)
    return Trial(
        id=_trial_id(comparison, run.slot, number),
        comparison=comparison.id,
        slot=run.slot,
        number=number,
        mode=comparison.mode_of(run.slot),
        source="observed",
        outcome=lap.outcome if is_whole else "abandoned",
        started_at=now - timedelta(seconds=run.watched_s),
        duration_s=run.watched_s,
        seed=lap.seed,
        metrics={"lap": float(run.lap), **(lap.metrics if is_whole else {})},
        events=key_events,
        recording=lap.recording,
        recording_sha256=lap.recording_sha256,
    )


def _trial_id(comparison: Comparison, slot: Slot, number: int) -> str:
    return f"{comparison.id}.{slot}{number}"


def _whole(event: Mapping[str, object], name: str, low: int, high: int) -> int:
    value = event.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise BadReport(f"{name}: a whole number from {low} to {high} is needed")
    return value


def _seconds(event: Mapping[str, object], name: str) -> float:
    value = event.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadReport(f"{name}: a number is needed")
    if not 0 <= value <= 3600:
        raise BadReport(f"{name}: seconds from 0 to 3600 are needed")
    return round(float(value), 3)
