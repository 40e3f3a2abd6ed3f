"""The convergence gate: what a report says of a question must rest on draws that are good enough.

Behind the gate are the ability, the worth and the rank of every mode, the difference of the abilities of two
modes, and every parameter. Whatever else is printed is a share, a mean or a quantile of the draws of one of
these, or a smooth function of a few of them: `README.md` says which of which.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from analysis.diagnostics import Convergence, convergence
from analysis.results import Draws
from analysis.summaries import ranks

MOST_PAIRS = 5000
"""Differences that are looked at, all of a hundred modes: a millisecond each at 4,000 draws."""
_BLOCK = 256
"""Differences that are in memory at once."""

FloatArray = NDArray[np.float64]


def reported_convergence(draws: Draws) -> Convergence:
    """Convergence of every quantity that is reported; of the differences, those of ``watched_pairs``."""
    found = [convergence(quantities) for quantities in _quantities(draws)]
    return Convergence(
        np.concatenate([part.rhat for part in found]),
        np.concatenate([part.ess_bulk for part in found]),
        np.concatenate([part.ess_tail for part in found]),
    )


def watched_pairs(ability: FloatArray) -> NDArray[np.intp]:
    """Pairs of modes whose difference is behind the gate: all, or of many modes the neighbours in rank.

    The more modes lie between two, the surer is who is above; pairs are taken from neighbours outwards for as
    long as ``MOST_PAIRS`` hold them (five places apart for 1,000 modes).

    Parameters
    ----------
    ability : ndarray, shape (chain, draw, mode)

    Returns
    -------
    ndarray, shape (pair, 2)
        The mode with the higher mean ability first.
    """
    order = np.argsort(-ability.mean(axis=(0, 1)), kind="stable")
    n = len(order)
    so_far = np.cumsum(np.arange(n - 1, 0, -1))
    apart = max(int(np.searchsorted(so_far, MOST_PAIRS, side="right")), 1)
    return np.concatenate([np.stack([order[:-k], order[k:]], axis=1) for k in range(1, apart + 1)])


def _quantities(draws: Draws) -> Iterator[FloatArray]:
    """Draws of all that is behind the gate, in parts of shape (quantity, chain, draw)."""
    for by_mode in (draws.ability, draws.worth, ranks(draws.ability)):
        yield np.moveaxis(by_mode, -1, 0)
    if draws.parameters:
        yield np.stack(list(draws.parameters.values()))
    ability = np.ascontiguousarray(np.moveaxis(draws.ability, -1, 0))
    pairs = watched_pairs(draws.ability)
    for k in range(0, len(pairs), _BLOCK):
        one, other = pairs[k : k + _BLOCK].T
        yield ability[one] - ability[other]
