"""Two modes' stuck rates against each other: of these people, and of people in general.

Of these people and comparisons speak posteriors and exact tests that take comparisons as independent. Of
people in general speak only those that count people: the posterior over people, and the test by people.

References
----------
Fisher 1935 (exact test of a two by two table); Mehta, Patel, Gray 1985, "Computing an exact confidence
interval for the common odds ratio in several 2 x 2 contingency tables" (the convolution over strata);
Basu 1980, "Randomization analysis of experimental data: the Fisher randomization test" (exchanging what
belongs to either treatment within a pair, here a person).
"""

from dataclasses import dataclass
from math import lcm

import numpy as np
from numpy.typing import NDArray
from scipy.special import betainc, betaincinv, gammaln

from analysis.stuck import StuckRate
from data.responses import StuckTable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_EQUALLY_LIKELY = (np.arange(4000) + 0.5) / 4000
_MOST_STEPS = 20_000
"""Steps, at most, that the sum of people's differences is counted in."""


@dataclass(frozen=True)
class StuckContrast:
    """Two modes' stuck rates.

    Attributes
    ----------
    p_i_above_j : float
        These people and comparisons: posterior probability that mode i's share of stuck comparisons is
        higher, under independent Beta posteriors.
    p_fisher : float
        These people and comparisons: two-sided exact test of equal rates (Fisher), comparisons taken as
        independent.
    p_within_people : float
        These people and comparisons: the same within participants, given how often each of them got stuck
        under either mode, so that people who get stuck more often than others cannot make a difference
        between modes. Comparisons of one person under one mode are taken as independent.
    p_i_above_j_people : float
        People in general: posterior probability that the share of a new person's comparisons that get stuck
        is higher under mode i, each share at its mode's usual exposure. Modes are modelled apart. Nan if
        participants are not known.
    p_by_people : float
        People in general: two-sided exact test that exchanges the modes within people, `p_exchanged`. Nan
        if participants are not known.
    people_i_higher, people_j_higher : int
        Participants with the higher share under mode i, and under mode j.
    """

    mode_i: str
    mode_j: str
    p_i_above_j: float
    p_fisher: float
    p_within_people: float
    p_i_above_j_people: float
    p_by_people: float
    people_i_higher: int
    people_j_higher: int


def stuck_contrasts(table: StuckTable, rates: tuple[StuckRate, ...]) -> tuple[StuckContrast, ...]:
    """Every pair of modes that both took part in a comparison."""
    tried = [rate for rate in rates if rate.comparisons]
    rows = table.rows
    by_person = rows.groupby(["mode", "participant"])["stuck"].agg(["sum", "count"])
    people = list(dict.fromkeys(rows["participant"]))
    empty = np.zeros((len(people), 2), dtype=np.int64)
    tallies = {
        mode: by_person.loc[mode].reindex(people, fill_value=0).to_numpy(dtype=np.int64)
        if mode in by_person.index
        else empty
        for mode in (rate.mode for rate in tried)
    }
    contrasts = []
    for n, i in enumerate(tried):
        equally_likely = betaincinv(1.0 + i.stuck, 1.0 + i.comparisons - i.stuck, _EQUALLY_LIKELY)
        for j in tried[n + 1 :]:
            contrasts.append(_contrast(i, j, tallies[i.mode], tallies[j.mode], equally_likely))
    return tuple(contrasts)


def _contrast(
    i: StuckRate, j: StuckRate, of_i: IntArray, of_j: IntArray, likely_i: FloatArray
) -> StuckContrast:
    p_people = p_exchange = np.nan
    higher = lower = 0
    if i.share_of_people is not None and j.share_of_people is not None:
        p_people = i.share_of_people.p_above(j.share_of_people)
        sign = np.sign(of_i[:, 0] * of_j[:, 1] - of_j[:, 0] * of_i[:, 1])
        higher, lower = int((sign > 0).sum()), int((sign < 0).sum())
        p_exchange = p_exchanged(of_i, of_j)
    return StuckContrast(
        mode_i=i.mode,
        mode_j=j.mode,
        p_i_above_j=float(betainc(1.0 + j.stuck, 1.0 + j.comparisons - j.stuck, likely_i).mean()),
        p_fisher=exact_p(of_i.sum(axis=0)[None], of_j.sum(axis=0)[None]),
        p_within_people=exact_p(of_i, of_j),
        p_i_above_j_people=p_people,
        p_by_people=p_exchange,
        people_i_higher=higher,
        people_j_higher=lower,
    )


