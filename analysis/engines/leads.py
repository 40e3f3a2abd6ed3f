"""Leads of A over B, cell by cell, and their slopes, compiled."""

import numpy as np
from numpy.typing import NDArray

from analysis.engines.compiled import REGROUPED, compiled

Floats = NDArray[np.float64]
Places = NDArray[np.uint32]


@compiled(REGROUPED)
def set_leads(own: Floats, a: Places, b: Places, side: float, eta: Floats) -> None:
    """``eta = own[a] - own[b] + side``, cell by cell."""
    for i in range(eta.shape[0]):
        eta[i] = own[a[i]] - own[b[i]] + side


@compiled(REGROUPED)
def add_slopes(d_eta: Floats, a: Places, b: Places, d_own: Floats) -> float:
    """The adjoint of ``set_leads``; returns the slope in ``side``."""
    total = 0.0
    for i in range(d_eta.shape[0]):
        d_own[a[i]] += d_eta[i]
        d_own[b[i]] -= d_eta[i]
        total += d_eta[i]
    return total


@compiled(REGROUPED)
def add_options(
    eta: Floats,
    a: Places,
    b: Places,
    person: NDArray[np.int64],
    order: Floats,
    n_modes: int,
    own_side: Floats,
    drift: float,
    learning: Floats,
) -> None:
    """``eta += own_side[person] + drift t + learning[A] x_A - learning[B] x_B``, cell by cell.

    Parameters
    ----------
    a, b : ndarray of uint32, shape (cell,)
        participant * n_modes + mode.
    order : ndarray, shape (3 * cell,)
        ``t``, ``x_A`` and ``x_B``.
    own_side : ndarray, shape (participant,)
        Empty if the model has none.
    learning : ndarray, shape (mode,)
        Empty if the model has no position.
    """
    n = eta.shape[0]
    if own_side.shape[0] > 0:
        for i in range(n):
            eta[i] += own_side[person[i]]
    if learning.shape[0] > 0:
        for i in range(n):
            first = person[i] * n_modes
            gained = order[n + i] * learning[a[i] - first] - order[2 * n + i] * learning[b[i] - first]
            eta[i] += drift * order[i] + gained


@compiled(REGROUPED)
def add_option_slopes(
    d_eta: Floats,
    a: Places,
    b: Places,
    person: NDArray[np.int64],
    order: Floats,
    n_modes: int,
    d_own_side: Floats,
    d_learning: Floats,
) -> float:
    """The adjoint of ``add_options``; returns the slope in ``drift``."""
    n, total = d_eta.shape[0], 0.0
    if d_own_side.shape[0] > 0:
        for i in range(n):
            d_own_side[person[i]] += d_eta[i]
    if d_learning.shape[0] > 0:
        for i in range(n):
            first = person[i] * n_modes
            d_learning[a[i] - first] += order[n + i] * d_eta[i]
            d_learning[b[i] - first] -= order[2 * n + i] * d_eta[i]
            total += order[i] * d_eta[i]
    return total
