"""The likelihood of events in comparisons: of everybody, whose own rates follow a log-normal distribution.

A person's likelihood is tabulated over the logarithm of the person's own rate. Summed over people's own
rates it is a product with a table of normal densities, one row for every rate and spread.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

TINY = 1e-300
"""Keeps the logarithm of a probability that has underflowed finite."""
_KERNEL_SDS = 8.5
_STEPS_PER_SD = 1.3
_FEW_LENGTHS = 16
"""So many different lengths of comparisons, at most, make it worthwhile to look for people who are alike."""


@dataclass(frozen=True)
class Exposures:
    """Comparisons with one mode.

    Attributes
    ----------
    person : ndarray of int64, shape (comparison,)
        From 0, without gaps.
    has_event : ndarray of bool, shape (comparison,)
    minutes : ndarray, shape (comparison,)
        Time under the mode [min], above 0.
    """

    person: IntArray
    has_event: BoolArray
    minutes: FloatArray


@dataclass(frozen=True)
class KindsOfPeople:
    """People whose comparisons are alike in length and outcome, counted.

    Attributes
    ----------
    people : ndarray, shape (kind,)
        How many there are of each.
    idle : ndarray, shape (kind,)
        Minutes of comparisons without an event.
    owner : ndarray of int64, shape (lengths,)
        The kind that a length belongs to, sorted.
    length, times : ndarray, shape (lengths,)
        Minutes of a comparison with an event, and how many of them a person has.
    most : int
        Comparisons of whoever has most of them.
    longest, shortest : float
        Minutes of whoever has most of them, and of the shortest comparison.
    """

    people: FloatArray
    idle: FloatArray
    owner: IntArray
    length: FloatArray
    times: FloatArray
    most: int
    longest: float
    shortest: float


def kinds_of_people(data: Exposures) -> KindsOfPeople:
    """Everybody, those who are alike taken together where comparisons have few different lengths."""
    n = int(data.person.max()) + 1
    lengths, which = np.unique(data.minutes, return_inverse=True)
    people: FloatArray = np.ones(n)
    if len(lengths) <= _FEW_LENGTHS:
        table = np.zeros((n, 2 * len(lengths)), dtype=np.int64)
        np.add.at(table, (data.person, 2 * which + data.has_event), 1)
        table, alike = np.unique(table, axis=0, return_counts=True)
        people = alike.astype(np.float64)
        idle = np.asarray(table[:, ::2] @ lengths, dtype=np.float64)
        owner, column = np.nonzero(table[:, 1::2])
        length, times = lengths[column], table[:, 1::2][owner, column].astype(np.float64)
    else:
        idle = _sums(data.person, data.minutes * ~data.has_event)
        order = np.argsort(data.person[data.has_event], kind="stable")
        owner, length = data.person[data.has_event][order], data.minutes[data.has_event][order]
        times = np.ones(len(owner))
    return KindsOfPeople(
        people=people,
        idle=idle,
        owner=owner.astype(np.int64),
        length=length,
        times=times,
        most=int(np.bincount(data.person).max()),
        longest=float(_sums(data.person, data.minutes).max()),
        shortest=float(data.minutes.min()),
    )


def _sums(person: IntArray, values: FloatArray) -> FloatArray:
    """The sum of the values of each person."""
    return np.asarray(np.bincount(person, weights=values), dtype=np.float64)


def log_likelihood_over_people(kinds: KindsOfPeople, log_rate: FloatArray, spread: FloatArray) -> FloatArray:
    """Of all people at every rate and spread, own rates summed over; shape (rates, spreads)."""
    # Below the first no comparison has an event, above the second every one has.
    none, every = np.log(1e-9 / kinds.longest), np.log(1e3 / kinds.shortest)
    low = max(none, log_rate[0] - _KERNEL_SDS * spread[-1])
    high = min(every, log_rate[-1] + _KERNEL_SDS * spread[-1])
    step = min(spread[0], 1.0 / np.sqrt(kinds.most)) / _STEPS_PER_SD
    own = np.linspace(low, high, max(8, int(np.ceil((high - low) / step)) + 1))
    z = (own - log_rate[:, None, None]) / spread[None, :, None]
    kernel = np.exp(-0.5 * z**2)
    # What lies beyond the ends of the table is as at its ends.
    half = (own[1] - own[0]) / 2
    for end, sign in ((0, 1.0), (-1, -1.0)):
        beyond = log_ndtr(sign * (own[end] + sign * half - log_rate[:, None]) / spread)
        kernel[:, :, end] = np.exp(beyond) * np.sqrt(2 * np.pi) * spread / (2 * half)
    kernel /= kernel.sum(axis=2, keepdims=True)
    each = _each(kinds, own)
    highest = each.max(axis=0)
    summed = kernel.reshape(-1, len(own)) @ np.exp(each - highest)
    log_p = (np.log(summed + TINY) + highest) @ kinds.people
    return np.asarray(log_p.reshape(len(log_rate), len(spread)))


def log_likelihood_alike(kinds: KindsOfPeople, log_rate: FloatArray) -> FloatArray:
    """Log likelihood of everybody with the same rate; shape (rates, 1)."""
    return np.asarray((_each(kinds, log_rate) @ kinds.people)[:, None])


def _each(kinds: KindsOfPeople, own: FloatArray) -> FloatArray:
    """Log likelihood of a person of each kind at own log rates; shape (rates, kind)."""
    rate = np.exp(own)[:, None]
    log_p = -rate * kinds.idle
    if len(kinds.owner):
        terms = np.log(-np.expm1(-rate * kinds.length)) * kinds.times
        first = np.flatnonzero(np.diff(kinds.owner, prepend=-1))
        log_p[:, kinds.owner[first]] += np.add.reduceat(terms, first, axis=1)
    return np.asarray(log_p)
