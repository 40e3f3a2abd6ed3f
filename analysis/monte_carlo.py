"""What another seed would change: Monte Carlo standard errors of the means and chances that a report prints.

A mean over dependent draws is known as well as one over as many independent draws as they are worth (ESS). A
chance is the mean of draws that are 0 or 1.

References
----------
Vehtari, Gelman, Simpson, Carpenter, Buerkner 2021, "Rank-normalization, folding, and localization: an
improved R-hat for assessing convergence of MCMC" (section 4.1: the error of a mean).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.diagnostics import ess_of_mean
from analysis.gate import watched_pairs
from analysis.results import Draws, Fit, QuestionFit
from analysis.summaries import ranks

MOST_PAIRS = 500
"""Pairs of modes whose chance has its error worked out: all of 32 modes, of more the neighbours in rank."""

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class MonteCarloError:
    """One printed mean or chance with its Monte Carlo standard error.

    Attributes
    ----------
    mode_i, mode_j : str
        The mode it is about, or the pair; empty for parameters.
    quantity : str
        ``ability_mean``, ``worth_mean``, ``rank_mean``, ``p_best``, ``p_i_above_j`` or a parameter's name.
    value, mcse : float
        Standard deviation of the value over seeds. That of a chance is never 0: draws which all say the same
        leave it open by one in so many as they are worth.
    """

    question: str
    mode_i: str
    mode_j: str
    quantity: str
    value: float
    mcse: float


def monte_carlo_errors(fit: Fit) -> tuple[MonteCarloError, ...]:
    """Errors of every ranked question, in the order of the fit."""
    return tuple(
        MonteCarloError(q.question.name, *of, float(value), float(error))
        for q in fit.questions
        if q.ranked and q.draws is not None
        for names, values, errors in _parts(q, q.draws, q.mode_names)
        for of, value, error in zip(names, values, errors, strict=True)
    )


def mean_errors(draws: FloatArray) -> FloatArray:
    """Monte Carlo standard error of each quantity's mean; ``draws`` has shape (quantity, chain, draw)."""
    return np.asarray(draws.std(axis=(1, 2), ddof=1) / np.sqrt(ess_of_mean(draws)))


def chance_errors(holds: NDArray[np.bool_]) -> FloatArray:
    """Monte Carlo standard error of the share of draws in which something holds.

    The standard deviation of a chance of which so many independent draws are known (uniform prior), so that
    it is not 0 where all draws agree.

    Parameters
    ----------
    holds : ndarray of bool, shape (quantity, chain, draw)
    """
    ess = ess_of_mean(holds.astype(np.float64))
    share = (ess * holds.mean(axis=(1, 2)) + 1) / (ess + 2)
    return np.asarray(np.sqrt(share * (1 - share) / (ess + 3)))


_Part = tuple[list[tuple[str, str, str]], FloatArray, FloatArray]


def _parts(question: QuestionFit, draws: Draws, modes: tuple[str, ...]) -> Iterator[_Part]:
    """What each value is called, the values as reported, and their errors."""
    rank = ranks(draws.ability)
    for what, values in (("ability", draws.ability), ("worth", draws.worth), ("rank", rank)):
        reported = np.array([getattr(m, f"{what}_mean") for m in question.modes])
        yield [(mode, "", f"{what}_mean") for mode in modes], reported, mean_errors(_by_quantity(values))
    p_best = np.array([m.p_best for m in question.modes])
    yield [(mode, "", "p_best") for mode in modes], p_best, chance_errors(_by_quantity(rank) == 1)
    yield _of_pairs(question, draws, modes)
    if question.parameters:
        parameters = np.stack([draws.parameters[p.name] for p in question.parameters])
        names = [("", "", p.name) for p in question.parameters]
        yield names, np.array([p.mean for p in question.parameters]), mean_errors(parameters)


def _of_pairs(question: QuestionFit, draws: Draws, modes: tuple[str, ...]) -> _Part:
    reported = {(p.mode_i, p.mode_j): p.p_i_above_j for p in question.pairs}
    kept = sorted(tuple(sorted(pair)) for pair in watched_pairs(draws.ability)[:MOST_PAIRS].tolist())
    one, other = np.array(kept).T
    ability = _by_quantity(draws.ability)
    names = [(modes[i], modes[j], "p_i_above_j") for i, j in kept]
    values = np.array([reported[i, j] for i, j, _ in names])
    return names, values, chance_errors(ability[one] > ability[other])


def _by_quantity(values: FloatArray) -> FloatArray:
    return np.ascontiguousarray(np.moveaxis(values, -1, 0))
