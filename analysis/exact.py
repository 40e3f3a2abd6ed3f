"""Exact posteriors of three modes by summation over a grid: the judge of every sampler.

Nothing here is sampled and nothing is shared with the engines but the likelihood's definition in
``analysis.model``. Only for three modes and for pooled models; the cost is exponential in the parameters.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from analysis.counts import Counts
from analysis.maximum import maximum_a_posteriori
from analysis.model import (
    CUT_GAP_SCALE,
    LOG_NU_SD,
    SIDE_EFFECT_SD,
    Model,
    adjacent_log_probabilities,
    cumulative_log_probabilities,
)
from analysis.softmax import worth_of
from analysis.zero_sum import zero_sum_basis
from data.errors import InputError

REACH = 7.0
"""Half-width of the grid in posterior standard deviations: what lies beyond weighs under 1e-11."""

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class ExactPosterior:
    """Posterior means and standard deviations; modes sorted by name.

    Attributes
    ----------
    ability_mean, ability_sd, worth_mean, worth_sd, p_best : ndarray, shape (3,)
    parameter_mean, parameter_sd : dict of str to float
        ``side_effect``, ``cut_1``, ``cut_2`` and so on, or ``log_nu``: those the model has.
    """

    ability_mean: FloatArray
    ability_sd: FloatArray
    worth_mean: FloatArray
    worth_sd: FloatArray
    p_best: FloatArray
    parameter_mean: dict[str, float]
    parameter_sd: dict[str, float]


def exact_posterior(
    counts: Counts, model: Model, points: int = 41, nuisance_points: int = 25
) -> ExactPosterior:
    """The pooled model's posterior under its own priors.

    The trapezoidal rule on the whole line converges faster than any power of the step for a smooth
    density; only P(best), whose region has an edge, needs the finer grid of the abilities.

    Parameters
    ----------
    points, nuisance_points : int
        Grid points along each ability coordinate, and along each other parameter.
    """
    _three(counts)
    cells = counts.pooled()
    peak = maximum_a_posteriori(cells, model)
    basis = zero_sum_basis(3)
    model = model.plain.alike
    names = list(model.parameter_names(cells.modes))
    centre = np.concatenate([basis.T @ peak.ability, list(peak.parameters.values())])
    sd = np.sqrt(
        np.concatenate(
            [
                np.diag(basis.T @ peak.ability_covariance @ basis),
                np.square(list(peak.parameter_sd.values())),
            ]
        )
    )
    axes = [c + s * np.linspace(-REACH, REACH, points) for c, s in zip(centre[:2], sd[:2], strict=True)]
    u = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    ability = u @ basis.T
    log_prior = -0.5 * (u**2).sum(axis=1) / model.prior_sd**2
    lead = ability[:, cells.mode_a] - ability[:, cells.mode_b]
    others = [
        c + s * np.linspace(-REACH, REACH, nuisance_points) for c, s in zip(centre[2:], sd[2:], strict=True)
    ]
    nodes = list(product(*others))
    log_p = np.empty((len(nodes), len(u)))
    values = np.empty((len(nodes), len(names)))
    for k, node in enumerate(nodes):
        log_p[k], values[k] = _at_node(node, names, lead, cells, model)
    log_p += log_prior
    return _summary(ability, log_p, names, values)


def _at_node(
    node: tuple[float, ...], names: list[str], lead: FloatArray, cells: Counts, model: Model
) -> tuple[FloatArray, list[float]]:
    """Log-likelihood and the nuisance priors for all abilities at one point of the other parameters."""
    at = dict(zip(names, node, strict=True))
    eta = lead + at.get("side_effect", 0.0)
    log_prior = -0.5 * (at.get("side_effect", 0.0) / SIDE_EFFECT_SD) ** 2
    shown = dict(at)
    if model.link == "adjacent":
        log_prior -= 0.5 * (at["log_nu"] / LOG_NU_SD) ** 2
        log_p = adjacent_log_probabilities(eta, np.array(at["log_nu"]))
    else:
        log_gaps = np.array([at[name] for name in names if name.startswith("cut_")])
        gaps = np.exp(log_gaps)
        log_prior += float((log_gaps - 0.5 * (gaps / CUT_GAP_SCALE) ** 2).sum())
        cuts = np.cumsum(gaps)
        shown |= {f"cut_{k + 1}": float(cut) for k, cut in enumerate(cuts)}
        log_p = cumulative_log_probabilities(eta, cuts, model.levels)
    return (cells.responses * log_p).sum(axis=(1, 2)) + log_prior, [shown[name] for name in names]


def exact_dirichlet_posterior(counts: Counts, points: int = 301, theta_points: int = 200) -> ExactPosterior:
    """Rao-Kupper's model with Dirichlet(1) worths and theta flat above 1, as the gibbs engine has it.

    Parameters
    ----------
    points : int
        Grid points along each of the two log-ratios of worths.
    theta_points : int
        Grid points along log(theta - 1); without ties on the scale theta is 1 and has no grid.
    """
    _three(counts)
    wins, ties = counts.wins().astype(float), np.triu(counts.ties()).astype(float)
    axis = np.linspace(-9.0, 9.0, points)
    first, second = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    ability = np.stack([first, second, np.zeros_like(first)], axis=1)
    ability -= ability.mean(axis=1, keepdims=True)
    worth = worth_of(ability)
    # Flat on the simplex, times the Jacobian of the worths in the log-ratios.
    log_prior = np.log(worth).sum(axis=1)
    has_ties = counts.levels % 2 == 1
    excess = np.linspace(-9.0, 6.0, theta_points) if has_ties else np.array([-np.inf])
    log_p = np.empty((len(excess), len(first)))
    for k, x in enumerate(excess):
        theta = 1.0 + np.exp(x)
        # theta = 1 + e^x has Jacobian e^x.
        log_p[k] = log_prior + (x if has_ties else 0.0)
        for i, j in ((i, j) for i in range(3) for j in range(3) if i != j):
            log_win = np.log(worth[:, i]) - np.log(worth[:, i] + theta * worth[:, j])
            tied = ties[i, j] + ties[j, i]
            log_p[k] += (wins[i, j] + tied) * log_win
            if i < j and has_ties:
                log_p[k] += tied * np.log(theta**2 - 1.0)
    values = np.log1p(np.exp(excess))[:, None] if has_ties else np.zeros((1, 0))
    return _summary(ability, log_p, ["cut_1"] if has_ties else [], values)


def _summary(ability: FloatArray, log_p: FloatArray, names: list[str], values: FloatArray) -> ExactPosterior:
    """Moments from log-weights of shape (nuisance node, ability node)."""
    weight = np.exp(log_p - log_p.max())
    weight /= weight.sum()
    by_ability, by_node = weight.sum(axis=0), weight.sum(axis=1)
    worth = worth_of(ability)
    ability_mean, worth_mean, value_mean = by_ability @ ability, by_ability @ worth, by_node @ values
    # Grid points where modes are level belong to each of them in equal parts.
    highest = ability >= ability.max(axis=1, keepdims=True) - 1e-12
    best = highest / highest.sum(axis=1, keepdims=True)
    value_sd = np.sqrt(by_node @ (values - value_mean) ** 2)
    return ExactPosterior(
        ability_mean,
        np.sqrt(by_ability @ (ability - ability_mean) ** 2),
        worth_mean,
        np.sqrt(by_ability @ (worth - worth_mean) ** 2),
        by_ability @ best,
        {name: float(v) for name, v in zip(names, value_mean, strict=True)},
        {name: float(v) for name, v in zip(names, value_sd, strict=True)},
    )


def _three(counts: Counts) -> None:
    if len(counts.modes) != 3:
        raise InputError(f"exact posterior: only for 3 modes, not {len(counts.modes)}")
