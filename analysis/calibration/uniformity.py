"""Are ranks uniform? Coverage of central intervals, and the ECDF with exact simultaneous bands.

The rank of a true value among L draws of a calibrated posterior is uniform on 0 .. L (Talts et al. 2018;
Cook, Gelman, Rubin 2006). All probabilities below are exact for that discrete distribution: nothing is
simulated and no limit theorem is used.

References
----------
Säilynoja, Bürkner, Vehtari 2022, "Graphical test for discrete uniformity and its applications in
goodness-of-fit evaluation and multiple sample comparison", Statistics and Computing 32: the simultaneous
band of the ECDF as a binomial band of adjusted pointwise level, and its probability by recursion.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln
from scipy.stats import binom, chi2

DRAWS_RANKED = 99
"""Draws a true value is ranked among: of 100 ranks each interval below holds exactly its level."""
LEVELS = (0.5, 0.8, 0.9, 0.94)
"""Central intervals whose coverage is counted; 94 % is that of the report."""
FALSE_ALARM = 0.01
"""Probability, at most, that a calibrated engine fails any of all checks. Half goes to the coverages and half
to the ECDFs, each divided by the number of checks (Bonferroni)."""
_BINS = 20

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Coverage:
    """How often the central interval of one level held the truth.

    Attributes
    ----------
    band_low, band_high : float
        A calibrated engine's share lies within, but for its part of `FALSE_ALARM`.
    """

    parameter: str
    level: float
    coverage: float
    band_low: float
    band_high: float

    @property
    def inside(self) -> bool:
        """True if the share lies in the band, its edges included."""
        return self.band_low <= self.coverage <= self.band_high


@dataclass(frozen=True)
class Uniformity:
    """One quantity's ranks against the uniform distribution.

    Attributes
    ----------
    largest_difference : float
        Of the ECDF from the uniform one, with its sign.
    p_value : float
        Chance that a uniform sample leaves, anywhere, a band as wide as this one needs; exact.
    chi2_p_value : float
        Of 20 bins; side information.
    mean_rank : float
        As a share of the highest rank: 0.5 if the posterior is neither too high nor too low.
    """

    parameter: str
    largest_difference: float
    p_value: float
    limit: float
    chi2_p_value: float
    mean_rank: float

    @property
    def inside(self) -> bool:
        """True if the ECDF stays within its simultaneous band."""
        return self.p_value > self.limit


@dataclass(frozen=True)
class Band:
    """Where the ECDF of uniform ranks may run.

    Attributes
    ----------
    at : ndarray, shape (points,)
        Share of the ranks counted: ``k / 100`` for k = 1 .. 99.
    low, high : ndarray, shape (points,)
        Of the ECDF, edges included.
    """

    at: FloatArray
    low: FloatArray
    high: FloatArray


def rank_of(truth: float, draws: FloatArray, rng: np.random.Generator) -> int:
    """How many of `DRAWS_RANKED` draws, evenly spaced over all chains, lie below the truth.

    Between draws that equal the truth (worths that underflow) the place is drawn.
    """
    spaced = draws[thinned(len(draws))]
    below, equal = int((spaced < truth).sum()), int((spaced == truth).sum())
    return below + (int(rng.integers(equal + 1)) if equal else 0)


def thinned(n: int) -> IntArray:
    """Places of `DRAWS_RANKED` evenly spaced draws among ``n``."""
    return np.floor((np.arange(DRAWS_RANKED) + 0.5) * n / DRAWS_RANKED).astype(np.int64)


def coverages(ranks: dict[str, IntArray]) -> tuple[Coverage, ...]:
    """Coverage of every level for every quantity; the bands know how many there are.

    Parameters
    ----------
    ranks : dict of str to ndarray, shape (replicate,)
        Each from 0 to `DRAWS_RANKED`.
    """
    tail = FALSE_ALARM / 2 / (len(ranks) * len(LEVELS)) / 2
    found = []
    for name, values in ranks.items():
        n = len(values)
        for level in LEVELS:
            inside = int(is_inside(values, level).sum())
            low, high = binom.ppf(tail, n, level), binom.isf(tail, n, level)
            found.append(Coverage(name, level, inside / n, float(low) / n, float(high) / n))
    return tuple(found)


def is_inside(ranks: IntArray, level: float) -> NDArray[np.bool_]:
    """Whether each true value lies in the central interval of so much of the draws."""
    left_out = round((DRAWS_RANKED + 1) * (1.0 - level) / 2.0)
    return (ranks >= left_out) & (ranks <= DRAWS_RANKED - left_out)


def uniformities(ranks: dict[str, IntArray]) -> tuple[Uniformity, ...]:
    """Every quantity's ECDF against its simultaneous band."""
    limit = ecdf_limit(len(ranks))
    return tuple(_uniformity(name, values, limit) for name, values in ranks.items())


