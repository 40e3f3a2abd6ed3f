"""Tests of many things at once on the same people, right however these things hang together.

Everybody contributes a number to each test. Where a test's null hypothesis holds, a person's contribution is
as likely as its negative, so the signs of whole people are flipped, all tests together: what the largest of
the tests does by chance follows, whatever the tests have to do with each other, and exactly so with few
people.

References
----------
Romano & Wolf 2005, "Exact and approximate stepdown methods for multiple hypothesis testing", JASA 100
(stepping down by the largest of those not yet rejected); Phipson & Smyth 2010, "Permutation p-values should
never be zero" (counting the data among random flips).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
_MOST_ENUMERATED = 12
"""Up to so many people every pattern of signs is gone through: 2,048, as a pattern and its reverse are
one."""
_RANDOM_FLIPS = 3999
_BLOCK = 500
"""Patterns at a time: all of them for 10,000 people would fill the memory."""
_ROUNDING = 1e-9


@dataclass(frozen=True)
class FlippedTests:
    """Two-sided p-values, each of shape (test,).

    Attributes
    ----------
    alone : ndarray
        Of each test by itself.
    in_list : ndarray
        Of each test among all: if those up to a limit are named, then at most with this probability any of
        them is named by chance.
    """

    alone: FloatArray
    in_list: FloatArray


def flipped_tests(contributions: FloatArray, seed: int) -> FlippedTests:
    """Whether people's contributions lie to one side of 0, test by test and in the whole list.

    Parameters
    ----------
    contributions : ndarray, shape (person, test)
        0 where a person contributes nothing.
    """
    active = contributions[contributions.any(axis=1)]
    size = np.sqrt((active**2).sum(axis=0))
    scores = active / np.where(size > 0, size, 1.0)
    observed = np.abs(scores.sum(axis=0))
    order = np.argsort(-observed, kind="stable")
    threshold = observed - _ROUNDING
    alone, stepped = np.zeros(len(order)), np.zeros(len(order))
    patterns = 0
    for signs in _patterns(len(active), seed):
        flipped = np.abs(signs @ scores)
        alone += (flipped >= threshold).sum(axis=0)
        largest_left = np.maximum.accumulate(flipped[:, order[::-1]], axis=1)[:, ::-1]
        stepped += (largest_left >= threshold[order]).sum(axis=0)
        patterns += len(signs)
    in_list = np.empty(len(order))
    in_list[order] = np.maximum.accumulate(stepped / max(patterns, 1))
    return FlippedTests(alone / max(patterns, 1), in_list)


def _patterns(people: int, seed: int) -> Iterator[FloatArray]:
    """Blocks of signs, (pattern, person): all of them, or the observed one and random ones."""
    if people <= _MOST_ENUMERATED:
        number = np.arange(2 ** max(people - 1, 0))
        yield np.where(number[:, None] >> np.arange(people) & 1, -1.0, 1.0)
        return
    rng = np.random.default_rng(seed)
    yield np.ones((1, people))
    for start in range(0, _RANDOM_FLIPS, _BLOCK):
        size = (min(_BLOCK, _RANDOM_FLIPS - start), people)
        yield np.where(rng.integers(0, 2, size), -1.0, 1.0)
