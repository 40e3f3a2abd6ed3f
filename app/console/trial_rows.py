"""Trials as the console lists them: under coded labels, with the few measures that say how they went."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from app.console.evidence import includes_simulated
from app.console.labels import shown_labels
from app.server.desk import Desk
from data.records import Comparison, Device, Outcome, Participant, Trial

OUTCOME_WORDS: dict[Outcome, str] = {
    "completed": "completed",
    "stuck": "stuck",
    "abandoned": "given up",
    "failed": "stopped",
}


@dataclass(frozen=True)
class TrialRow:
    """A trial with whose it was, and the labels of both of its comparison's modes.

    Attributes
    ----------
    label, other_label : str
        What the mode of the trial's slot, and that of the other slot, is called now.
    """

    trial: Trial
    participant: Participant
    comparison: Comparison
    label: str
    other_label: str

    @property
    def who(self) -> str:
        """What the console calls the participant."""
        letter = "P" if self.participant.source == "human" else "S"
        return f"{letter}{self.participant.number:02d}"

    @property
    def title(self) -> str:
        """The trial in words."""
        trial, place = self.trial, self.comparison.position
        return f"{self.who}, comparison {place}, method {trial.slot}, trial {trial.number}"

    @property
    def device(self) -> Device | None:
        """What the robot was guided with."""
        return self.participant.device


def trial_rows(desk: Desk) -> tuple[TrialRow, ...]:
    """All trials of the study in the order of the store; simulated ones only if they were asked for."""
    labels = shown_labels(desk)
    people = {
        person.id: person
        for person in desk.store.participants(desk.stored_study)
        if person.source == "human" or includes_simulated()
    }
    shown = {c.id: c for c in desk.store.comparisons(desk.stored_study) if c.participant in people}
    return tuple(
        trial_row(trial, shown[trial.comparison], people[shown[trial.comparison].participant], labels)
        for trial in desk.store.trials(desk.stored_study)
        if trial.comparison in shown
    )


def trial_row(
    trial: Trial, comparison: Comparison, participant: Participant, labels: Mapping[str, str]
) -> TrialRow:
    """One trial under the labels that are shown."""
    other = comparison.mode_b if trial.slot == "A" else comparison.mode_a
    return TrialRow(trial, participant, comparison, labels[trial.mode], labels[other])


@dataclass(frozen=True)
class Filter:
    """Which trials are asked for; an empty tuple asks for all."""

    people: tuple[str, ...] = ()
    outcomes: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()

    def lets(self, row: TrialRow) -> bool:
        """Whether a trial is asked for."""
        return (
            (not self.people or row.who in self.people)
            and (not self.outcomes or OUTCOME_WORDS[row.trial.outcome] in self.outcomes)
            and (not self.labels or row.label in self.labels)
        )


@dataclass(frozen=True)
class TrialLine:
    """A trial's line in the table, column by column."""

    participant: str
    comparison: int
    slot: str
    trial: int
    mode: str
    outcome: str
    duration_s: float
    force_mean_n: float | None
    sigma_min: float | None
    delay_ms: float | None
    source: str
    started: datetime


def lines(rows: Sequence[TrialRow]) -> tuple[TrialLine, ...]:
    """The table's lines."""
    return tuple(
        TrialLine(
            participant=row.who,
            comparison=row.comparison.position,
            slot=row.trial.slot,
            trial=row.trial.number,
            mode=row.label,
            outcome=OUTCOME_WORDS[row.trial.outcome],
            duration_s=row.trial.duration_s,
            force_mean_n=row.trial.metrics.get("force_mean_n"),
            sigma_min=row.trial.metrics.get("sigma_min"),
            delay_ms=row.trial.metrics.get("latency_median_ms"),
            source=row.trial.source,
            started=row.trial.started_at,
        )
        for row in rows
    )
