"""The convergence gate: what a report says of a question must rest on draws that are good enough.

Behind the gate are the ability, the worth and the rank of every mode, the difference of the abilities of two
modes, and every parameter. Whatever else is printed is a share, a mean or a quantile of the draws of one of
these, or a smooth function of a few of them: `README.md` says which of which.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.diagnostics import (
    ESS_ABOVE,
    RHAT_BELOW,
    Convergence,
    convergence,
    ess_in_words,
    rhat_in_words,
)
from analysis.results import Draws
from analysis.summaries import ranks
from analysis.wording import wording

MOST_PAIRS = 5000
"""Differences that are looked at, all of a hundred modes: a millisecond each at 4,000 draws."""
_BLOCK = 256
"""Differences that are in memory at once."""

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Gate(Convergence):
    """Convergence of every quantity that is reported, and what each is called in a sentence."""

    names: tuple[str, ...]

    @property
    def refusal(self) -> str:
        """Why a question is not ranked, as a sentence; empty if it may be."""
        if self.passed:
            return ""
        failed, ess = int(self.failing.sum()), np.minimum(self.ess_bulk, self.ess_tail)
        # How far each is from its limits, on one scale: 1 at the gate, and nan the farthest.
        worst = int(np.maximum((self.rhat - 1) / (RHAT_BELOW - 1), ESS_ABOVE / ess).argmax())
        return (
            f"The sampling did not converge: {failed:,} of {len(self.names):,} quantities "
            f"{'fails' if failed == 1 else 'fail'}. The worst is {self.names[worst]}: R-hat "
            f"{_judged(rhat_in_words(float(self.rhat[worst])), f'must be below {RHAT_BELOW}')}, effective "
            f"sample size {_judged(ess_in_words(float(ess[worst])), f'must be above {ESS_ABOVE:.0f}')}."
        )


def _judged(value: str, limit: str) -> str:
    """A value with its limit, unless its words name the limit already."""
    return value if value.endswith(")") else f"{value} ({limit})"


def reported_convergence(draws: Draws, modes: Sequence[str]) -> Gate:
    """Convergence of all that is reported; of the differences, those of ``watched_pairs``.

    Parameters
    ----------
    modes : sequence of str
        In the order of the draws' last axis.
    """
    names: list[str] = []
    found: list[Convergence] = []
    for part, quantities in _quantities(draws, modes):
        names += part
        found.append(convergence(quantities))
    return Gate(
        np.concatenate([part.rhat for part in found]),
        np.concatenate([part.ess_bulk for part in found]),
        np.concatenate([part.ess_tail for part in found]),
        tuple(names),
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


def _quantities(draws: Draws, modes: Sequence[str]) -> Iterator[tuple[list[str], FloatArray]]:
    """Names and draws of all that is behind the gate, in parts of shape (quantity, chain, draw)."""
    by_mode = {"ability": draws.ability, "worth": draws.worth, "rank": ranks(draws.ability)}
    for what, values in by_mode.items():
        yield [f"the {what} of {mode}" for mode in modes], np.moveaxis(values, -1, 0)
    if draws.parameters:
        yield [wording(name).sentence for name in draws.parameters], np.stack(list(draws.parameters.values()))
    ability = np.ascontiguousarray(np.moveaxis(draws.ability, -1, 0))
    pairs = watched_pairs(draws.ability)
    for k in range(0, len(pairs), _BLOCK):
        one, other = pairs[k : k + _BLOCK].T
        names = [f"the difference of {modes[i]} and {modes[j]}" for i, j in pairs[k : k + _BLOCK]]
        yield names, ability[one] - ability[other]
