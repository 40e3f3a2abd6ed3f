"""Singular values damped one by one, the small ones more."""

import numpy as np


def damping_squared(sigma: np.ndarray, damping: float) -> np.ndarray:
    """Squared damping of each singular value: lambda^2 at zero, falling smoothly to none at one.

    References
    ----------
    Beaudoin, Laliberte, Gosselin (2022), eq. (29). As printed it is negative for every singular value
    below one (`printed_damping_squared`); this has the sign that makes lambda the largest damping.
    """
    return np.where(sigma < 1.0, damping**2 * (1.0 - (3.0 * sigma**2 - 2.0 * sigma**3)), 0.0)


def printed_damping_squared(sigma: np.ndarray, damping: float) -> np.ndarray:
    """Eq. (29) to the letter."""
    return np.where(sigma < 1.0, -(damping**2) * (3.0 * sigma**2 - 2.0 * sigma**3) - damping**2, 0.0)


def step(J: np.ndarray, e: np.ndarray, damping: float) -> np.ndarray:
    """Joint step for a task error with eq. (29) in eq. (19), shape (m,) -> (n,)."""
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    weight = sigma / np.maximum(sigma**2 + damping_squared(sigma, damping), np.finfo(float).tiny)
    return Vt.T @ (weight * (U.T @ e))
