"""One person's deviations given the group's parameters: points with weights, draw by draw.

A person's deviations are drawn from a normal distribution laid over their posterior in the middle of the
group's (Laplace). What that says of the answers, taken as one normal observation of the person's own
abilities, moves the distribution to every other draw of the group's parameters, and weights put right what is
not normal: a few points then serve any number of modes and of answers. The density is the sampler's own, so
nothing of the model is written a second time.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp, ndtri

from analysis.answer_shares import ThinnedDraws
from analysis.counts import Counts
from analysis.engines.compiled import compiled
from analysis.engines.coordinates import Quantities, position_of
from analysis.engines.density import log_density, packed
from analysis.model import Model, Problem

FloatArray = NDArray[np.float64]
NODES = 32
_WIDER = 1.05
"""Factor on the spread of the points: what they stand for has wider tails than a normal. Untuned."""
_EDGE = 1e-9
"""As near as a point comes to the end of its strip: the outermost end at infinity."""
_STEP = 1e-4
_MOST_STEPS = 30


@dataclass(frozen=True)
class Deviations:
    """Points of one person's deviations with their weights.

    Attributes
    ----------
    at : ndarray, shape (draw, node, own)
        In the coordinates of ``zero_sum_basis``, in units of ``subject_sd``, then the person's own side and
        width in units of their spreads, where the model has them; none if the model knows no deviations.
    log_weight : ndarray, shape (draw, node)
        Log of the likelihood of the person's answers times the density of the deviations in the group, over
        the density that the points were drawn from.
    """

    at: FloatArray
    log_weight: FloatArray

    @property
    def log_likelihood(self) -> FloatArray:
        """Of the person's answers, own deviations integrated out: shape (draw,)."""
        return np.asarray(logsumexp(self.log_weight, axis=1) - np.log(self.log_weight.shape[1]))


def deviations(
    counts: Counts,
    model: Model,
    draws: ThinnedDraws,
    n_nodes: int = NODES,
    rng: np.random.Generator | None = None,
) -> Iterator[Deviations]:
    """Deviations of one participant after another, in the order of ``counts.participants``.

    Parameters
    ----------
    counts : Counts
        By participant, also where the model takes them together.
    draws : ThinnedDraws
        Abilities in the order of ``counts.modes``.
    rng : Generator, optional
        To draw the points anew at every draw, each anywhere in its strip: points to choose from must reach
        the tails, which the middles of 16 strips cut at 1.9 sd. A likelihood is steadier with the middles.
    """
    positions = position_of(Quantities(draws.ability, draws.parameters), model, counts.modes)
    everyone = np.arange(len(counts.participants))
    nobody = packed(Problem(_silent(of_people(counts, everyone == 0)), model))
    n_own = Problem(counts, model).n_own
    prior = _log_densities(positions, np.zeros((len(positions), 1, n_own)), nobody)
    normal = spread_normal(n_own, n_nodes) if n_own else np.zeros((1, 0))
    for s in everyone:
        if rng is not None and n_own:
            normal = spread_normal(n_own, n_nodes, rng.random((len(positions), n_nodes, n_own)))
        own = packed(Problem(of_people(counts, everyone == s), model))
        at, log_size = _moved(_laplace(positions, own, n_own), positions, normal, model)
        log_weight = _log_densities(positions, at, own) - prior + 0.5 * (normal**2).sum(axis=-1)
        yield Deviations(at, log_weight + log_size[:, None])


def log_likelihoods(counts: Counts, model: Model, draws: ThinnedDraws, n_nodes: int = NODES) -> FloatArray:
    """Log-likelihood of every participant's answers at every draw, own deviations integrated out.

    Takes what ``deviations`` takes.

    Returns
    -------
    ndarray, shape (participant, draw)
    """
    return np.stack([person.log_likelihood for person in deviations(counts, model, draws, n_nodes)])


def spread_normal(n_dim: int, n: int, within: float | FloatArray = 0.5) -> FloatArray:
    """Points of a standard normal, one in each of ``n`` strips of equal chance, whatever the direction.

    Parameters
    ----------
    within : float or ndarray, shape (..., n, n_dim)
        Where in its strip each point lies, 0 to 1.

    Returns
    -------
    ndarray, shape (n, n_dim), or that of ``within``

    References
    ----------
    McKay, Beckman, Conover 1979, "A comparison of three methods for selecting values of input variables"
    (Latin hypercube).
    """
    rng = np.random.default_rng(1979)
    strips = rng.permuted(np.tile(np.arange(n), (n_dim, 1)), axis=1)
    return np.asarray(ndtri((strips.T + np.clip(within, _EDGE, 1.0 - _EDGE)) / n))


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
        order=None if counts.order is None else counts.order[kept],
    )


def _silent(counts: Counts) -> Counts:
    """The same people without an answer."""
    return replace(
        counts,
        participant=counts.participant[:0],
        mode_a=counts.mode_a[:0],
        mode_b=counts.mode_b[:0],
        responses=counts.responses[:0],
        order=None if counts.order is None else counts.order[:0],
    )


@dataclass(frozen=True)
class _Laplace:
    """The posterior of a person's deviations in the middle of the group's, as a normal distribution.

    Attributes
    ----------
    best : ndarray, shape (own,)
        Most likely deviations.
    axes : ndarray, shape (own, own)
        Orthonormal; a column a direction in which they are independent.
    precision : ndarray, shape (own,)
        Along the axes; 1 or more, as 1 is what is known before any answer.
    """

    middle: FloatArray
    best: FloatArray
    axes: FloatArray
    precision: FloatArray


