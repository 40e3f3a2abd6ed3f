"""Log-likelihood of each person's answers given the group's parameters, own deviations integrated out.

A person's deviations are drawn from a normal distribution laid over their posterior at the middle of the
group's (Laplace), and weighted back: a few nodes then serve any number of modes and of answers. The density
is the sampler's own, so nothing of the model is written a second time.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.answer_shares import ThinnedDraws
from analysis.counts import Counts
from analysis.engines.compiled import compiled
from analysis.engines.density import log_density, packed
from analysis.model import Model, Problem
from analysis.persons import prior_nodes
from analysis.zero_sum import zero_sum_basis

FloatArray = NDArray[np.float64]
NODES = 32
_WIDER = 1.2
"""Factor on the spread of the nodes: the posterior is wider at some draws than in the middle. Untuned."""
_STEP = 1e-4
_MOST_STEPS = 30


def log_likelihoods(counts: Counts, model: Model, draws: ThinnedDraws, n_nodes: int = NODES) -> FloatArray:
    """Log-likelihood of every participant's answers at every draw of the group's parameters.

    Parameters
    ----------
    counts : Counts
        By participant, also where the model takes them together.
    draws : ThinnedDraws
        Abilities in the order of ``counts.modes``.
    n_nodes : int
        A power of two.

    Returns
    -------
    ndarray, shape (participant, draw)
    """
    positions = _positions(model, draws)
    everyone = np.arange(len(counts.participants))
    nobody = packed(Problem(_silent(of_people(counts, everyone == 0)), model))
    n_own = len(counts.modes) - 1 if model.hierarchical else 0
    found = np.empty((len(everyone), len(positions)))
    for s in everyone:
        own = packed(Problem(of_people(counts, everyone == s), model))
        nodes = _nodes(positions.mean(axis=0), own, n_own, n_nodes)
        found[s] = _integrated(positions, nodes.at, nodes.log_density, own, nobody)
    return found


def of_people(counts: Counts, chosen: NDArray[np.bool_]) -> Counts:
    """The answers of some participants alone."""
    kept = chosen[counts.participant]
    place = np.cumsum(chosen) - 1
    return replace(
        counts,
        participants=tuple(p for p, is_kept in zip(counts.participants, chosen, strict=True) if is_kept),
        participant=place[counts.participant[kept]].astype(np.int64),
        mode_a=counts.mode_a[kept],
        mode_b=counts.mode_b[kept],
        responses=counts.responses[kept],
    )


def _silent(counts: Counts) -> Counts:
    """The same people without an answer."""
    return replace(
        counts,
        participant=counts.participant[:0],
        mode_a=counts.mode_a[:0],
        mode_b=counts.mode_b[:0],
        responses=counts.responses[:0],
    )


@dataclass(frozen=True)
class _Nodes:
    """Points in a person's own coordinates, shape (node, own), and the log density they were drawn from."""

    at: FloatArray
    log_density: FloatArray


def _positions(model: Model, draws: ThinnedDraws) -> FloatArray:
    """Draws in the sampler's coordinates, shape (draw, n_global): the order of ``engines.density``."""
    columns = [draws.ability @ zero_sum_basis(draws.ability.shape[1])]
    cut = np.zeros(len(draws.ability))
    for name in model.parameter_names:
        value = draws.parameters[name]
        if name.startswith("cut_"):
            value, cut = np.log(value - cut), value
        elif name == "subject_sd":
            value = np.log(value)
        columns.append(value[:, None])
    return np.ascontiguousarray(np.concatenate(columns, axis=1))


def _nodes(middle: FloatArray, data: NDArray[np.int64], n_own: int, n_nodes: int) -> _Nodes:
    """Quasi-random points about the most likely deviations of one person, at one place of the group's."""
    if not n_own:
        return _Nodes(np.zeros((1, 0)), np.zeros(1))
    x, slope = np.concatenate([middle, np.zeros(n_own)]), np.empty(len(middle) + n_own)

    def at(own: FloatArray) -> tuple[float, FloatArray]:
        x[len(middle) :] = own
        return log_density(x, slope, data), slope[len(middle) :].copy()

    def curvature(own: FloatArray) -> FloatArray:
        steps = _STEP * np.eye(n_own)
        rows = np.array([at(own - step)[1] - at(own + step)[1] for step in steps]) / (2 * _STEP)
        return np.asarray((rows + rows.T) / 2)

    # The density falls off to all sides (it is log-concave in a person's own coordinates): Newton's way is
    # short.
    best = np.zeros(n_own)
    for _ in range(_MOST_STEPS):
        value, gradient = at(best)
        step = np.linalg.solve(curvature(best), gradient)
        while at(best + step)[0] < value - _STEP:
            step = step / 2
        best = best + step
        if np.abs(step).max() < _STEP:
            break
    spread = _WIDER * np.linalg.inv(np.linalg.cholesky(curvature(best))).T
    normal = prior_nodes(n_own + 1, n_nodes) @ zero_sum_basis(n_own + 1)
    log_size = 0.5 * n_own * np.log(2 * np.pi) + np.log(np.abs(np.diag(spread))).sum()
    return _Nodes(best + normal @ spread.T, -0.5 * (normal**2).sum(axis=1) - log_size)


@compiled()
def _integrated(positions, nodes, log_nodes, data, nobody):  # type: ignore[no-untyped-def]  # pragma: no cover
    """Log of the mean over nodes of likelihood times prior over what the nodes were drawn from: (draw,)."""
    n_draws, n_global = positions.shape
    n_nodes, n_own = nodes.shape
    x, slope = np.zeros(n_global + n_own), np.zeros(n_global + n_own)
    found, logs = np.empty(n_draws), np.empty(n_nodes)
    for d in range(n_draws):
        x[:n_global] = positions[d]
        for n in range(n_nodes):
            x[n_global:] = nodes[n]
            logs[n] = log_density(x, slope, data) - log_nodes[n]
        top = logs.max()
        # Without answers, and at no deviation, the density is the group's prior: no part of the likelihood.
        x[n_global:] = 0.0
        prior = log_density(x, slope, nobody)
        found[d] = top + np.log(np.exp(logs - top).mean()) - 0.5 * n_own * np.log(2 * np.pi) - prior
    return found
