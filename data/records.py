"""What is stored of a study: one frozen record per thing that happened."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal

from data.answers import Answer

Source = Literal["human", "simulated"]
TrialSource = Literal["observed", "simulated", "external", "guided"]
Slot = Literal["A", "B"]
Outcome = Literal["completed", "stuck", "abandoned", "failed"]
EventKind = Literal["stuck", "elbow_inversion", "protective_stop"]
Device = Literal["mouse", "keyboard", "touch", "gamepad"]
Clock = Callable[[], datetime]
"""Gives the present time, aware and in UTC. Injected, so that a simulated cohort can have its own."""


@dataclass(frozen=True)
class Participant:
    """A person, or a simulated one, taking part in a study.

    Attributes
    ----------
    id : str
        Unique in the store, e.g. ``9f3c41-p007``; simulated ones are derived from the seed.
    number : int
        Place in the study, from 1: it decides the schedule.
    background : mapping
        Answers to the study's background questions.
    background_at : datetime or None
        When they were submitted.
    device : Device or None
        What the robot is guided with; chosen once.
    practised_at : datetime or None
        When practice was done.
    withdrawn_at : datetime or None
        When the participant's data were withdrawn; nothing but this row is left of them then.
    """

    id: str
    number: int
    source: Source
    joined_at: datetime
    background: Mapping[str, str] = field(default_factory=dict)
    consent_version: str | None = None
    consented_at: datetime | None = None
    finished_at: datetime | None = None
    background_at: datetime | None = None
    device: Device | None = None
    practised_at: datetime | None = None
    withdrawn_at: datetime | None = None


@dataclass(frozen=True)
class Comparison:
    """One blinded A/B pair shown to one participant; ``id`` is ``<participant>.c<position>``.

    Attributes
    ----------
    restarted_at : datetime or None
        When the participant came back and began it anew: trials before count no longer as exposure.
    """

    id: str
    participant: str
    position: int
    repetition: int
    mode_a: str
    mode_b: str
    check: bool
    started_at: datetime | None = None
    answered_at: datetime | None = None
    restarted_at: datetime | None = None

    def mode_of(self, slot: Slot) -> str:
        """The mode behind a slot. The only way from A or B to a mode's name."""
        return self.mode_a if slot == "A" else self.mode_b


@dataclass(frozen=True)
class StuckEvent:
    """Something that halted or disturbed a trial.

    Attributes
    ----------
    time_s : float
        Since the start of the trial [s]; for ``stuck`` the moment the dwell time was exceeded.
    sigma_min : float
        Smallest singular value at that moment (SI units).
    phase : str
        ``free``, ``approach``, ``edge`` or ``exit``.
    definition : str
        Version of the definition that found it.
    """

    kind: EventKind
    time_s: float
    sigma_min: float
    phase: str
    definition: str


@dataclass(frozen=True)
class Trial:
    """One run at the maze under one condition; ``id`` is ``<comparison>.<slot><number>``.

    Attributes
    ----------
    number : int
        Which trial of this slot in the comparison it is, from 1.
    duration_s : float
        Time of exposure to the condition [s].
    metrics : mapping
        Objective metrics by name, units in the names.
    recording, recording_sha256 : str or None
        Path of the recording relative to the store's folder of recordings, and its hash.
    """

    id: str
    comparison: str
    slot: Slot
    number: int
    mode: str
    source: TrialSource
    outcome: Outcome
    started_at: datetime
    duration_s: float
    seed: int
    metrics: Mapping[str, float] = field(default_factory=dict)
    events: tuple[StuckEvent, ...] = ()
    recording: str | None = None
    recording_sha256: str | None = None


@dataclass(frozen=True)
class Response:
    """One answer to one question of one comparison."""

    comparison: str
    question: str
    answer: Answer
    answered_at: datetime


@dataclass(frozen=True)
class Switch:
    """The participant turned to method A or B; ``number`` counts from 1 within the comparison."""

    comparison: str
    number: int
    slot: Slot
    at: datetime


@dataclass(frozen=True)
class ExternalRun:
    """Where a comparison with a robot in the lab stands, so that a restart goes on there.

    Attributes
    ----------
    wanted : Slot
        The method the participant turned to.
    loaded : Slot or None
        The method the operator said is loaded.
    started_at : datetime or None
        When the run under way began; None between runs.
    """

    comparison: str
    wanted: Slot
    loaded: Slot | None = None
    started_at: datetime | None = None


@dataclass(frozen=True)
class Look:
    """Results of people were shown, while a study ran or after it.

    Attributes
    ----------
    participants, answers : int
        People whose answers were among the results, and their answers, without attention checks and
        without those of simulated participants.
    """

    participants: int
    answers: int


@dataclass(frozen=True)
class AuditEntry:
    """One line of the append-only audit log; ``sha256`` chains it to the line before."""

    number: int
    at: datetime
    actor: str
    action: str
    detail: Mapping[str, str]
    sha256: str
