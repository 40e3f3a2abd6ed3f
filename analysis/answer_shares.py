"""The answers people gave to each pair of modes, and the shares the fitted model expects."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.counts import count_responses
from analysis.model import adjacent_log_probabilities, cumulative_log_probabilities
from analysis.results import Draws, Fit, QuestionFit
from data.responses import ResponseTable

_DRAWS_USED = 400
"""Thinned to about this many: the error of a mean share is then far below what a drawing shows."""
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(15)


@dataclass(frozen=True)
class PairShares:
    """The answers to one pair of modes, turned so that the first mode stands as A.

    Attributes
    ----------
    counts : tuple of int
        From much more the first (or more, on a shorter scale) to much more the second.
    expected : tuple of float
        Posterior mean share of each answer among new people who see the pair in the same
        orders; empty where the model has none.
    """

    mode_i: str
    mode_j: str
    counts: tuple[int, ...]
    expected: tuple[float, ...] = ()

    @property
    def n(self) -> int:
        """Answers to this pair."""
        return sum(self.counts)


def answer_shares(table: ResponseTable, fit: Fit) -> tuple[tuple[PairShares, ...], ...]:
    """Per question of the fit, the pairs that were asked, in the order of the modes."""
    return tuple(_pairs(table, fit, question) for question in fit.questions)


def _pairs(table: ResponseTable, fit: Fit, question: QuestionFit) -> tuple[PairShares, ...]:
    counts = count_responses(table, question.question)
    modes, levels = fit.modes, question.question.levels
    place = np.array([modes.index(mode) for mode in counts.modes])
    shown = np.zeros((len(modes), len(modes), levels), dtype=np.int64)
    np.add.at(shown, (place[counts.mode_a], place[counts.mode_b]), counts.responses)
    pairs = []
    for i in range(len(modes)):
        for j in range(i + 1, len(modes)):
            as_ij, as_ji = shown[i, j], shown[j, i]
            if not as_ij.any() and not as_ji.any():
                continue
            expected: tuple[float, ...] = ()
            if question.ranked and question.draws is not None:
                expected = _expected(question.draws, levels, i, j, int(as_ij.sum()), int(as_ji.sum()))
            given = tuple(int(n) for n in as_ij + as_ji[::-1])
            pairs.append(PairShares(modes[i], modes[j], given, expected))
    return tuple(pairs)


def _expected(draws: Draws, levels: int, i: int, j: int, n_ij: int, n_ji: int) -> tuple[float, ...]:
    """Posterior mean shares, averaged over people and over the orders in which the pair was shown.

    The deviations z of a person are ZeroSumNormal(1) over the modes, so z_i - z_j has variance 2
    whatever the number of modes; the integral over it is Gauss-Hermite quadrature.
    """
    ability = draws.ability.reshape(-1, draws.ability.shape[-1])
    every = max(1, len(ability) // _DRAWS_USED)
    parameters = {name: values.reshape(-1)[::every, None] for name, values in draws.parameters.items()}
    lead = (ability[:, i] - ability[:, j])[::every, None]
    side = parameters.get("side_effect", np.zeros_like(lead))
    people = np.sqrt(2.0) * parameters.get("subject_sd", np.zeros_like(lead)) * _NODES
    as_ij = _shares(lead + side + people, parameters, levels)
    as_ji = _shares(-lead + side + people, parameters, levels)
    if as_ij is None or as_ji is None:
        return ()
    both = (n_ij * as_ij + n_ji * as_ji[..., ::-1]) / (n_ij + n_ji)
    weights = _WEIGHTS / _WEIGHTS.sum()
    return tuple(float(share) for share in weights @ both.mean(axis=0))


def _shares(
    eta: NDArray[np.float64], parameters: dict[str, NDArray[np.float64]], levels: int
) -> NDArray[np.float64] | None:
    """Chance of each answer, shape (draw, node, level); None if the draws hold no model of this scale."""
    if "log_nu" in parameters:
        return np.exp(adjacent_log_probabilities(eta, parameters["log_nu"]))
    cuts = [parameters[name] for name in ("cut_1", "cut_2") if name in parameters]
    if not cuts and "log_theta" in parameters:
        cuts = [parameters["log_theta"]]
    if len(cuts) != levels // 2 - (levels == 2):
        return None
    stacked = np.stack(cuts, axis=-1) if cuts else np.empty((1, 1, 0))
    return np.exp(cumulative_log_probabilities(eta, stacked, levels))
