"""How often the robot got stuck under each mode, per comparison and per minute."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.special import betaincinv, betaln, gammaincinv, gammaln

from analysis.results import HDI_PROBABILITY, Quantity
from data.responses import StuckTable

_RATES = (np.arange(600) + 0.5) / 600
_CORRELATIONS = (np.arange(60) + 0.5) / 60
_MEAN_PER_MINUTE = 1.0
"""Mean of the Exponential prior on stuck comparisons a minute [1/min]. Untuned: with more, no task is
left."""


@dataclass(frozen=True)
class StuckRate:
    """Stuck events of one mode.

    Attributes
    ----------
    comparisons : int
        Comparisons that contain the mode.
    stuck : int
        Those of them in which the robot got stuck at least once under this mode.
    rate_mean, rate_hdi_low, rate_hdi_high : float
        Share of comparisons: Beta(1, 1) prior, 94 % HDI; comparisons taken as independent.
    between : Quantity
        Share over a population of participants: each has an own rate, Beta with mean ``m`` and intraclass
        correlation ``r``, both uniform on 0..1; this is the posterior of ``m``.
    exposure_min : float
        Time under the mode [min].
    per_minute_mean, per_minute_hdi_low, per_minute_hdi_high : float
        Comparisons stuck per minute of exposure [1/min], flat prior; nan without exposure. Minutes are taken
        as independent.
    per_minute_between : Quantity or None
        The same over a population of participants: each has an own rate, Gamma with mean ``m`` and squared
        coefficient of variation ``r / (1 - r)``, events are Poisson; m ~ Exponential with a mean of 1 a
        minute (untuned), r uniform on 0..1. None without exposure.
    """

    mode: str
    comparisons: int
    stuck: int
    rate_mean: float
    rate_hdi_low: float
    rate_hdi_high: float
    between: Quantity
    exposure_min: float
    per_minute_mean: float
    per_minute_hdi_low: float
    per_minute_hdi_high: float
    per_minute_between: Quantity | None = None


def stuck_rates(table: StuckTable, modes: tuple[str, ...] | None = None) -> tuple[StuckRate, ...]:
    """Stuck rate of every mode, in the order of ``modes`` (by default sorted by name)."""
    rows = table.rows
    return tuple(
        _rate(mode, rows[rows["mode"] == mode]) for mode in modes or tuple(sorted(rows["mode"].unique()))
    )


def _rate(mode: str, rows: pd.DataFrame) -> StuckRate:
    n, k = len(rows), int(rows["stuck"].sum())
    a, b = 1.0 + k, 1.0 + n - k
    low, high = _shortest(lambda p: betaincinv(a, b, p), falls=k == 0, rises=k == n)
    minutes = float(rows["exposure_s"].sum()) / 60.0
    per_minute = (np.nan, np.nan, np.nan)
    if minutes > 0:
        ends = _shortest(lambda p: gammaincinv(a, p) / minutes, falls=k == 0, rises=False)
        per_minute = (a / minutes, *ends)
    return StuckRate(
        mode,
        n,
        k,
        a / (a + b),
        low,
        high,
        _between_participants(mode, rows),
        minutes,
        *per_minute,
        _between_per_minute(mode, rows) if minutes > 0 else None,
    )


def _shortest(quantile: Callable[[float], float], *, falls: bool, rises: bool) -> tuple[float, float]:
    """Ends of the 94 % HDI of a density with one peak, which may lie at an end."""
    if falls:
        return float(quantile(0.0)), float(quantile(HDI_PROBABILITY))
    if rises:
        return float(quantile(1.0 - HDI_PROBABILITY)), float(quantile(1.0))
    best = minimize_scalar(
        lambda p: quantile(p + HDI_PROBABILITY) - quantile(p),
        bounds=(0.0, 1.0 - HDI_PROBABILITY),
        method="bounded",
        options={"xatol": 1e-10},
    )
    return float(quantile(best.x)), float(quantile(best.x + HDI_PROBABILITY))


def _between_participants(mode: str, rows: pd.DataFrame) -> Quantity:
    """Posterior of the mean rate over participants, by summation over a grid of mean and correlation.

    A Beta with mean m and intraclass correlation r has a + b = 1/r - 1.
    """
    by_person = rows.groupby("participant")["stuck"].agg(["sum", "count"]).to_numpy(dtype=np.int64)
    kinds, people = np.unique(by_person, axis=0, return_counts=True)
    total = (1.0 / _CORRELATIONS - 1.0)[None, :]
    a, b = _RATES[:, None] * total, (1.0 - _RATES[:, None]) * total
    log_p = np.zeros_like(a)
    for (k, n), alike in zip(kinds, people, strict=True):
        log_p += alike * (betaln(a + k, b + n - k) - betaln(a, b))
    weight = np.exp(log_p - log_p.max()).sum(axis=1)
    weight /= weight.sum()
    mean = float(weight @ _RATES)
    low, high = _grid_hdi(weight, 1.0)
    return Quantity(f"stuck_rate_{mode}", mean, float(np.sqrt(weight @ (_RATES - mean) ** 2)), low, high)


def _between_per_minute(mode: str, rows: pd.DataFrame) -> Quantity:
    """Posterior of the mean rate a minute over participants, by summation over a grid of mean and spread.

    A person's events are then negative binomial: a Gamma with mean m and squared coefficient of variation c
    has shape 1/c and rate 1/(c m).
    """
    by_person = rows.groupby("participant").agg(k=("stuck", "sum"), s=("exposure_s", "sum"))
    events, minutes = by_person["k"].to_numpy(float), by_person["s"].to_numpy(float) / 60.0
    # Up to where no posterior of so few events in so much time reaches.
    most = min(12.0 * _MEAN_PER_MINUTE, 15.0 * (events.sum() + 1.0) / minutes.sum())
    m = (_RATES * most)[:, None]
    c = (_CORRELATIONS / (1.0 - _CORRELATIONS))[None, :]
    log_p = -m / _MEAN_PER_MINUTE + np.zeros_like(c)
    for k, t in zip(events, minutes, strict=True):
        log_p = (
            log_p + gammaln(k + 1 / c) - gammaln(1 / c) + k * np.log(c) - (k + 1 / c) * np.log1p(c * m * t)
        )
        if k:
            log_p = log_p + k * np.log(m * t)
    weight = np.exp(log_p - log_p.max()).sum(axis=1)
    weight /= weight.sum()
    rates = _RATES * most
    mean = float(weight @ rates)
    low, high = _grid_hdi(weight, most)
    return Quantity(f"stuck_per_minute_{mode}", mean, float(np.sqrt(weight @ (rates - mean) ** 2)), low, high)


def _grid_hdi(weight: NDArray[np.float64], most: float) -> tuple[float, float]:
    """The shortest interval on the grid of rates from 0 to ``most`` with 94 % of the weight."""
    edges = np.linspace(0.0, most, len(weight) + 1)
    mass = np.concatenate([[0.0], np.cumsum(weight)])
    ends = np.interp(mass + HDI_PROBABILITY, mass, edges, right=np.nan)
    first = int(np.nanargmin(ends - edges))
    return float(edges[first]), float(ends[first])
