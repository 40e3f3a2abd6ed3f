"""How often something happens under one mode: a rate a minute that differs between people.

A comparison counts once, however often it happened in it. So with ``t`` minutes under the mode

    P(at least one event) = 1 - exp(-rate_s t),    log rate_s ~ Normal(log rate, spread)

for person s. ``rate`` is that of the median person: half of people have a higher rate, half a lower one. The
share of a new person's comparisons in which it happens is the mean of 1 - exp(-rate_s t) over people.

Nothing is sampled. A person's likelihood is tabulated over the logarithm of the person's own rate, which
makes the likelihood of ``rate`` and ``spread`` a product of sums over that table. Trapezoidal sums over
smooth functions that vanish at both ends converge faster than any power of the step (Trefethen & Weideman
2014).

References
----------
Trefethen, Weideman 2014, "The exponentially convergent trapezoidal rule", SIAM Review 56.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from analysis.event_likelihood import (
    TINY,
    BoolArray,
    Exposures,
    FloatArray,
    kinds_of_people,
    log_likelihood_alike,
    log_likelihood_over_people,
)
from analysis.tabulated import Tabulated

_LogLikelihood = Callable[[FloatArray, FloatArray], FloatArray]
"""Log rates and spreads to log likelihoods, shape (rates, spreads)."""

MEDIAN_RATE = 0.2
"""Prior median of the median person's rate [1/min]: once in five minutes. Untuned."""
LOG_RATE_SD = 2.0
"""Prior standard deviation of its logarithm: 94 % lie between once in three and a half hours and nine a
minute. Narrower priors pull modes up that never have an event (analysis/README.md)."""
SPREAD_SCALE = 1.5
"""Of the half-normal prior on the standard deviation of people's log rates: at its median, 1.0, 94 % of
people have rates within 6.7 times the median person's either way. Untuned."""
UNKNOWN_MIN = 2.0
"""Time that a comparison of unknown length is taken to have under a mode, where none is known [min]: as in a
study like that of 2017. It only sets what the prior says of the share of comparisons."""

_FINE = 3000
"""Points of a table of a distribution function."""
_REACH = 9.0
"""Prior standard deviations that the first grid reaches."""
_COARSE = (32, 8)
"""Rates and spreads of the grids that look for where the posterior is."""
_ZOOMS = 20
_MOSTLY = 0.5
"""Share of the rows, and of the columns, that a coarse grid sees the density at before a fine one follows."""


@dataclass(frozen=True)
class Resolution:
    """How finely and how far the posterior is tabulated.

    Attributes
    ----------
    rates, spreads : int
        Points over the log rate and over the spread, within what holds the posterior.
    drop : float
        Points are kept down to this much below the highest log density.
    """

    rates: int = 96
    spreads: int = 20
    drop: float = 28.0


USUAL = Resolution()


@dataclass(frozen=True)
class RatePosterior:
    """Posterior of the median person's rate and of how much people differ.

    Attributes
    ----------
    log_rate : ndarray, shape (rates,)
        Logarithm of the rate [1/min], evenly spaced.
    spread : ndarray, shape (spreads,)
        Standard deviation of people's log rates; a single 0 where people do not differ.
    log_density : ndarray, shape (rates, spreads)
        But for a constant.
    """

    log_rate: FloatArray
    spread: FloatArray
    log_density: FloatArray

    def rate(self) -> Tabulated:
        """The median person's rate [1/min]."""
        weight = np.exp(self.log_density - self.log_density.max()).sum(axis=1)
        values = np.exp(self.log_rate)
        mean, sd = _moments(values, weight)
        fine, cdf = _cumulative(self.log_rate, np.log(weight + TINY)[:, None])
        return Tabulated(np.exp(fine), cdf[:, 0] / cdf[-1, 0], mean, sd)

    def share(self, minutes: float) -> Tabulated:
        """The share of a new person's comparisons of this length in which it happens."""
        weight = np.exp(self.log_density - self.log_density.max())
        hazard = _hazard(self.log_rate, self.spread, minutes)
        mean, sd = _moments(-np.expm1(-hazard), weight)
        fine, cdf = _cumulative(self.log_rate, self.log_density)
        # Shares are tabulated by the logarithm of -log(1 - share), which resolves those near 0 and near 1.
        scale = CubicSpline(self.log_rate, np.log(hazard), axis=0)(fine)
        common = np.linspace(scale.min(), scale.max(), 2 * _FINE)
        total = np.zeros_like(common)
        for k in range(len(self.spread)):
            total += np.interp(common, scale[:, k], cdf[:, k], left=0.0, right=cdf[-1, k])
        values = -np.expm1(-np.exp(common))
        # Of shares that are the same number, 1, the last has all the probability.
        rises = np.concatenate([np.diff(values) > 0, [True]])
        return Tabulated(values[rises], total[rises] / total[-1], mean, sd)


def rate_over_people(data: Exposures, resolution: Resolution = USUAL) -> RatePosterior:
    """Posterior where each person has a rate of their own: it speaks of people in general."""
    kinds = kinds_of_people(data)
    return _zoomed(
        lambda log_rate, spread: log_likelihood_over_people(kinds, log_rate, spread), resolution, differ=True
    )