def ecdf_limit(checks: int) -> float:
    """The p-value down to which one of so many ECDFs counts as uniform."""
    return FALSE_ALARM / 2 / checks


def ecdf(ranks: IntArray) -> FloatArray:
    """Share of the ranks below k for k = 1 .. `DRAWS_RANKED`, the points of a `Band`."""
    counts = np.bincount(ranks, minlength=DRAWS_RANKED + 1)
    return np.cumsum(counts)[:-1] / len(ranks)


def ecdf_band(n: int, false_alarm: float) -> Band:
    """The band that ``n`` uniform ranks leave with at most this probability."""
    low, high = np.log(false_alarm / (DRAWS_RANKED + 1)), np.log(false_alarm)
    for _ in range(20):
        middle = (low + high) / 2
        if leaving_probability(n, float(np.exp(middle))) > false_alarm:
            high = middle
        else:
            low = middle
    at = _points()
    least, most = _pointwise(n, float(np.exp(low)))
    return Band(at, least / n, most / n)


def leaving_probability(n: int, pointwise: float) -> float:
    """Chance that the ECDF of ``n`` uniform ranks leaves its pointwise bands of this level anywhere.

    Given r ranks below one point, those below the next are r plus a binomial number of the remaining; the
    recursion carries the probability of every r with a history inside the bands (Säilynoja et al. 2022).
    """
    at, (least, most) = _points(), _pointwise(n, pointwise)
    here, weight, before = np.zeros(1), np.ones(1), 0.0
    for z, low, high in zip(at, least, most, strict=True):
        there = np.arange(low, high + 1.0)
        step = (z - before) / (1.0 - before)
        new, left = there[None, :] - here[:, None], n - here[:, None]
        with np.errstate(invalid="ignore"):
            log_p = (
                gammaln(left + 1)
                - gammaln(np.maximum(new, 0) + 1)
                - gammaln(np.maximum(left - new, 0) + 1)
                + new * np.log(step)
                + (left - new) * np.log1p(-step)
            )
        weight = weight @ np.where((new >= 0) & (new <= left), np.exp(np.minimum(log_p, 0.0)), 0.0)
        here, before = there, z
    return float(min(max(1.0 - weight.sum(), 0.0), 1.0))


def _uniformity(name: str, ranks: IntArray, limit: float) -> Uniformity:
    n, at = len(ranks), _points()
    share = ecdf(ranks)
    below = np.rint(share * n)
    tails = np.minimum(binom.cdf(below, n, at), binom.sf(below - 1, n, at))
    # A hair wider, so that a band that just holds the observed ECDF counts as left by it.
    needed = min(2.0 * float(tails.min()) * (1.0 + 1e-9), 1.0)
    difference = share - at
    bins = np.bincount(ranks * _BINS // (DRAWS_RANKED + 1), minlength=_BINS)
    statistic = float(((bins - n / _BINS) ** 2).sum() / (n / _BINS))
    return Uniformity(
        name,
        float(difference[np.abs(difference).argmax()]),
        leaving_probability(n, needed),
        limit,
        float(chi2.sf(statistic, _BINS - 1)),
        float(ranks.mean() / DRAWS_RANKED),
    )


def _points() -> FloatArray:
    return np.arange(1, DRAWS_RANKED + 1) / (DRAWS_RANKED + 1)


def _pointwise(n: int, level: float) -> tuple[FloatArray, FloatArray]:
    """Fewest and most ranks below each point whose tail, either way, exceeds half the level."""
    at = _points()
    return binom.ppf(level / 2, n, at), binom.isf(level / 2, n, at)
