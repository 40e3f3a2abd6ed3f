"""How often people who toss coins agree as much as these do: the exact distribution behind Kendall's u.

Of ``d`` people who decided a pair, ``s`` more (or fewer) put one mode above the other. The number of
agreements rises with ``sum(s^2)`` over the pairs. Under coin tosses ``(d + s) / 2`` is Binomial(d, 1/2) for
each pair, independently, so that the distribution of the sum follows by convolution over the pairs.

References
----------
Kendall & Babington Smith 1940, "On the method of paired comparisons", Biometrika 31 (the same
distribution for people who decide every pair, and its approximation by three moments).
"""

from functools import lru_cache
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy.stats import gamma

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]

MOST_STEPS = 20_000_000
"""Additions up to which the chance is exact, some 20 ms: 300 people who decide three pairs all alike. Beyond,
a gamma distribution with the same three moments takes its place."""


def agreement_chance(lead: IntArray, decided: IntArray) -> float:
    """Chance that coin tosses agree at least as much; nan if nobody decided anything.

    Parameters
    ----------
    lead : ndarray of int, shape (pair,)
        How many more people put one mode above the other than the reverse.
    decided : ndarray of int, shape (pair,)
        How many people decided the pair; ties stay ties in every set of tosses.
    """
    if not decided.any():
        return float("nan")
    # Squares of numbers of one parity differ by multiples of 4.
    reached = int(((lead**2 - decided % 2) // 4).sum())
    if int((decided // 2 + 1).sum()) * max(reached, 1) > MOST_STEPS:
        return _by_three_moments(int((lead**2).sum()), decided.astype(np.float64))
    return _by_convolution(reached, decided)


def _by_convolution(reached: int, decided: IntArray) -> float:
    """Chance of at least ``reached``; sums that have reached it are only counted: they never fall."""
    below = np.zeros(reached)
    above = 1.0
    if reached:
        below[0], above = 1.0, 0.0
    for d in decided:
        moved = np.zeros_like(below)
        for step, chance in zip(*_steps(int(d)), strict=True):
            kept = max(reached - int(step), 0)
            above += chance * float(below[kept:].sum())
            moved[reached - kept :] += chance * below[:kept]
        below = moved
    return min(above, 1.0)


@lru_cache(maxsize=256)
def _steps(d: int) -> tuple[IntArray, FloatArray]:
    """``(s^2 - d mod 2) / 4`` for each possible lead, and its chance."""
    lead = np.arange(d % 2, d + 1, 2)
    # Whole numbers over a power of 2: no digit is lost in a small study.
    chance = np.array([comb(d, (d + int(s)) // 2) / 2**d for s in lead])
    return (lead**2 - d % 2) // 4, chance * np.where(lead > 0, 2.0, 1.0)


def _by_three_moments(squares: int, d: FloatArray) -> float:
    """Upper tail of the gamma distribution with the mean, variance and skewness of ``sum(s^2)``."""
    mean, variance = d.sum(), (2 * d * (d - 1)).sum()
    third = (8 * d * (d - 1) * (d - 2)).sum()
    shape, scale = 4 * variance**3 / third**2, third / (2 * variance)
    return float(gamma.sf(squares - mean + shape * scale, shape, scale=scale))
