"""The highest point of the pooled likelihood or posterior, by Newton's method with exact second derivatives.

Maximum likelihood is what the literature on paired comparisons prints; a maximum is not a posterior mean.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from analysis.counts import Counts
from analysis.model import (
    CUT_GAP_SCALE,
    LOG_NU_SD,
    SIDE_EFFECT_SD,
    Model,
    adjacent_log_probabilities,
    cumulative_log_probabilities,
    thresholds,
)
from analysis.zero_sum import zero_sum_basis
from data.errors import ElbowroomError

MAX_STEPS = 100
"""Newton steps before giving up; about ten are needed."""
RUNAWAY = 20.0
"""A coordinate beyond this is on its way to infinity [logit]."""

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Estimate:
    """A maximum and the curvature there.

    Attributes
    ----------
    modes : tuple of str
        Sorted by name; the order of the arrays.
    ability : ndarray, shape (mode,)
        Sums to 0 [logit].
    ability_covariance : ndarray, shape (mode, mode)
        Inverse of the negative curvature, projected on the vectors that sum to 0.
    parameters, parameter_sd : dict of str to float
        ``side_effect``, ``log_gap_1``, ``log_gap_2`` and so on, ``log_nu``: those the model has. For three
        levels ``log_gap_1`` is the log of Rao-Kupper's log theta.
    log_likelihood : float
        Without multinomial coefficients.
    """

    modes: tuple[str, ...]
    ability: FloatArray
    ability_covariance: FloatArray
    parameters: dict[str, float]
    parameter_sd: dict[str, float]
    log_likelihood: float


def maximum_a_posteriori(counts: Counts, model: Model) -> Estimate:
    """The highest point of the pooled posterior, in the coordinates that the samplers use."""
    return _maximum(counts, model, has_priors=True)


def maximum_likelihood(counts: Counts, model: Model) -> Estimate:
    """The highest point of the pooled likelihood.

    Raises
    ------
    ElbowroomError
        If the likelihood has no highest point: modes that are not connected by wins, no ties.
    """
    return _maximum(counts, model, has_priors=False)


def _maximum(counts: Counts, model: Model, *, has_priors: bool) -> Estimate:
    cells = counts.pooled()
    model = model.plain.alike
    names = list(model.parameter_names(cells.modes))
    design = _design(cells, model)
    n_free = len(cells.modes) - 1
    x = np.zeros(n_free + len(names))
    step_size = np.inf
    for _ in range(MAX_STEPS):
        value, gradient, curvature = _surface(x, cells, model, design, has_priors)
        step = _ascent(curvature, gradient)
        scale = 1.0
        while scale > 1e-10:
            there = _surface(x + scale * step, cells, model, design, has_priors)[0]
            if there >= value - 1e-12 * (1.0 + abs(value)):
                break
            scale /= 2
        x = x + scale * step
        step_size = float(np.abs(scale * step).max())
        if step_size < 1e-10 or np.abs(x).max() > RUNAWAY:
            break
    if step_size >= 1e-6 or np.abs(x).max() > RUNAWAY:
        raise ElbowroomError("the answers have no most likely ranking: a mode that always wins, or no ties")
    _, _, curvature = _surface(x, cells, model, design, has_priors)
    covariance = np.linalg.inv(-curvature)
    basis = zero_sum_basis(n_free + 1)
    sd = np.sqrt(np.diag(covariance))
    shown = [name.replace("cut_", "log_gap_") for name in names]
    bare = _surface(x, cells, model, design, False)[0]
    return Estimate(
        cells.modes,
        basis @ x[:n_free],
        basis @ covariance[:n_free, :n_free] @ basis.T,
        {name: float(v) for name, v in zip(shown, x[n_free:], strict=True)},
        {name: float(v) for name, v in zip(shown, sd[n_free:], strict=True)},
        float(bare),
    )


def _design(cells: Counts, model: Model) -> FloatArray:
    """``eta = design @ (u, side_effect)``, shape (cell, mode - 1 (+ 1))."""
    basis = zero_sum_basis(len(cells.modes))
    contrast = basis[cells.mode_a] - basis[cells.mode_b]
    return np.column_stack([contrast, np.ones(len(contrast))]) if model.side_effect else contrast


def _surface(
    x: FloatArray, cells: Counts, model: Model, design: FloatArray, has_priors: bool
) -> tuple[float, FloatArray, FloatArray]:
    """Value, gradient and second derivatives of the log-likelihood or log-posterior at ``x``."""
    n_linear = design.shape[1]
    eta = design @ x[:n_linear]
    value, d_eta, d_shape, d2 = (
        _adjacent(eta, x[n_linear:], cells.responses)
        if model.link == "adjacent"
        else _cumulative(eta, x[n_linear:], cells.responses)
    )
    # d2 has shape (1 + shape, 1 + shape, cell): second derivatives in eta and the shape parameters.
    gradient = np.concatenate([design.T @ d_eta, d_shape.sum(axis=1)])
    curvature = np.empty((len(x), len(x)))
    curvature[:n_linear, :n_linear] = design.T @ (d2[0, 0][:, None] * design)
    curvature[:n_linear, n_linear:] = design.T @ d2[0, 1:].T
    curvature[n_linear:, :n_linear] = curvature[:n_linear, n_linear:].T
    curvature[n_linear:, n_linear:] = d2[1:, 1:].sum(axis=2)
    if has_priors:
        value += _add_priors(x, model, len(cells.modes) - 1, gradient, curvature)
    return float(value), gradient, curvature


def _cumulative(
    eta: FloatArray, log_gaps: FloatArray, responses: NDArray[np.int64]
) -> tuple[float, FloatArray, FloatArray, FloatArray]:
    """The cumulative link by cell: value, slopes in eta and in the log-gaps, second derivatives."""
    levels, n_gaps = responses.shape[1], len(log_gaps)
    gaps = np.exp(log_gaps)
    cuts = np.cumsum(gaps)
    value = (responses * cumulative_log_probabilities(eta, cuts, levels)).sum()
    ascending = responses[:, ::-1]
    below, above = ascending[:, :-1], ascending[:, 1:]
    theta = thresholds(cuts, levels)
    t = theta - eta[:, None]
    p = expit(t)
    slope, bend = below * (1.0 - p) - above * p, -(below + above) * p * (1.0 - p)
    # How each cut-point moves with each log-gap: shape (gap, cut-point).
    moves = gaps[:, None] * thresholds(np.tri(n_gaps).T, levels)
    d_eta = -slope.sum(axis=1)
    d_shape = moves @ slope.T
    d2 = np.empty((1 + n_gaps, 1 + n_gaps, len(eta)))
    d2[0, 0] = bend.sum(axis=1)
    d2[0, 1:] = d2[1:, 0] = -(moves @ bend.T)
    for j in range(n_gaps):
        for k in range(n_gaps):
            d2[1 + j, 1 + k] = (bend * moves[j] * moves[k]).sum(axis=1)
        d2[1 + j, 1 + j] += slope @ moves[j]
    # The widths of the inner intervals: 2 gap_1 for ties, a gap on either side for every other.
    half = levels // 2
    for j in range(n_gaps):
        is_tie = j == 0 and levels % 2 == 1
        width = gaps[j] * (2.0 if is_tie else 1.0)
        inner = half - j - 1 + levels % 2
        inside = responses[:, half] if is_tie else responses[:, inner] + responses[:, levels - 1 - inner]
        pull = width / np.expm1(width)
        d_shape[j] += inside * pull
        d2[1 + j, 1 + j] += inside * pull * (1.0 - pull * np.exp(width))
    return float(value), d_eta, d_shape, d2


def _adjacent(
    eta: FloatArray, shape: FloatArray, responses: NDArray[np.int64]
) -> tuple[float, FloatArray, FloatArray, FloatArray]:
    """Davidson's model by cell: value, slopes in eta and log nu, second derivatives."""
    log_p = adjacent_log_probabilities(eta, shape[0])
    won, tied, lost = np.moveaxis(np.exp(log_p), -1, 0)
    n = responses.sum(axis=1)
    lead = won - lost
    d_eta = 0.5 * (responses[:, 0] - responses[:, 2] - n * lead)
    d_shape = (responses[:, 1] - n * tied)[None]
    d2 = np.empty((2, 2, len(eta)))
    d2[0, 0] = -0.25 * n * (won + lost - lead**2)
    d2[0, 1] = d2[1, 0] = 0.5 * n * tied * lead
    d2[1, 1] = -n * tied * (1.0 - tied)
    return float((responses * log_p).sum()), d_eta, d_shape, d2


