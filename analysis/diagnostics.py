"""Has the sampling converged, and how many independent draws is it worth? Vectorised over quantities.

References
----------
Vehtari, Gelman, Simpson, Carpenter, Buerkner 2021, "Rank-normalization, folding, and localization: an
improved R-hat for assessing convergence of MCMC" (all formulas and both limits); Geyer 1992, "Practical
Markov chain Monte Carlo", section 3.3 (initial monotone sequence).
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft
from scipy.special import ndtri

RHAT_BELOW = 1.01
"""Gate on R-hat (Vehtari et al. 2021)."""
ESS_ABOVE = 400.0
"""Gate on bulk and tail ESS: 100 for each of four chains (Vehtari et al. 2021)."""
_BLOCK = 32
"""Quantities looked at together: their draws fit a processor's cache."""


@dataclass(frozen=True)
class Convergence:
    """Diagnostics by quantity: ``rhat``, ``ess_bulk`` and ``ess_tail``, each of shape (quantity,)."""

    rhat: NDArray[np.float64]
    ess_bulk: NDArray[np.float64]
    ess_tail: NDArray[np.float64]

    @property
    def rhat_max(self) -> float:
        """Worst R-hat."""
        return float(self.rhat.max())

    @property
    def ess_min(self) -> float:
        """Smallest bulk or tail ESS."""
        return float(min(self.ess_bulk.min(), self.ess_tail.min()))

    @property
    def failing(self) -> NDArray[np.bool_]:
        """Which quantities do not pass the gate; nan never does."""
        return ~((self.rhat < RHAT_BELOW) & (self.ess_bulk > ESS_ABOVE) & (self.ess_tail > ESS_ABOVE))

    @property
    def passed(self) -> bool:
        """True if every quantity passes the gate."""
        return not self.failing.any()


def convergence(draws: NDArray[np.float64]) -> Convergence:
    """Rank-normalised split R-hat, bulk ESS and tail ESS of many quantities at once.

    Tail ESS is the smaller one of the 5 % and 95 % quantiles, as in Vehtari et al. 2021 and ArviZ before
    1.0 (later versions take other quantiles unless they are named: ``prob=(0.05, 0.95)``).

    A quantity that is the same in every draw has an R-hat of 1 and an ESS of all the draws; one that is
    constant within chains and differs between them has an infinite R-hat; one with a draw that is no finite
    number has nan.

    Parameters
    ----------
    draws : ndarray, shape (quantity, chain, draw)
        At least four draws a chain.
    """
    blocks = [_convergence(draws[k : k + _BLOCK]) for k in range(0, len(draws), _BLOCK)]
    return Convergence(*(np.concatenate(values) for values in zip(*blocks, strict=True)))


