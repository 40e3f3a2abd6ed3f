"""What was measured of each mode: its metrics over people, with intervals that hold for few people.

People are a level of their own: a person's laps under a mode count as one value, the person's mean, and the
interval is that of a mode's mean over people who are a sample. Student's t interval, which is also the
posterior under flat priors on the mean and on the log of the sd over people, is exact for normal values
however few people there are. Metrics that are positive by definition are taken on the log scale, where they
are far less skewed: their mean is the geometric one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, nan, sqrt
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import stdtrit

from analysis.results import HDI_PROBABILITY
from data.responses import MetricTable

FloatArray = NDArray[np.float64]
MeanKind = Literal["arithmetic", "geometric"]
FEWEST_PEOPLE = 3
"""For an interval: with two, a 94 % t interval reaches 5.3 times their distance to either side, and says
nothing."""


@dataclass(frozen=True)
class Measure:
    """A metric that the report sets beside the worths.

    Attributes
    ----------
    name, words, unit : str
        The name in the data, the name in words, and the unit.
    more, less : str
        What laps with a larger and with a smaller value have, in words.
    mean : {"arithmetic", "geometric"}
        Geometric for what cannot be negative.
    """

    name: str
    words: str
    unit: str
    more: str
    less: str
    mean: MeanKind = "geometric"

    def compared(self, sign: float) -> str:
        """More or less of it, in words."""
        return self.more if sign > 0 else self.less


MEASURES: tuple[Measure, ...] = (
    Measure(
        "force_mean_edge_n",
        "force at the edge",
        "N",
        more="more force at the edge",
        less="less force at the edge",
    ),
    Measure(
        "gain_exit",
        "responsiveness leaving the edge",
        "",
        more="more responsiveness leaving the edge",
        less="less responsiveness leaving the edge",
        mean="arithmetic",
    ),
    Measure("jerk_rms_m_s3", "jerk", "m/s³", more="more jerk", less="less jerk"),
    Measure("longest_lock_s", "longest time locked", "s", more="longer locks", less="shorter locks"),
    Measure("duration_s", "time a lap", "s", more="longer laps", less="shorter laps"),
)
"""What the study of 2017 asked for: force, smoothness and being stuck, and responsiveness and time beside
them."""


@dataclass(frozen=True)
class ModeMeasure:
    """One metric of one mode over participants, each with the mean of their own laps.

    Attributes
    ----------
    mean : float
        Over the participants above 0 where it is geometric; 0 where all are 0.
    mean_kind : {"arithmetic", "geometric"}
    low, high : float
        94 % interval; NaN with fewer than three participants, or if all have the same value.
    participants : int
        Whose values the mean is made of.
    zeros : int
        Participants at 0, whom a geometric mean leaves out: the robot never locked with them.
    """

    metric: str
    mode: str
    mean: float
    mean_kind: MeanKind
    low: float
    high: float
    participants: int
    zeros: int

    @property
    def is_geometric(self) -> bool:
        """Whether the mean and its interval are on the log scale."""
        return self.mean_kind == "geometric"


def measures_in(metrics: MetricTable) -> tuple[Measure, ...]:
    """The report's measures that were taken here."""
    rows = metrics.rows
    return tuple(m for m in MEASURES if m.name in rows and rows[m.name].notna().any())


def mode_measures(metrics: MetricTable, modes: Sequence[str]) -> tuple[ModeMeasure, ...]:
    """Every measure of every mode that has it."""
    measured = []
    for measure in measures_in(metrics):
        own = _own_means(metrics, measure.name)
        kind: MeanKind = "arithmetic" if (own < 0).any(axis=None) else measure.mean
        for mode in modes:
            values = own[mode].dropna().to_numpy(float) if mode in own else np.empty(0)
            if values.size:
                measured.append(_mode_measure(measure.name, mode, kind, values))
    return tuple(measured)


def mode_means(metrics: MetricTable, name: str, modes: Sequence[str]) -> FloatArray:
    """Each mode's arithmetic mean over participants of their own means, NaN where none has it: ndarray,
    shape (mode,)."""
    return np.asarray(_own_means(metrics, name).mean().reindex(list(modes)), dtype=float)


def mean_interval(values: FloatArray) -> tuple[float, float]:
    """Student's 94 % interval of the mean of people's values; NaN where these do not give one.

    Parameters
    ----------
    values : ndarray, shape (person,)
    """
    n = len(values)
    if n < FEWEST_PEOPLE or np.ptp(values) <= 1e-12 * np.abs(values).max():
        return nan, nan
    half = stdtrit(n - 1, (1 + HDI_PROBABILITY) / 2) * values.std(ddof=1) / sqrt(n)
    return float(values.mean() - half), float(values.mean() + half)


def _mode_measure(metric: str, mode: str, kind: MeanKind, values: FloatArray) -> ModeMeasure:
    if kind == "arithmetic":
        low, high = mean_interval(values)
        return ModeMeasure(metric, mode, float(values.mean()), kind, low, high, len(values), 0)
    logs = np.log(values[values > 0])
    zeros = len(values) - len(logs)
    if not logs.size:
        return ModeMeasure(metric, mode, 0.0, kind, nan, nan, 0, zeros)
    low, high = mean_interval(logs)
    return ModeMeasure(metric, mode, exp(logs.mean()), kind, exp(low), exp(high), len(logs), zeros)


def _own_means(metrics: MetricTable, name: str) -> pd.DataFrame:
    """Each participant's mean of a metric: a row a participant, a column a mode."""
    return metrics.rows.groupby(["participant", "mode"], sort=False)[name].mean().unstack("mode")
