"""How the connection and the page did: latency, pictures a second, skipped control ticks."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from app.server.live.wire import InputFrame

RECENT_S = 10.0
"""What the console shows is of this much time [s]."""
_MOST_RECENT = 2500


@dataclass(frozen=True)
class Latency:
    """Times from an input to the picture that shows it [ms]."""

    median_ms: float
    p95_ms: float
    samples: int


def latency_of(samples: list[float]) -> Latency | None:
    """What is told of some samples [ms]; None if there are none."""
    if not samples:
        return None
    median, p95 = np.percentile(samples, [50, 95])
    return Latency(float(median), float(p95), len(samples))


class TrialQuality:
    """Of one trial, from all inputs that came while the robot was held."""

    def __init__(self) -> None:
        self._latencies: list[float] = []
        self._first: InputFrame | None = None
        self._last: InputFrame | None = None

    def note(self, said: InputFrame) -> None:
        """Take an input into account."""
        if not said.is_enabled:
            return
        if said.latency_ms >= 0.0:
            self._latencies.append(said.latency_ms)
        # A page that was loaded anew counts its pictures anew.
        if self._first is None or said.frames < self._first.frames or said.client_ms < self._first.client_ms:
            self._first = said
        self._last = said

    def metrics(self, ticks: int, skipped: int, lap: int) -> dict[str, float]:
        """What is stored among the trial's metrics; what was not measured is left out."""
        found = {"lap": float(lap), "ticks": float(ticks), "skipped_ticks": float(skipped)}
        latency = latency_of(self._latencies)
        found["latency_samples"] = float(len(self._latencies))
        if latency is not None:
            found |= {"latency_median_ms": latency.median_ms, "latency_p95_ms": latency.p95_ms}
        rate = _rate(self._first, self._last)
        if rate is not None:
            found["frame_rate_hz"] = rate
        return found


class RecentQuality:
    """Of the last `RECENT_S` of one connection."""

    def __init__(self) -> None:
        self._said: deque[tuple[float, InputFrame]] = deque(maxlen=_MOST_RECENT)

    def note(self, said: InputFrame, now: float) -> None:
        """Take an input into account."""
        self._said.append((now, said))

    def latency(self, now: float) -> Latency | None:
        """Of the measurements that came lately."""
        recent = self._recent(now)
        return latency_of([said.latency_ms for said in recent if said.latency_ms >= 0.0])

    def frame_rate_hz(self, now: float) -> float | None:
        """Pictures drawn a second."""
        recent = self._recent(now)
        return _rate(recent[0], recent[-1]) if recent else None

    def _recent(self, now: float) -> list[InputFrame]:
        return [said for at, said in self._said if now - at <= RECENT_S]


def _rate(first: InputFrame | None, last: InputFrame | None) -> float | None:
    if (
        first is None
        or last is None
        or last.client_ms - first.client_ms < 500.0
        or last.frames < first.frames
    ):
        return None
    return 1000.0 * (last.frames - first.frames) / (last.client_ms - first.client_ms)