def _convergence(draws: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """R-hat, bulk ESS and tail ESS of a block of quantities."""
    is_known = np.asarray(np.isfinite(draws).all(axis=(1, 2)))
    draws = np.where(is_known[:, None, None], draws, 0.0)
    halves = _split(draws)
    z = _normal_scores(halves)
    ordered = np.sort(halves.reshape(len(draws), -1), axis=1)
    middle = ordered[:, ordered.shape[1] // 2 - 1 : ordered.shape[1] // 2 + 1].mean(axis=1)
    folded = _normal_scores(np.abs(halves - middle[:, None, None]))
    # Of the draws as many lie at or below a quantile as at or below the draw next below it.
    ordered = np.sort(draws.reshape(len(draws), -1), axis=1)
    ends = [ordered[:, int(share * (ordered.shape[1] - 1)), None, None] for share in (0.05, 0.95)]
    tails = [_ess(_split((draws <= end).astype(np.float64))) for end in ends]
    found = (np.maximum(_rhat(z), _rhat(folded)), _ess(z), np.minimum(*tails))
    return tuple(np.where(is_known, values, np.nan) for values in found)


def ess_of_mean(draws: NDArray[np.float64]) -> NDArray[np.float64]:
    """ESS for the mean of the draws themselves, from which its Monte Carlo error follows; shape (quantity,).

    Parameters
    ----------
    draws : ndarray, shape (quantity, chain, draw)
    """
    return np.concatenate([_ess(_split(draws[k : k + _BLOCK])) for k in range(0, len(draws), _BLOCK)])


def shown_rhat(rhat: float) -> str:
    """Rounded to three digits."""
    return f"{rhat:.3f}"


def shown_ess(ess: float) -> str:
    """Rounded to a whole number."""
    return f"{ess:,.0f}"


def rhat_in_words(rhat: float) -> str:
    """The same for a sentence, which says so where the rounded value hides that the gate was passed."""
    hidden = rhat < RHAT_BELOW <= float(shown_rhat(rhat))
    return f"{shown_rhat(rhat)}{f' (just below {RHAT_BELOW})' if hidden else ''}"


def ess_in_words(ess: float) -> str:
    """The same for a sentence, which says so where the rounded value hides that the gate was passed."""
    hidden = ess > ESS_ABOVE >= round(ess)
    return f"{shown_ess(ess)}{f' (just above {ESS_ABOVE:.0f})' if hidden else ''}"


def hdi(draws: NDArray[np.float64], probability: float) -> NDArray[np.float64]:
    """The shortest interval that holds so much of the draws.

    Parameters
    ----------
    draws : ndarray, shape (draw, ...)

    Returns
    -------
    ndarray, shape (2, ...)
        Lower and upper ends.
    """
    ordered = np.sort(draws, axis=0)
    inside = int(np.floor(probability * len(draws)))
    width = ordered[inside:] - ordered[: len(draws) - inside]
    first = np.expand_dims(width.argmin(axis=0), 0)
    return np.concatenate(
        [np.take_along_axis(ordered, first, axis=0), np.take_along_axis(ordered, first + inside, axis=0)]
    )


def _split(draws: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each chain as two: drift within a chain then shows as disagreement between chains."""
    half = draws.shape[2] // 2
    return np.concatenate([draws[..., :half], draws[..., -half:]], axis=1)


def _normal_scores(draws: NDArray[np.float64]) -> NDArray[np.float64]:
    """Average ranks over all chains, as normal quantiles (Blom's offset 3/8)."""
    flat = draws.reshape(len(draws), -1)
    n = flat.shape[1]
    order = np.argsort(flat, axis=1)
    ordered = np.take_along_axis(flat, order, axis=1)
    is_new = ordered[:, 1:] != ordered[:, :-1]
    of_rank = _score_of_twice_rank(n)
    if is_new.all():
        by_place = np.broadcast_to(of_rank[2::2], flat.shape)
    else:
        edge, place = np.ones((len(flat), 1), dtype=bool), np.broadcast_to(np.arange(n), flat.shape)
        starts, ends = np.concatenate([edge, is_new], axis=1), np.concatenate([is_new, edge], axis=1)
        first = np.maximum.accumulate(np.where(starts, place, 0), axis=1)
        last = np.minimum.accumulate(np.where(ends, place, n)[:, ::-1], axis=1)[:, ::-1]
        by_place = of_rank[first + last + 2]
    scores = np.empty_like(flat)
    np.put_along_axis(scores, order, by_place, axis=1)
    return scores.reshape(draws.shape)


@lru_cache(maxsize=4)
def _score_of_twice_rank(n: int) -> NDArray[np.float64]:
    """Normal quantiles of the ranks 0, 1/2, 1, ..., n of n draws."""
    return np.asarray(ndtri(np.maximum(np.arange(2 * n + 1) / 2 - 3 / 8, 0.0) / (n + 1 / 4)))


def _rhat(chains: NDArray[np.float64]) -> NDArray[np.float64]:
    """Square root of the pooled over the mean within-chain variance; 1 if there is none of either."""
    n = chains.shape[2]
    between = n * chains.mean(axis=2).var(axis=1, ddof=1)
    within = chains.var(axis=2, ddof=1).mean(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        rhat = np.sqrt((between / within + n - 1) / n)
    return np.where(_is_constant(chains), 1.0, rhat)


def _is_constant(chains: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which quantities are the same in every draw of every chain."""
    return np.ptp(chains, axis=(1, 2)) < np.finfo(float).resolution


def _ess(chains: NDArray[np.float64]) -> NDArray[np.float64]:
    """Draws over their integrated autocorrelation time."""
    m, n = chains.shape[1:]
    centred = chains - chains.mean(axis=2, keepdims=True)
    spectrum = rfft(centred, n=next_fast_len(2 * n, real=True), axis=2)
    # The mean over the chains is taken before the transform back, which is linear.
    power = (spectrum.real**2 + spectrum.imag**2).mean(axis=1)
    covariance = irfft(power, n=next_fast_len(2 * n, real=True), axis=1)[:, :n] / n
    within = covariance[:, :1] * n / (n - 1)
    total = within * (n - 1) / n + chains.mean(axis=2).var(axis=1, ddof=1)[:, None]
    is_constant = _is_constant(chains)
    total[is_constant] = 1.0
    rho = 1.0 - (within - covariance) / total
    rho[:, 0] = 1.0

    # Sums of neighbouring lags are positive and fall in a reversible chain; past the first that is
    # not positive there is only noise (Geyer 1992).
    n_pairs = max((n - 1) // 2, 1)
    even = rho[:, 0 : 2 * n_pairs : 2]
    pairs = even + rho[:, 1 : 2 * n_pairs : 2]
    stop = np.where((pairs <= 0).any(axis=1), (pairs <= 0).argmax(axis=1), n_pairs - 1)
    falling = np.minimum.accumulate(pairs, axis=1)
    kept = np.where(np.arange(n_pairs) < stop[:, None], falling, 0.0).sum(axis=1)
    at_stop = (np.arange(len(stop)), stop)
    last = np.where(pairs[at_stop] >= 0, even[at_stop], np.maximum(even[at_stop], 0.0))
    time = np.maximum(-1.0 + 2.0 * kept + last, 1 / np.log10(m * n))
    return np.where(is_constant, float(m * n), m * n / time)