def _add_priors(
    x: FloatArray, model: Model, n_free: int, gradient: FloatArray, curvature: FloatArray
) -> float:
    """Add the priors' slopes in place; returns their log-density at ``x`` up to a constant."""
    scales = [model.prior_sd] * n_free + ([SIDE_EFFECT_SD] if model.side_effect else [])
    scales += [LOG_NU_SD] if model.link == "adjacent" else []
    n = len(scales)
    weights = 1.0 / np.square(scales)
    value = -0.5 * float(weights @ x[:n] ** 2)
    gradient[:n] -= weights * x[:n]
    curvature[np.arange(n), np.arange(n)] -= weights
    for j in range(n, n + model.n_gaps):
        square = (np.exp(x[j]) / CUT_GAP_SCALE) ** 2
        # HalfNormal on the gap, and the Jacobian of its logarithm.
        value += float(x[j] - 0.5 * square)
        gradient[j] += 1.0 - square
        curvature[j, j] -= 2.0 * square
    return value


def _ascent(curvature: FloatArray, gradient: FloatArray) -> FloatArray:
    """Newton's step, turned uphill where the surface is not concave."""
    values, vectors = np.linalg.eigh(curvature)
    steep = np.maximum(np.abs(values), 1e-9 * np.abs(values).max())
    step = vectors @ ((vectors.T @ gradient) / steep)
    return step * min(1.0, 5.0 / max(float(np.abs(step).max()), 1e-300))
