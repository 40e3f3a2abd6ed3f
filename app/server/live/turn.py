"""One trial as its session in the web process sees it."""

from dataclasses import dataclass, field
from datetime import datetime

from app.server.live import wire
from app.server.live.archive import SHORTEST_TRIAL_S, FinishedTrial, held_s
from app.server.live.channel import Ending
from app.server.live.connection import Strokes
from app.server.live.crew import Handle
from app.server.live.quality import TrialQuality
from app.server.live.wire import InputFrame
from data.records import Clock, Comparison, Outcome, Slot


@dataclass
class Turn:
    """A trial under way, or over and not stored yet.

    Attributes
    ----------
    slot, lap : Slot, int
    trial : int
        Its number between server and browser.
    held_at : datetime or None
        When the robot was first held.
    handle : Handle or None
        None until a worker has it.
    """

    slot: Slot
    lap: int
    trial: int
    held_at: datetime | None = None
    handle: Handle | None = None
    strokes: Strokes = field(init=False)
    quality: TrialQuality = field(default_factory=TrialQuality)
    state: bytes | None = None
    ticks: int = 0
    skipped: int = 0

    def __post_init__(self) -> None:
        self.strokes = Strokes(self.trial)

    @property
    def skipped_share(self) -> float:
        """Of its control ticks, those for which there was no time."""
        return self.skipped / max(self.ticks + self.skipped, 1)

    def note(self, said: InputFrame, clock: Clock) -> None:
        """Take an input into account."""
        if self.held_at is None and said.is_enabled:
            self.held_at = clock()
        self.quality.note(said)

    def outcome(self, ending: Ending | None) -> Outcome:
        """How it ended; failed if it is gone with its worker."""
        from sim_trials.trial import OUTCOMES

        return OUTCOMES[ending.inputs.ending] if ending else "failed"

    def finished(self, comparison: Comparison, number: int, ending: Ending | None) -> FinishedTrial | None:
        """What there is to store; None if the robot was hardly held.

        Parameters
        ----------
        ending : Ending or None
            None if the trial is gone with its worker.
        """
        seen_s = wire.state_time_s(self.state) if self.state else 0.0
        was_held_s = held_s(ending.inputs) if ending else seen_s
        if self.held_at is None or was_held_s < SHORTEST_TRIAL_S:
            return None
        ticks, skipped = (ending.ticks, ending.skipped) if ending else (self.ticks, self.skipped)
        return FinishedTrial(
            comparison=comparison,
            slot=self.slot,
            number=number,
            lap=self.lap,
            started_at=self.held_at,
            duration_s=seen_s,
            metrics=self.quality.metrics(ticks, skipped, self.lap),
            inputs=ending.inputs if ending else None,
        )
