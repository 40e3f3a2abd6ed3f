"""The transpose in place of the inverse: the task error pulls at the arm like a force."""

import numpy as np


def step(J: np.ndarray, e: np.ndarray) -> np.ndarray:
    """Joint step along J^T e of the length that leaves the smallest error, shape (m,) -> (n,).

    What is left of the error is orthogonal to the motion made. Nothing moves where J^T e vanishes.

    References
    ----------
    Beaudoin, Laliberte, Gosselin (2022), eqs. (11) and (13); Mulumbwa, eq. (22).
    """
    pull = J.T @ e
    motion = J @ pull
    length = motion @ motion
    return pull * ((e @ motion) / length) if length > np.finfo(float).tiny else np.zeros(J.shape[1])