def rate_of_comparisons(data: Exposures, resolution: Resolution = USUAL) -> RatePosterior:
    """Posterior where all people have one rate, so that comparisons are independent."""
    everyone = kinds_of_people(Exposures(np.zeros_like(data.person), data.has_event, data.minutes))
    return _zoomed(lambda log_rate, _: log_likelihood_alike(everyone, log_rate), resolution, differ=False)


def exposures(
    people: NDArray[np.object_], has_event: BoolArray, minutes: FloatArray
) -> tuple[Exposures, float]:
    """Comparisons with one mode, and the usual length of one [min].

    A length that is not known takes the median of the known ones, or `UNKNOWN_MIN` if none is.
    """
    known = minutes[minutes > 0]
    usual = float(np.median(known)) if len(known) else UNKNOWN_MIN
    _, person = np.unique(people.astype(str), return_inverse=True)
    filled = np.where(minutes > 0, minutes, usual)
    return Exposures(person.astype(np.int64), has_event.astype(np.bool_), filled), usual


def _zoomed(log_likelihood: _LogLikelihood, resolution: Resolution, *, differ: bool) -> RatePosterior:
    """The posterior on a grid that ends where the density has dropped out of sight on each side.

    It begins with a coarse grid over all that the prior allows. Each next one ends a step beyond the points
    that the density is seen at, until most points are such points; the last one is fine.
    """
    middle, reach = float(np.log(MEDIAN_RATE)), LOG_RATE_SD * _REACH
    ends = _Ends(middle - reach, middle + reach, 0.0, SPREAD_SCALE * _REACH)
    for _ in range(_ZOOMS):
        log_rate, spread = ends.grid(*_COARSE, differ)
        log_density = log_likelihood(log_rate, spread) + _log_prior(log_rate, spread)
        is_seen = log_density > log_density.max() - resolution.drop
        rows, columns = (np.flatnonzero(is_seen.any(axis=axis)) for axis in (1, 0))
        step = float(log_rate[1] - log_rate[0])
        cell = (ends.spread_high - ends.spread_low) / len(spread)
        ends = _Ends(
            float(log_rate[rows[0]]) - step,
            float(log_rate[rows[-1]]) + step,
            max(0.0, float(spread[columns[0]]) - 1.5 * cell),
            float(spread[columns[-1]]) + 1.5 * cell,
        )
        if min(len(rows) / len(log_rate), len(columns) / len(spread)) >= _MOSTLY:
            break
    log_rate, spread = ends.grid(resolution.rates, resolution.spreads, differ)
    return RatePosterior(log_rate, spread, log_likelihood(log_rate, spread) + _log_prior(log_rate, spread))


@dataclass(frozen=True)
class _Ends:
    """How far a grid reaches over the log rate and over the spread."""

    rate_low: float
    rate_high: float
    spread_low: float
    spread_high: float

    def grid(self, rates: int, spreads: int, differ: bool) -> tuple[FloatArray, FloatArray]:
        """Log rates, and the middles of cells of the spread; a spread of 0 where people do not differ.

        From 0 on, the density over the spread is half of a function of the spread squared that vanishes at
        both ends, so that sums over the middles of cells are as good as those over the rate.
        """
        edges = np.linspace(self.spread_low, self.spread_high, spreads + 1)
        spread = (edges[1:] + edges[:-1]) / 2 if differ else np.zeros(1)
        return np.linspace(self.rate_low, self.rate_high, rates), spread


def _log_prior(log_rate: FloatArray, spread: FloatArray) -> FloatArray:
    of_rate = -0.5 * ((log_rate - np.log(MEDIAN_RATE)) / LOG_RATE_SD) ** 2
    return np.asarray(of_rate[:, None] - 0.5 * (spread / SPREAD_SCALE) ** 2)


def _hazard(log_rate: FloatArray, spread: FloatArray, minutes: float) -> FloatArray:
    """-log(1 - share of comparisons with an event) over people; shape (rates, spreads)."""
    z = np.linspace(-8.0, 8.0, 81)
    weight = np.exp(-0.5 * z**2)
    rate = np.exp(log_rate[:, None, None] + spread[None, :, None] * z)
    weight /= weight.sum()
    share, rest = -np.expm1(-rate * minutes) @ weight, np.exp(-rate * minutes) @ weight
    return np.asarray(np.where(share < 0.5, -np.log1p(-np.minimum(share, 0.5)), -np.log(rest + TINY)))


def _moments(values: FloatArray, weight: FloatArray) -> tuple[float, float]:
    mean = float((values * weight).sum() / weight.sum())
    return mean, float(np.sqrt(((values - mean) ** 2 * weight).sum() / weight.sum()))


def _cumulative(log_rate: FloatArray, log_density: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Finer log rates, and the integral of every column up to each of them; all columns on one scale."""
    fine = np.linspace(log_rate[0], log_rate[-1], _FINE)
    density = np.exp(CubicSpline(log_rate, log_density, axis=0)(fine) - log_density.max())
    inner = np.cumsum((density[1:] + density[:-1]) / 2, axis=0)
    return fine, np.concatenate([np.zeros((1, log_density.shape[1])), inner])
