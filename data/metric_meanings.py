"""What every metric of a trial means, and its unit: the one list that codebooks, pages and reports read.

``sim_trials.metrics`` computes the metrics of a lap; the server adds how a guided lap's connection did. A
metric's name ends with its unit, before which a phase may stand: ``force_mean_n``, ``force_mean_edge_n``.
"""

from collections.abc import Mapping
from dataclasses import dataclass

LAP_PHASES = ("approach", "edge", "exit")
"""The parts of a lap that metrics are also given for."""

UNITS: Mapping[str, str] = {
    "m_s3": "m/s3",
    "m_s2": "m/s2",
    "m_s": "m/s",
    "rad_s": "rad/s",
    "deg": "deg",
    "rad": "rad",
    "nm": "N m",
    "ns": "N s",
    "n": "N",
    "m": "m",
    "ms": "ms",
    "s": "s",
    "hz": "Hz",
    "j": "J",
}
"""Units by the end of a metric's name; an ending stands before those that it ends with."""

ONE = "1"
"""Unit of counts and shares."""


@dataclass(frozen=True)
class MetricMeaning:
    """What a number means.

    Attributes
    ----------
    unit : str
        ``1`` for counts and shares; "" where it is not known.
    """

    meaning: str
    unit: str

    @property
    def label(self) -> str:
        """Meaning and unit, as the head of a row of numbers."""
        return self.meaning if self.unit in ("", ONE) else f"{self.meaning} [{self.unit}]"


@dataclass(frozen=True)
class LapMetric:
    """A metric of a whole lap and of each phase: ``stem``, phase and ``ending`` make its name."""

    stem: str
    ending: str
    meaning: str
    unit: str

    def name(self, phase: str = "") -> str:
        """E.g. ``force_mean_n``, or ``force_mean_edge_n`` for a phase."""
        return "_".join(part for part in (self.stem, phase, self.ending) if part)


def _measured(stem: str, ending: str, meaning: str) -> LapMetric:
    return LapMetric(stem, ending, meaning, UNITS[ending])


LAP_METRICS: tuple[LapMetric, ...] = (
    _measured("duration", "s", "time taken"),
    _measured("force_mean", "n", "mean force of the hand while it holds the handle"),
    _measured("force_peak", "n", "largest force of the hand"),
    _measured("speed_mean", "m_s", "mean speed of the cursor while the handle is held"),
    _measured(
        "jerk_rms", "m_s3", "root mean square of the handle's jerk while it is held, low-passed at 5 Hz"
    ),
    _measured("tilt_mean", "deg", "mean tilt of the nozzle while the handle is held"),
    _measured("tilt_peak", "deg", "largest tilt of the nozzle"),
    LapMetric(
        "sigma_min",
        "",
        "smallest singular value of the arm's Jacobian that was met, in SI units: near 0 a direction is lost",
        "SI (m, rad)",
    ),
    _measured("near_singularity", "s", "time with the smallest singular value below 0.05"),
    LapMetric("solid_share", "", "share of the painted path with an opacity above 0.9", ONE),
    LapMetric(
        "gain",
        "",
        "responsiveness: the handle's velocity along the command, over the command (least squares)",
        ONE,
    ),
)
"""The metrics that are split by phase, in the order in which pages show them."""

LONGEST_LOCK = "longest_lock_s"
"""Longest time on end with sigma_min below the study's ``sigma_below`` [s]; for the whole lap alone."""

_OTHERS: Mapping[str, MetricMeaning] = {
    LONGEST_LOCK: MetricMeaning(
        "longest time on end with the smallest singular value below the study's threshold", "s"
    ),
    "lap": MetricMeaning("which lap of this method in the comparison it is, from 1", ONE),
    "ticks": MetricMeaning("control ticks that were computed while the robot was guided", ONE),
    "skipped_ticks": MetricMeaning("control ticks that were left out because the server was late", ONE),
    "latency_samples": MetricMeaning("how often the time from an input to its picture was measured", ONE),
    "latency_median_ms": MetricMeaning(
        "median time from an input of the hand to the picture that shows it", "ms"
    ),
    "latency_p95_ms": MetricMeaning(
        "95 % quantile of the time from an input of the hand to the picture that shows it", "ms"
    ),
    "frame_rate_hz": MetricMeaning("pictures that the page drew a second while the robot was guided", "Hz"),
}


def metric_meanings() -> dict[str, MetricMeaning]:
    """The meaning of every metric that this version of Elbowroom writes, by its name."""
    whole = {metric.name(): MetricMeaning(metric.meaning, metric.unit) for metric in LAP_METRICS}
    split = {
        metric.name(phase): MetricMeaning(f"{metric.meaning}; phase {phase}", metric.unit)
        for phase in LAP_PHASES
        for metric in LAP_METRICS
    }
    return {**whole, **split, **_OTHERS}


def meaning_of(name: str) -> MetricMeaning:
    """The meaning of a metric; of one that this version does not write, only what its name says."""
    known_meaning = metric_meanings().get(name)
    if known_meaning is not None:
        return known_meaning
    return MetricMeaning(f"{name}: not a metric that this version of Elbowroom computes", unit_in(name))


def unit_in(name: str) -> str:
    """The unit that a metric's name ends with, or ""."""
    return next((unit for ending, unit in UNITS.items() if name.endswith(f"_{ending}")), "")