def exact_p(first: IntArray, second: IntArray) -> float:
    """Two-sided exact test of equal odds within strata.

    Given the events of each stratum under both modes, those under the first are hypergeometric; their sum
    over strata is the convolution. Outcomes no likelier than the one seen count against equality.

    Parameters
    ----------
    first, second : ndarray of int64, shape (stratum, 2)
        Events and comparisons of either mode; with one stratum this is Fisher's test.
    """
    both = first + second
    # Elsewhere the events under the first mode follow from those under both.
    is_open = (both[:, 0] > 0) & (both[:, 0] < both[:, 1]) & (first[:, 1] > 0) & (second[:, 1] > 0)
    first, second = first[is_open], second[is_open]
    chances = np.ones(1)
    lowest = 0
    for (k_i, n_i), (k_j, n_j) in zip(first, second, strict=True):
        events = int(k_i + k_j)
        start, end = max(0, events - int(n_j)), min(int(n_i), events)
        chances = np.convolve(chances, _hypergeometric(start, end, int(n_i), int(n_j), events))
        lowest += start
    seen = chances[int(first[:, 0].sum()) - lowest]
    return float(min(1.0, chances[chances <= seen * (1 + 1e-7)].sum()))


def p_exchanged(first: IntArray, second: IntArray) -> float:
    """Two-sided exact test by people: had the modes been exchanged for any of them, how often as far apart?

    If neither mode gets people stuck more often, a person's difference of shares is as likely with the other
    sign. Of all choices of signs, those count against equality whose sum is at least as far from 0 as the
    sum seen. A person decides as a whole, however many comparisons there are. Exact where everybody had both
    modes equally often; elsewhere signs are equally likely only nearly.

    Parameters
    ----------
    first, second : ndarray of int64, shape (person, 2)
        Events and comparisons of either mode. People without comparisons of both say nothing.
    """
    had_both = (first[:, 1] > 0) & (second[:, 1] > 0)
    (k_i, n_i), (k_j, n_j) = first[had_both].T, second[had_both].T
    differences = k_i / n_i - k_j / n_j
    differences = differences[np.abs(differences) > 1e-12]
    # Shares are multiples of one fraction. Where that is too fine the differences are rounded, which gives
    # another statistic of people's differences: the test stays exact.
    steps = float(lcm(*{int(n) for n in (*n_i, *n_j)}))
    total = float(np.abs(differences).sum())
    moves = np.rint(differences * min(steps, _MOST_STEPS / max(total, 1.0))).astype(np.int64)
    chances = np.ones(1)
    for move in np.abs(moves):
        # A sum of moves with either sign, counted from its lowest value in steps of two moves.
        longer = np.zeros(len(chances) + move)
        longer[: len(chances)] += chances / 2
        longer[move:] += chances / 2
        chances = longer
    sums = 2 * np.arange(len(chances)) - np.abs(moves).sum()
    return float(min(1.0, chances[np.abs(sums) >= abs(moves.sum())].sum()))


def _hypergeometric(start: int, end: int, n_i: int, n_j: int, events: int) -> FloatArray:
    k = np.arange(start, end + 1)
    logs = _log_choose(n_i, k) + _log_choose(n_j, events - k)
    chances = np.exp(logs - logs.max())
    return np.asarray(chances / chances.sum())


def _log_choose(n: int, k: IntArray) -> FloatArray:
    return np.asarray(gammaln(n + 1) - gammaln(k + 1) - gammaln(n - k + 1))
