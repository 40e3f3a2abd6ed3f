"""Log posterior density and gradient of one question, compiled.

The position x of a sampler is ``[u (K-1), side_effect, log gaps | log_nu, log subject_sd, v (S, K-1)]``;
parts that a model lacks are left out. ``ability = basis @ u`` and ``z[s] = basis @ v[s]``, with the basis of
``analysis.zero_sum``.

A cell with counts n_0 .. n_L (from B much) adds, for every cut-point theta_k,
``n_k log logistic(theta_k - eta) + n_(k+1) log logistic(eta - theta_k)``, and every inner interval adds its
total count times ``log(1 - exp(-width))``. This form is exact, needs one exponential a cut-point, and skips
the cut-points no answer touches.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from analysis.model import CUT_GAP_SCALE, LOG_NU_SD, SIDE_EFFECT_SD, SUBJECT_SD_SCALE, Problem

HEADER = 8
"""Whole numbers at the start of the packed data: the sizes and switches below, in that order."""
_CELLS, _MODES, _PARTICIPANTS, _LEVELS, _ADJACENT, _HIERARCHICAL, _SIDE, _GAPS = range(HEADER)
N_REALS = 5
"""Prior scales that follow the header: abilities, side effect, gaps, log_nu, subject_sd."""

_NEAR_OVERFLOW = 1e200


def packed(problem: Problem) -> NDArray[np.int64]:
    """Everything the density reads, in one block of memory: what a raw pointer can name.

    Returns
    -------
    ndarray of int64, shape (HEADER + N_REALS + levels + cells * (3 + levels),)
        Header, prior scales (bits of float64), the total of every answer, then participant, A and B by
        cell, then the counts by cell; answers from B much to A much (the order of the cut-points).
    """
    counts, model = problem.counts, problem.model
    header = [
        len(counts.mode_a),
        len(counts.modes),
        len(counts.participants),
        counts.levels,
        model.link == "adjacent",
        model.hierarchical,
        model.side_effect,
        model.n_gaps,
    ]
    scales = np.array([model.prior_sd, SIDE_EFFECT_SD, CUT_GAP_SCALE, LOG_NU_SD, SUBJECT_SD_SCALE])
    ascending = counts.responses[:, ::-1]
    return np.concatenate(
        [
            np.array(header, dtype=np.int64),
            scales.view(np.int64),
            ascending.sum(axis=0),
            counts.participant,
            counts.mode_a,
            counts.mode_b,
            ascending.ravel(),
        ]
    )


@njit(cache=True, error_model="numpy", nogil=True, inline="always")
def _spread(u: NDArray[np.float64], scale: float, out: NDArray[np.float64]) -> None:
    """``out += scale * basis @ u`` in O(K)."""
    n = out.shape[0]
    total = 0.0
    for j in range(n - 1):
        total += u[j]
    root = np.sqrt(n)
    shift = total / (root + n)
    for j in range(n - 1):
        out[j] += scale * (u[j] - shift)
    out[n - 1] -= scale * total / root


@njit(cache=True, error_model="numpy", nogil=True, inline="always")
def _gather(g: NDArray[np.float64], scale: float, out: NDArray[np.float64]) -> None:
    """``out += scale * basis.T @ g`` in O(K): the adjoint of ``_spread``."""
    n = g.shape[0]
    total = 0.0
    for j in range(n - 1):
        total += g[j]
    root = np.sqrt(n)
    shift = total / (root + n) + g[n - 1] / root
    for j in range(n - 1):
        out[j] += scale * (g[j] - shift)


@njit(cache=True, error_model="numpy", nogil=True)
def log_density(x: NDArray[np.float64], gradient: NDArray[np.float64], data: NDArray[np.int64]) -> float:
    """Log posterior density, up to a constant of x, at ``x``; its gradient goes to ``gradient``.

    Parameters
    ----------
    x, gradient : ndarray, shape (n_dim,)
    data : ndarray of int64
        What ``packed`` returns.
    """
    n_cells, n_modes, n_participants = data[_CELLS], data[_MODES], data[_PARTICIPANTS]
    levels, n_gaps = data[_LEVELS], data[_GAPS]
    is_adjacent, is_hierarchical, has_side = data[_ADJACENT] == 1, data[_HIERARCHICAL] == 1, data[_SIDE] == 1
    scales = data[HEADER : HEADER + N_REALS].view(np.float64)
    totals = data[HEADER + N_REALS : HEADER + N_REALS + levels]
    cells = HEADER + N_REALS + levels
    participant = data[cells : cells + n_cells]
    mode_a = data[cells + n_cells : cells + 2 * n_cells]
    mode_b = data[cells + 2 * n_cells : cells + 3 * n_cells]
    counts = data[cells + 3 * n_cells : cells + (3 + levels) * n_cells]

    free = n_modes - 1
    gradient[:] = 0.0
    logp = 0.0
    for j in range(free):
        logp -= 0.5 * (x[j] / scales[0]) ** 2
        gradient[j] = -x[j] / scales[0] ** 2
    at = free
    side = 0.0
    at_side = at
    if has_side:
        side = x[at]
        logp -= 0.5 * (side / scales[1]) ** 2
        gradient[at] = -side / scales[1] ** 2
        at += 1

    at_shape = at
    theta = np.zeros(levels - 1)
    d_theta = np.zeros(levels - 1)
    log_nu = 0.0
    if is_adjacent:
        log_nu = x[at]
        logp -= 0.5 * (log_nu / scales[3]) ** 2
        gradient[at] = -log_nu / scales[3] ** 2
        at += 1
    else:
        cut = 0.0
        half = levels // 2
        for k in range(n_gaps):
            gap = np.exp(x[at])
            cut += gap
            theta[half + k] = cut
            theta[half - 1 - k] = -cut
            # HalfNormal on the gap, and the Jacobian of its logarithm.
            logp += x[at] - 0.5 * (gap / scales[2]) ** 2
            gradient[at] = 1.0 - (gap / scales[2]) ** 2
            at += 1

    spread = 0.0
    at_spread = at
    if is_hierarchical:
        spread = np.exp(x[at])
        logp += x[at] - 0.5 * (spread / scales[4]) ** 2
        gradient[at] = 1.0 - (spread / scales[4]) ** 2
        at += 1

    common = np.zeros(n_modes)
    _spread(x[:free], 1.0, common)
    d_common = np.zeros(n_modes)
    own = np.zeros(n_modes)
    d_own = np.zeros(n_modes)
    d_side = 0.0
    d_log_nu = 0.0
    d_spread = 0.0
    # Single answers share one logarithm: that of the product of their (1 + e).
    product = 1.0
    cell = 0
    for s in range(n_participants):
        start = at + s * free
        if is_hierarchical:
            own[:] = 0.0
            _spread(x[start : start + free], 1.0, own)
        d_own[:] = 0.0
        while cell < n_cells and participant[cell] == s:
            a, b = mode_a[cell], mode_b[cell]
            eta = common[a] - common[b] + side
            if is_hierarchical:
                eta += spread * (own[a] - own[b])
            row = cell * levels
            d_eta = 0.0
            if is_adjacent:
                lost, tied, won = counts[row], counts[row + 1], counts[row + 2]
                n = lost + tied + won
                top = max(abs(eta) / 2, log_nu)
                up, mid, down = np.exp(eta / 2 - top), np.exp(log_nu - top), np.exp(-eta / 2 - top)
                total = up + mid + down
                logp += (won - lost) * eta / 2 + tied * log_nu - n * (top + np.log(total))
                d_eta = 0.5 * (won - lost - n * (up - down) / total)
                d_log_nu += tied - n * mid / total
            else:
                for k in range(levels - 1):
                    below, above = counts[row + k], counts[row + k + 1]
                    if below + above == 0:
                        continue
                    t = theta[k] - eta
                    e = np.exp(-abs(t))
                    if t > 0.0:
                        rising = e / (1.0 + e)
                        logp -= above * t
                    else:
                        rising = 1.0 / (1.0 + e)
                        logp += below * t
                    if below + above == 1:
                        product *= 1.0 + e
                    else:
                        logp -= (below + above) * np.log1p(e)
                    # rising = 1 - logistic(t): the slope of log logistic(t).
                    slope = below * rising - above * (1.0 - rising)
                    d_theta[k] += slope
                    d_eta -= slope
            d_own[a] += d_eta
            d_own[b] -= d_eta
            d_side += d_eta
            if is_hierarchical:
                d_spread += d_eta * (own[a] - own[b])
            cell += 1
            if product > _NEAR_OVERFLOW:
                logp -= np.log(product)
                product = 1.0
        for j in range(n_modes):
            d_common[j] += d_own[j]
        if is_hierarchical:
            for j in range(start, start + free):
                logp -= 0.5 * x[j] * x[j]
                gradient[j] = -x[j]
            _gather(d_own, spread, gradient[start : start + free])

    logp -= np.log(product)

    _gather(d_common, 1.0, gradient[:free])
    if has_side:
        gradient[at_side] += d_side
    if is_adjacent:
        gradient[at_shape] += d_log_nu
    else:
        for k in range(1, levels - 1):
            width = theta[k] - theta[k - 1]
            logp += totals[k] * np.log(-np.expm1(-width))
            pull = totals[k] / np.expm1(width)
            d_theta[k] += pull
            d_theta[k - 1] -= pull
        half = levels // 2
        for j in range(n_gaps):
            total = 0.0
            for k in range(j, n_gaps):
                total += d_theta[half + k] - d_theta[half - 1 - k]
            gradient[at_shape + j] += np.exp(x[at_shape + j]) * total
    if is_hierarchical:
        gradient[at_spread] += spread * d_spread
    return logp
