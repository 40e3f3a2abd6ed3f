"""Who is at the robot now, for the console."""

from dataclasses import dataclass
from datetime import datetime

from data.records import Device, Slot


@dataclass(frozen=True)
class LiveRow:
    """One participant's live session.

    Attributes
    ----------
    participant, number : str, int
        Id, and place in the study.
    comparison : int or None
        Position of the comparison that is open; None for practice.
    slot, lap : Slot or None, int
        What is under way; no mode, since that is blinded here too.
    is_connected, since : bool, datetime
        Whether the page is there, and since when it is or is not.
    latency_median_ms, latency_p95_ms, frame_rate_hz : float or None
        Of the last ten seconds; None if nothing was measured.
    skipped_share : float
        Of the control ticks of the trial under way, those for which there was no time.
    trials, stuck : int
        Of the comparison, as stored.
    """

    participant: str
    number: int
    comparison: int | None
    slot: Slot | None
    lap: int
    is_connected: bool
    since: datetime
    device: Device | None
    latency_median_ms: float | None
    latency_p95_ms: float | None
    frame_rate_hz: float | None
    skipped_share: float
    trials: int
    stuck: int
