"""Two modes' stuck rates against each other: by posterior, and by exact tests beside it.

References
----------
Fisher 1935 (exact test of a two by two table); Mehta, Patel, Gray 1985, "Computing an exact confidence
interval for the common odds ratio in several 2 x 2 contingency tables" (the convolution over strata).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import betainc, betaincinv, gammaln

from analysis.stuck import StuckRate
from data.responses import StuckTable

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class StuckContrast:
    """Two modes' stuck rates.

    Attributes
    ----------
    p_i_above_j : float
        Posterior probability that mode i's rate is higher, under independent Beta posteriors.
    p_fisher : float
        Two-sided exact test of equal rates (Fisher), comparisons taken as independent.
    p_within_people : float
        The same within participants: given how often each of them got stuck under either mode, so that people
        who get stuck more often than others cannot make a difference between modes.
    """

    mode_i: str
    mode_j: str
    p_i_above_j: float
    p_fisher: float
    p_within_people: float


def stuck_contrasts(table: StuckTable, rates: tuple[StuckRate, ...]) -> tuple[StuckContrast, ...]:
    """Every pair of modes that both took part in a comparison."""
    known = [rate for rate in rates if rate.comparisons]
    rows = table.rows
    by_person = rows.groupby(["mode", "participant"])["stuck"].agg(["sum", "count"])
    people = list(dict.fromkeys(rows["participant"]))
    empty = np.zeros((len(people), 2), dtype=np.int64)
    tallies = {
        mode: by_person.loc[mode].reindex(people, fill_value=0).to_numpy(dtype=np.int64)
        if mode in by_person.index
        else empty
        for mode in (rate.mode for rate in known)
    }
    return tuple(
        StuckContrast(
            i.mode,
            j.mode,
            _p_above(i, j),
            exact_p(tallies[i.mode].sum(axis=0)[None], tallies[j.mode].sum(axis=0)[None]),
            exact_p(tallies[i.mode], tallies[j.mode]),
        )
        for n, i in enumerate(known)
        for j in known[n + 1 :]
    )


def exact_p(first: NDArray[np.int64], second: NDArray[np.int64]) -> float:
    """Two-sided exact test of equal odds within strata.

    Given the events of each stratum under both modes, those under the first are hypergeometric; their sum
    over strata is the convolution. Outcomes no likelier than the one seen count against equality.

    Parameters
    ----------
    first, second : ndarray of int64, shape (stratum, 2)
        Events and comparisons of either mode; with one stratum this is Fisher's test.
    """
    chances = np.ones(1)
    lowest = 0
    for (k_i, n_i), (k_j, n_j) in zip(first, second, strict=True):
        events = int(k_i + k_j)
        start, end = max(0, events - int(n_j)), min(int(n_i), events)
        chances = np.convolve(chances, _hypergeometric(start, end, int(n_i), int(n_j), events))
        lowest += start
    seen = chances[int(first[:, 0].sum()) - lowest]
    return float(min(1.0, chances[chances <= seen * (1 + 1e-7)].sum()))


def _hypergeometric(start: int, end: int, n_i: int, n_j: int, events: int) -> FloatArray:
    k = np.arange(start, end + 1)
    logs = _log_choose(n_i, k) + _log_choose(n_j, events - k)
    chances = np.exp(logs - logs.max())
    return np.asarray(chances / chances.sum())


def _log_choose(n: int, k: NDArray[np.int64]) -> FloatArray:
    return np.asarray(gammaln(n + 1) - gammaln(k + 1) - gammaln(n - k + 1))


def _p_above(i: StuckRate, j: StuckRate) -> float:
    """P(rate i > rate j): the mean of j's distribution function at equally likely rates of i."""
    probabilities = (np.arange(4000) + 0.5) / 4000
    at = betaincinv(1.0 + i.stuck, 1.0 + i.comparisons - i.stuck, probabilities)
    return float(betainc(1.0 + j.stuck, 1.0 + j.comparisons - j.stuck, at).mean())
