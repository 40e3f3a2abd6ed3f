"""Log-likelihood of all cells, and its slopes, compiled for several cells at a time.

A cell with counts n_0 .. n_L (from B much) adds, for every cut-point theta_k,
``n_k log logistic(theta_k - eta) + n_(k+1) log logistic(eta - theta_k)``, and every inner interval adds its
total count times ``log(1 - exp(-width))``. This form is exact and needs one exponential a cut-point.
"""

import numpy as np
from numpy.typing import NDArray

from analysis.engines.compiled import REGROUPED, compiled
from analysis.engines.exponential import exp, log_between_1_and_2

_BLOCK = 256
"""Cells at a time: what is known of them stays in the processor's nearest memory."""
_FURTHEST = 700.0
"""Beyond this distance from a cut-point an exponential counts as that of this distance [logit]."""

Floats = NDArray[np.float64]


@compiled(REGROUPED)
def cumulative(
    eta: Floats, counts: Floats, totals: Floats, theta: Floats, d_eta: Floats, d_theta: Floats
) -> float:
    """Log-likelihood under the cumulative link.

    Parameters
    ----------
    eta : ndarray, shape (cell,)
    counts : ndarray, shape (level * cell,)
        By level, from B much to A much, then by cell.
    totals : ndarray, shape (level,)
        Sums of ``counts`` over the cells.
    theta : ndarray, shape (level - 1,)
    d_eta, d_theta : ndarray, shapes (cell,) and (level - 1,)
        Slopes are written here.
    """
    n_cells, n_cuts = eta.shape[0], theta.shape[0]
    value = 0.0
    d_theta[:] = 0.0
    for start in range(0, n_cells, _BLOCK):
        stop = min(start + _BLOCK, n_cells)
        here, slope = eta[start:stop], d_eta[start:stop]
        slope[:] = 0.0
        for k in range(n_cuts):
            cut, row = theta[k], k * n_cells
            below = counts[row + start : row + stop]
            above = counts[row + n_cells + start : row + n_cells + stop]
            push = 0.0
            for i in range(stop - start):
                t = cut - here[i]
                e = exp(-min(abs(t), _FURTHEST))
                value += below[i] * min(t, 0.0) - above[i] * max(t, 0.0)
                value -= (below[i] + above[i]) * log_between_1_and_2(1.0 + e)
                # The slopes of log logistic(t) and of log logistic(-t), without a difference of near equals.
                near = 1.0 / (1.0 + e)
                far = e * near
                pull = below[i] * (far if t > 0.0 else near) - above[i] * (near if t > 0.0 else far)
                slope[i] -= pull
                push += pull
            d_theta[k] += push
    for k in range(1, n_cuts):
        width = theta[k] - theta[k - 1]
        value += totals[k] * np.log(-np.expm1(-width))
        pull = totals[k] / np.expm1(width)
        d_theta[k] += pull
        d_theta[k - 1] -= pull
    return value


@compiled(REGROUPED)
def adjacent(eta: Floats, counts: Floats, log_nu: float, d_eta: Floats, d_log_nu: Floats) -> float:
    """Log-likelihood under the adjacent link (Davidson's ties).

    Parameters
    ----------
    eta : ndarray, shape (cell,)
    counts : ndarray, shape (3 * cell,)
        Those that preferred B, all ties, those that preferred A.
    d_eta, d_log_nu : ndarray, shapes (cell,) and (1,)
        Slopes are written here.
    """
    value = 0.0
    push = 0.0
    n_cells = eta.shape[0]
    for i in range(n_cells):
        lost, tied, won = counts[i], counts[n_cells + i], counts[2 * n_cells + i]
        n = lost + tied + won
        half = 0.5 * eta[i]
        top = max(abs(half), log_nu)
        up = exp(max(half - top, -_FURTHEST))
        middle = exp(max(log_nu - top, -_FURTHEST))
        down = exp(max(-half - top, -_FURTHEST))
        total = up + middle + down
        value += (won - lost) * half + tied * log_nu - n * (top + np.log(total))
        d_eta[i] = 0.5 * (won - lost - n * (up - down) / total)
        push += tied - n * middle / total
    d_log_nu[0] = push
    return value
