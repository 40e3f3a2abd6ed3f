"""Damped least squares: every direction gives up some accuracy for bounded joint speed."""

import numpy as np


def step(J: np.ndarray, e: np.ndarray, damping: float) -> np.ndarray:
    """Joint step for a task error, ``damping`` being lambda (not its square), shape (m,) -> (n,).

    References
    ----------
    Mulumbwa, eq. (24) with sigma^2 + lambda^2, which the printed sum lacks; Beaudoin, Laliberte,
    Gosselin (2022), eq. (9).
    """
    m = J.shape[0]
    return J.T @ np.linalg.solve(J @ J.T + damping**2 * np.eye(m), e)


def spectral_step(J: np.ndarray, e: np.ndarray, damping: float) -> np.ndarray:
    """The same by singular values: Beaudoin, Laliberte, Gosselin (2022), eq. (19)."""
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    return Vt.T @ (sigma / (sigma**2 + damping**2) * (U.T @ e))


def condition_number(sigma: np.ndarray, damping: float) -> float:
    """Condition number of J J^T + lambda^2 I: Mulumbwa, eq. (26) with lambda^2, as eq. (24) needs it."""
    return float((sigma[0] ** 2 + damping**2) / (sigma[-1] ** 2 + damping**2))
