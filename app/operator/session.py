"""A comparison on a robot in the lab: what the participant turns to, what the operator does, and the trials.

The participant turns to A or B; the operator loads what stands behind it, starts the run and says how it
ended. Everything is read from the store and committed at once, so a reload, a second window or a killed
server changes nothing. Each act says what it was meant for, a slot or the start of a run, and does nothing if
that is over by now: a click that comes twice or too late is harmless.
"""

import math
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from app.participant.watching import watched_s
from data.records import Comparison, ExternalRun, Outcome, Slot, StuckEvent, Switch, Trial
from data.store import Store

Step = Literal["load", "reset", "start", "run"]
"""What comes next: load the wanted method, put the robot back, start the run, or end the run under way."""
FIRST_SLOT: Slot = "A"
STUCK_DEFINITION = "operator/1"
"""The operator saw that the robot was stuck; no threshold is behind it."""
MOST_TURNS = 1000
"""So many turns of one comparison are kept: nobody makes more by hand."""


@dataclass(frozen=True)
class Standing:
    """Where a comparison stands.

    Attributes
    ----------
    trials : tuple of Trial
        What is over, oldest first.
    exposure_s : dict
        Exposure to each slot by finished runs [s], since the comparison was begun or begun anew.
    """

    comparison: Comparison
    run: ExternalRun
    trials: tuple[Trial, ...]
    exposure_s: dict[Slot, float]

    @property
    def step(self) -> Step:
        """What comes next."""
        if self.run.started_at is not None:
            return "run"
        if self.run.loaded == self.run.wanted:
            return "start"
        if self.run.loaded is None and self.trials and self.trials[-1].slot == self.run.wanted:
            return "reset"
        return "load"

    def running_s(self, now: datetime) -> float:
        """How long the run under way has lasted [s]; 0 between runs."""
        started = self.run.started_at
        return 0.0 if started is None else _seconds_between(started, now)

    def exposure_by(self, now: datetime) -> dict[Slot, float]:
        """Exposure to each slot [s], the run under way included."""
        exposure = dict(self.exposure_s)
        started, slot = self.run.started_at, self.run.loaded
        anew = self.comparison.restarted_at
        if started is not None and slot is not None and (anew is None or started >= anew):
            exposure[slot] += _seconds_between(started, now)
        return exposure


def standing(store: Store, comparison: Comparison) -> Standing:
    """Where a comparison stands; before the participant turned to anything, A is wanted."""
    with store.reading():
        run = store.external_run(comparison.id) or ExternalRun(comparison.id, FIRST_SLOT)
        trials = sorted(store.trials(comparison=comparison.id), key=lambda trial: trial.started_at)
        exposure = watched_s(store, comparison)
    return Standing(comparison, run, tuple(trials), exposure)


def turn_to(store: Store, comparison: Comparison, slot: Slot, now: datetime) -> None:
    """The participant turns to a slot: kept as a switch; a run under the other one ends as abandoned."""
    with store.transaction():
        run = _open_run(store, comparison)
        if run is None or run.wanted == slot:
            return
        switches = store.switches(comparison.id)
        if len(switches) >= MOST_TURNS:
            return
        _end(store, run, "abandoned", now)
        store.want_slot(comparison.id, slot)
        store.add_switch(Switch(comparison.id, len(switches) + 1, slot, now))


def loaded(store: Store, comparison: Comparison, slot: Slot) -> None:
    """The operator has loaded the method behind a slot, and the robot is at the start."""
    with store.transaction():
        run = _open_run(store, comparison)
        if run is not None and run.started_at is None:
            store.load_slot(comparison.id, slot)


def start(store: Store, comparison: Comparison, slot: Slot, now: datetime) -> None:
    """A run under a slot begins, if that is loaded and still wanted."""
    with store.transaction():
        run = _open_run(store, comparison)
        if run is not None and run.loaded == run.wanted == slot:
            store.start_run(comparison.id, now)


def end(
    store: Store, comparison: Comparison, started_at: datetime | None, outcome: Outcome, now: datetime
) -> None:
    """The run that began at a time is over; nothing happens if it was over before."""
    with store.transaction():
        run = store.external_run(comparison.id)
        if run is not None and run.started_at is not None and run.started_at == started_at:
            _end(store, run, outcome, now)


def finish(store: Store, comparison_id: str, now: datetime) -> None:
    """The participant goes on to the questions, or answers them: a run under way ends as abandoned."""
    with store.transaction():
        run = store.external_run(comparison_id)
        if run is not None:
            _end(store, run, "abandoned", now)


def correct(store: Store, trial: Trial, outcome: Outcome, now: datetime) -> None:
    """The operator ended a run by the wrong button; the audit log keeps both outcomes.

    Nothing happens once the comparison is answered: the answers were given on the run as it was.
    """
    with store.transaction():
        stored = store.trial(trial.id)
        if _open_run(store, store.comparison(trial.comparison)) is None or stored.outcome == outcome:
            return
        store.correct_outcome(trial.id, outcome, _events(outcome, stored.duration_s))
        detail = {"trial": trial.id, "from": stored.outcome, "to": outcome}
        store.log("operator", "correct outcome", detail, now)


def _open_run(store: Store, comparison: Comparison) -> ExternalRun | None:
    """The run of a comparison that is open as the store has it now, or None."""
    stored = store.comparison(comparison.id)
    if stored.started_at is None or stored.answered_at is not None:
        return None
    return store.external_run(comparison.id) or store.want_slot(comparison.id, FIRST_SLOT)


def _end(store: Store, run: ExternalRun, outcome: Outcome, now: datetime) -> None:
    """Make a trial of the run under way, if there is one."""
    slot, started = run.loaded, run.started_at
    if slot is None or started is None:
        return
    before = [trial.number for trial in store.trials(comparison=run.comparison) if trial.slot == slot]
    number = 1 + max(before, default=0)
    duration_s = _seconds_between(started, now)
    store.add_trial(
        Trial(
            id=f"{run.comparison}.{slot}{number}",
            comparison=run.comparison,
            slot=slot,
            number=number,
            mode=store.comparison(run.comparison).mode_of(slot),
            source="external",
            outcome=outcome,
            started_at=started,
            duration_s=duration_s,
            seed=0,
            events=_events(outcome, duration_s),
        )
    )
    store.end_run(run.comparison)
    if outcome != "completed":
        # A lap ends where it began; after anything else the robot has to be put back first.
        store.load_slot(run.comparison, None)


def _events(outcome: Outcome, duration_s: float) -> tuple[StuckEvent, ...]:
    if outcome != "stuck":
        return ()
    return (StuckEvent("stuck", duration_s, math.nan, "", STUCK_DEFINITION),)


def _seconds_between(earlier: datetime, later: datetime) -> float:
    return round(max(0.0, (later - earlier).total_seconds()), 3)