def _laplace(positions: FloatArray, data: NDArray[np.int64], n_own: int) -> _Laplace:
    """Newton's way to the most likely deviations.

    It is short: without options the density is log-concave in a person's own coordinates. Where lapses and
    widths bend it the other way, a step that would go down is one along the slope instead.
    """
    middle = positions.mean(axis=0)
    x, slope = np.concatenate([middle, np.zeros(n_own)]), np.empty(len(middle) + n_own)

    def at(own: FloatArray) -> tuple[float, FloatArray]:
        x[len(middle) :] = own
        return log_density(x, slope, data), slope[len(middle) :].copy()

    def curvature(own: FloatArray) -> FloatArray:
        steps = _STEP * np.eye(n_own)
        rows = np.array([at(own - step)[1] - at(own + step)[1] for step in steps]) / (2 * _STEP)
        return np.asarray((rows + rows.T) / 2)

    best = np.zeros(n_own)
    for _ in range(_MOST_STEPS if n_own else 0):
        value, gradient = at(best)
        step = np.linalg.solve(curvature(best), gradient)
        if step @ gradient < 0:
            step = gradient
        while at(best + step)[0] < value - _STEP:
            step = step / 2
        best = best + step
        if np.abs(step).max() < _STEP:
            break
    precision, axes = np.linalg.eigh(curvature(best)) if n_own else (np.empty(0), np.empty((0, 0)))
    return _Laplace(middle, best, axes, np.maximum(precision, 1.0))


def _moved(
    found: _Laplace, positions: FloatArray, normal: FloatArray, model: Model
) -> tuple[FloatArray, FloatArray]:
    """Points of the deviations at every draw, (draw, node, own), and the log of what they spread over.

    With ``d = sd z`` a person's deviations on the scale of abilities, the answers are one observation of
    ``ability + d`` with precision ``p``. So at other abilities and another sd z is still normal: with
    precision ``1 + sd^2 p``, about ``sd (p d - p (ability - middle)) / (1 + sd^2 p)``.
    """
    n_own = len(found.best)
    if not n_own:
        return np.zeros((len(positions), 1, 0)), np.zeros(len(positions))
    if model.n_own:
        return _moved_each(found, positions, normal, model)
    sd, middle_sd = np.exp(positions[:, -1:]), np.exp(found.middle[-1])
    said = (found.precision - 1.0) / middle_sd**2
    pull = found.precision * (found.axes.T @ found.best) / middle_sd
    apart = (positions[:, :n_own] - found.middle[:n_own]) @ found.axes
    precision = 1.0 + sd**2 * said
    centre = sd * (pull - said * apart) / precision
    spread = _WIDER / np.sqrt(precision)
    at = (centre[:, None] + spread[:, None] * normal) @ found.axes.T
    return np.ascontiguousarray(at), np.log(spread).sum(axis=1)


def _moved_each(
    found: _Laplace, positions: FloatArray, normal: FloatArray, model: Model
) -> tuple[FloatArray, FloatArray]:
    """The same where the deviations have spreads of their own: ``d = D o`` with a diagonal ``D``.

    The answers are then an observation of ``d + e`` with precision ``P``, where ``e`` is how far abilities
    and side effect are from the middle: o has the precision ``I + D P D``, about its inverse times
    ``D (h - P e)`` where ``h`` is the slope at no deviation.
    """
    n_own, n_extra = len(found.best), model.n_own
    free = n_own - n_extra

    def spreads(at: FloatArray) -> FloatArray:
        last = np.exp(at[..., at.shape[-1] - 1 - n_extra :])
        return np.concatenate([np.repeat(last[..., :1], free, axis=-1), last[..., 1:]], axis=-1)

    sd, middle_sd = spreads(positions), spreads(found.middle)
    curved = (found.axes * found.precision) @ found.axes.T
    said = (curved - np.eye(n_own)) / np.outer(middle_sd, middle_sd)
    apart = np.zeros((len(positions), n_own))
    known = free + (model.person_side and model.side_effect)
    apart[:, :known] = positions[:, :known] - found.middle[:known]
    pull = sd * ((curved @ found.best) / middle_sd - apart @ said)
    lower = np.linalg.cholesky(np.eye(n_own) + sd[:, :, None] * said * sd[:, None, :])
    upper = np.swapaxes(lower, 1, 2)
    centre = np.linalg.solve(upper, np.linalg.solve(lower, pull[..., None]))
    at = np.swapaxes(centre + _WIDER * np.linalg.solve(upper, np.swapaxes(normal, -1, -2)), 1, 2)
    size = n_own * np.log(_WIDER) - np.log(np.diagonal(lower, axis1=1, axis2=2)).sum(axis=1)
    return np.ascontiguousarray(at), size


@compiled()
def _log_densities(positions, at, data):  # type: ignore[no-untyped-def]  # pragma: no cover
    """The sampler's log density at every draw's points: (draw, node)."""
    n_draws, n_nodes, n_own = at.shape
    n_global = positions.shape[1]
    x, slope = np.zeros(n_global + n_own), np.zeros(n_global + n_own)
    found = np.empty((n_draws, n_nodes))
    for d in range(n_draws):
        x[:n_global] = positions[d]
        for n in range(n_nodes):
            x[n_global:] = at[d, n]
            found[d, n] = log_density(x, slope, data)
    return found
