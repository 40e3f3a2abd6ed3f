"""The pseudo-inverse: exact where it can be, of least norm, unbounded near singularities."""

import numpy as np

RANK_TOLERANCE = 1e-10
"""Singular values below this share of the largest count as zero."""


def step(J: np.ndarray, e: np.ndarray) -> np.ndarray:
    """Joint step for a task error ``e``, shape (m,) -> (n,).

    References
    ----------
    Mulumbwa, eqs. (20) and (21); Beaudoin, Laliberte, Gosselin (2022), eqs. (6)-(8) and (18).
    """
    return np.linalg.pinv(J, rcond=RANK_TOLERANCE) @ e
