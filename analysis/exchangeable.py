"""Ranks of one set of answers among others that are exchangeable with it, whatever quantity is compared.

References
----------
Westfall & Young 1993, "Resampling-based multiple testing" (sizes that are comparable from check to check, and
the largest of them).
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

FloatArray = NDArray[np.float64]


def residuals(values: FloatArray, predictors: FloatArray) -> FloatArray:
    spread = predictors.std(axis=0)
    design = np.column_stack([np.ones(len(predictors)), predictors[:, spread > 0] / spread[spread > 0]])
    return np.asarray(values - design @ np.linalg.lstsq(design, values, rcond=1e-9)[0])


def chances(residual: FloatArray, one_sided: NDArray[np.bool_]) -> FloatArray:
    """p of every set among all sets, (set, check); equal values count against it."""
    n = len(residual)
    rounded = np.round(residual, 9)
    above = np.empty_like(residual)
    below = np.empty_like(residual)
    for k, column in enumerate(rounded.T):
        ordered = np.sort(column)
        above[:, k] = n - np.searchsorted(ordered, column, side="left")
        below[:, k] = np.searchsorted(ordered, column, side="right")
    return np.where(one_sided, above / n, np.minimum(1.0, 2 * np.minimum(above, below) / n))


def sizes(residual: FloatArray, one_sided: NDArray[np.bool_], tail_mass: float) -> FloatArray:
    """How far out every set is, in units of that side's spread: comparable from check to check."""
    off = residual - np.median(residual, axis=0)
    tail = np.where(one_sided, tail_mass, tail_mass / 2)
    edges = [np.diagonal(np.quantile(off, t, axis=0)) for t in (tail, 1 - tail)]
    low, high = (np.maximum(abs(edge) / -ndtri(tail), 1e-12) for edge in edges)
    return np.asarray(np.where(off > 0, off / high, np.where(one_sided, 0.0, -off / low)))
