"""The answers people gave to each pair of modes, and the shares the fitted model expects."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.counts import count_responses
from analysis.diagnostics import hdi
from analysis.model import adjacent_log_probabilities, cumulative_log_probabilities
from analysis.results import HDI_PROBABILITY, Draws, Fit, QuestionFit
from data.responses import ResponseTable

DRAWS_USED = 400
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
    expected_low, expected_high : tuple of float
        94 % HDI of these shares.
    """

    mode_i: str
    mode_j: str
    counts: tuple[int, ...]
    expected: tuple[float, ...] = ()
    expected_low: tuple[float, ...] = ()
    expected_high: tuple[float, ...] = ()

    @property
    def n(self) -> int:
        """Answers to this pair."""
        return sum(self.counts)


@dataclass(frozen=True)
class ThinnedDraws:
    """Evenly chosen draws, chains laid end to end: ``ability`` (draw, mode), each parameter (draw,)."""

    ability: NDArray[np.float64]
    parameters: dict[str, NDArray[np.float64]]


def thinned(draws: Draws, number: int = DRAWS_USED) -> ThinnedDraws:
    """About so many of the draws, evenly chosen."""
    ability = draws.ability.reshape(-1, draws.ability.shape[-1])
    every = max(1, len(ability) // number)
    return ThinnedDraws(
        ability[::every], {name: values.reshape(-1)[::every] for name, values in draws.parameters.items()}
    )


def answer_shares(table: ResponseTable, fit: Fit) -> tuple[tuple[PairShares, ...], ...]:
    """Per question of the fit, the pairs that were asked, in the order of the modes."""
    return tuple(_pairs(table, fit, question) for question in fit.questions)


def _pairs(table: ResponseTable, fit: Fit, question: QuestionFit) -> tuple[PairShares, ...]:
    counts = count_responses(table, question.question)
    modes, levels = question.mode_names, question.question.levels
    place = np.array([modes.index(mode) for mode in counts.modes])
    shown = np.zeros((len(modes), len(modes), levels), dtype=np.int64)
    np.add.at(shown, (place[counts.mode_a], place[counts.mode_b]), counts.responses)
    pairs = []
    for i in range(len(modes)):
        for j in range(i + 1, len(modes)):
            as_ij, as_ji = shown[i, j], shown[j, i]
            if not as_ij.any() and not as_ji.any():
                continue
            given = tuple(int(n) for n in as_ij + as_ji[::-1])
            expected = None
            if question.ranked and question.draws is not None:
                expected = _expected(question.draws, levels, i, j, int(as_ij.sum()), int(as_ji.sum()))
            if expected is None:
                pairs.append(PairShares(modes[i], modes[j], given))
                continue
            low, high = hdi(expected, HDI_PROBABILITY)
            mean = tuple(float(x) for x in expected.mean(axis=0))
            pairs.append(
                PairShares(modes[i], modes[j], given, mean, tuple(map(float, low)), tuple(map(float, high)))
            )
    return tuple(pairs)


def _expected(draws: Draws, levels: int, i: int, j: int, n_ij: int, n_ji: int) -> NDArray[np.float64] | None:
    """Draws of the shares, (draw, level), over people and over the orders in which the pair was shown.

    The deviations z of a person are ZeroSumNormal(1) over the modes, so z_i - z_j has variance 2
    whatever the number of modes; the integral over it is Gauss-Hermite quadrature. None if the draws hold no
    model of this scale.
    """
    kept = thinned(draws)
    parameters = {name: values[:, None] for name, values in kept.parameters.items()}
    if not knows_scale(kept.parameters, levels):
        return None
    lead = (kept.ability[:, i] - kept.ability[:, j])[:, None]
    side = parameters.get("side_effect", np.zeros_like(lead))
    people = np.sqrt(2.0) * parameters.get("subject_sd", np.zeros_like(lead)) * _NODES
    as_ij = answer_probabilities(lead + side + people, parameters, levels)
    as_ji = answer_probabilities(-lead + side + people, parameters, levels)
    both = (n_ij * as_ij + n_ji * as_ji[..., ::-1]) / (n_ij + n_ji)
    return np.asarray(np.einsum("m,dml->dl", _WEIGHTS / _WEIGHTS.sum(), both))


def knows_scale(parameters: Mapping[str, NDArray[np.float64]], levels: int) -> bool:
    """False where the model was fitted to a shorter scale than the answers have (the gibbs engine)."""
    if "log_nu" in parameters:
        return levels == 3
    return sum(name.startswith("cut_") for name in parameters) == levels // 2 - (levels == 2)


def answer_probabilities(
    eta: NDArray[np.float64], parameters: Mapping[str, NDArray[np.float64]], levels: int
) -> NDArray[np.float64]:
    """Chance of each answer, from A much to B much, as the fitted model has it.

    Parameters
    ----------
    eta : ndarray, shape (draw, ...)
        Lead of A over B [logit].
    parameters : mapping of str to ndarray
        The draws' parameters, each of a shape that broadcasts against ``eta``.

    Returns
    -------
    ndarray, shape (draw, ..., level)
    """
    if "log_nu" in parameters:
        return np.exp(adjacent_log_probabilities(eta, parameters["log_nu"]))
    cuts = [parameters[name] for name in ("cut_1", "cut_2") if name in parameters]
    stacked = np.stack(cuts, axis=-1) if cuts else np.empty((*([1] * eta.ndim), 0))
    return np.exp(cumulative_log_probabilities(eta, stacked, levels))
