"""Where a participant is: read from the store alone, so that a reload goes on right there."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Literal

from app.server.laps import LapKey, comparison_seed
from data.records import Comparison, Participant, Slot
from data.store import Store
from data.study import Study

Place = Literal[
    "withdrawn",
    "closed",
    "background",
    "instructions",
    "practice",
    "ready",
    "comparison",
    "between",
    "break",
    "thanks",
]
SLOTS: tuple[Slot, Slot] = ("A", "B")
EXPOSURE_TOLERANCE_S = 0.05
"""What rounding of the stretches watched may take away."""


@dataclass(frozen=True)
class Progress:
    """How far a participant has come.

    Attributes
    ----------
    comparisons : tuple of Comparison
        All that are planned, in order.
    """

    participant: Participant
    comparisons: tuple[Comparison, ...]

    @property
    def answered(self) -> int:
        """How many comparisons are answered."""
        return sum(comparison.answered_at is not None for comparison in self.comparisons)

    @property
    def comparison(self) -> Comparison | None:
        """The comparison that was started and is not answered yet."""
        for comparison in self.comparisons:
            if comparison.started_at is not None and comparison.answered_at is None:
                return comparison
        return None

    @property
    def next(self) -> Comparison | None:
        """The first comparison that was not started."""
        return next((c for c in self.comparisons if c.started_at is None), None)

    @property
    def is_last(self) -> bool:
        """Whether one comparison alone is not answered."""
        return self.answered == len(self.comparisons) - 1

    def place_in(self, study: Study, now: datetime) -> Place:
        """The page to show.

        Who has answered everything keeps the last page for good; for everybody else the study may be over.
        """
        if self.participant.withdrawn_at is not None:
            return "withdrawn"
        if self.comparison is None and self.next is None:
            return "thanks"
        if not may_still_take_part(study, self.participant, now):
            return "closed"
        if self.comparison is not None:
            return "comparison"
        if self.answered:
            every = study.protocol.break_every
            return "break" if every and self.answered % every == 0 else "between"
        return self._place_before_the_first(study)

    def _place_before_the_first(self, study: Study) -> Place:
        if study.background and self.participant.background_at is None:
            return "background"
        if study.protocol.trial_source != "guided" or self.participant.device is None:
            return "instructions"
        if study.has_practice and self.participant.practised_at is None:
            return "practice"
        return "ready"

    def may_answer(self, study: Study, watched: Mapping[Slot, float]) -> bool:
        """Whether A and B were met for the least time."""
        least = study.protocol.minimum_exposure_s - EXPOSURE_TOLERANCE_S
        return all(watched[slot] >= least for slot in SLOTS)

    def lap_key(self, study: Study, slot: Slot, lap: int) -> LapKey:
        """A lap of the open comparison."""
        return self.lap_key_of(study, self.comparison, slot, lap)

    def lap_keys(self, study: Study, comparison: Comparison) -> Iterable[LapKey]:
        """All laps of a comparison, in the order in which they are likely to be watched."""
        for lap in range(1, study.protocol.laps_per_condition + 1):
            for slot in SLOTS:
                yield self.lap_key_of(study, comparison, slot, lap)

    def lap_key_of(self, study: Study, comparison: Comparison | None, slot: Slot, lap: int) -> LapKey:
        """A lap of a comparison; its seed is the same for A and B."""
        if comparison is None:
            raise ValueError("no comparison is open")
        seed = comparison_seed(study, self.participant.number, comparison.position)
        return LapKey(comparison, slot, lap, seed)


def progress_of(store: Store, participant: Participant) -> Progress:
    """A participant's progress as stored."""
    return Progress(participant, store.comparisons(participant=participant.id))


def may_still_take_part(study: Study, participant: Participant, now: datetime) -> bool:
    """Whether anything more of a participant may be stored: not withdrawn, and within the study's hours.

    The hours count from joining (`Protocol.returning_within_h`), also for who is in the middle of something.
    """
    if participant.withdrawn_at is not None:
        return False
    hours = study.protocol.returning_within_h
    return hours == 0 or now - participant.joined_at < timedelta(hours=hours)
