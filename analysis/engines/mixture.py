"""Log-likelihood of all cells where answers may be careless or people use the scale by widths of their own.

An answer has the chance ``q = (1 - lapse) p + lapse / levels`` with the model's own chance ``p``. Under the
cumulative link an inner ``p`` is ``logistic(u) logistic(-l) (1 - exp(l - u))``, never a difference.
``likelihood.py`` is the faster form of the same without either.
"""

import numpy as np
from numpy.typing import NDArray

from analysis.engines.compiled import REGROUPED, compiled
from analysis.engines.exponential import exp, log

_FURTHEST = 700.0
"""Beyond this distance from a cut-point an exponential counts as that of this distance [logit]."""
_LEAST = 1e-300
"""Least chance of an answer."""

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@compiled(REGROUPED)
def _logistic(t: float) -> tuple[float, float]:
    """``logistic(t)`` and its slope, without a difference of near equals."""
    e = exp(-min(abs(t), _FURTHEST))
    near = 1.0 / (1.0 + e)
    far = e * near
    return (near if t > 0.0 else far), near * far


@compiled(REGROUPED)
def mixed_cumulative(
    eta: Floats,
    counts: Floats,
    theta: Floats,
    lapse: float,
    width: Floats,
    person: Integers,
    d_eta: Floats,
    d_theta: Floats,
    d_lapse: Floats,
    d_width: Floats,
) -> float:
    """Log-likelihood under the cumulative link.

    Parameters
    ----------
    eta : ndarray, shape (cell,)
    counts : ndarray, shape (level * cell,)
        By level, from B much to A much, then by cell.
    theta : ndarray, shape (level - 1,)
    lapse : float
        Share of careless answers, 0 if there are none.
    width : ndarray, shape (participant,) or (1,)
        Log of what the cut-points of each participant, or of all, are multiplied by.
    person : ndarray of int64, shape (cell,)
    d_eta, d_theta, d_lapse, d_width : ndarray, shapes (cell,), (level - 1,), (1,) and that of ``width``
        Slopes are written to the first two and added to the others.
    """
    n_cells, n_cuts = eta.shape[0], theta.shape[0]
    levels, stride = n_cuts + 1, (1 if width.shape[0] > 1 else 0)
    keep, floor = 1.0 - lapse, lapse / levels
    factors, inside = np.exp(width), np.ones((width.shape[0], levels))
    for s in range(width.shape[0]):
        for k in range(1, n_cuts):
            inside[s, k] = -np.expm1((theta[k - 1] - theta[k]) * factors[s])
    value, careless = 0.0, 0.0
    d_eta[:], d_theta[:] = 0.0, 0.0
    for k in range(levels):
        push_up, push_down = 0.0, 0.0
        for i in range(n_cells):
            n = counts[k * n_cells + i]
            # Most cells hold one answer, so that most counts are 0.
            if n == 0.0:
                continue
            s = stride * person[i]
            below, above, bend_up, bend_down = 1.0, 1.0, 0.0, 0.0
            if k < n_cuts:
                below, bend_up = _logistic(theta[k] * factors[s] - eta[i])
            if k > 0:
                above, bend_down = _logistic(eta[i] - theta[k - 1] * factors[s])
            p = below * above * inside[s, k]
            q = max(keep * p + floor, _LEAST)
            weight = n / q
            value += n * log(q)
            careless += weight * (1.0 / levels - p)
            up, down = keep * weight * bend_up, keep * weight * bend_down
            d_eta[i] += down - up
            push_up += factors[s] * up
            push_down += factors[s] * down
            d_width[s] += factors[s] * (theta[min(k, n_cuts - 1)] * up - theta[max(k - 1, 0)] * down)
        d_theta[min(k, n_cuts - 1)] += push_up
        d_theta[max(k - 1, 0)] -= push_down
    d_lapse[0] += careless
    return value


@compiled(REGROUPED)
def mixed_adjacent(
    eta: Floats,
    counts: Floats,
    log_nu: float,
    lapse: float,
    width: Floats,
    person: Integers,
    d_eta: Floats,
    d_log_nu: Floats,
    d_lapse: Floats,
    d_width: Floats,
) -> float:
    """Log-likelihood under the adjacent link, each participant with ``log_nu + width``.

    Takes what ``mixed_cumulative`` takes, with ``log_nu`` instead of cut-points.
    """
    n_cells, stride = eta.shape[0], (1 if width.shape[0] > 1 else 0)
    keep, floor = 1.0 - lapse, lapse / 3.0
    value, careless, push = 0.0, 0.0, 0.0
    for i in range(n_cells):
        lost, tied, won = counts[i], counts[n_cells + i], counts[2 * n_cells + i]
        half, middle = 0.5 * eta[i], log_nu + width[stride * person[i]]
        top = max(abs(half), middle)
        up = exp(max(half - top, -_FURTHEST))
        same = exp(max(middle - top, -_FURTHEST))
        down = exp(max(-half - top, -_FURTHEST))
        total = up + same + down
        up, same, down = up / total, same / total, down / total
        q_up = max(keep * up + floor, _LEAST)
        q_same = max(keep * same + floor, _LEAST)
        q_down = max(keep * down + floor, _LEAST)
        value += won * log(q_up) + tied * log(q_same) + lost * log(q_down)
        won, tied, lost = won / q_up, tied / q_same, lost / q_down
        mean = won * up + tied * same + lost * down
        careless += (won + tied + lost) / 3.0 - mean
        d_eta[i] = 0.5 * keep * (up * (won - mean) - down * (lost - mean))
        pull = keep * same * (tied - mean)
        push += pull
        d_width[stride * person[i]] += pull
    d_log_nu[0] += push
    d_lapse[0] += careless
    return value
