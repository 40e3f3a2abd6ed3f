"""Selectively damped least squares: each singular direction is clamped by how far it would reach."""

import numpy as np

ZERO = 1e-12
"""Singular values below this give no step: Mulumbwa, below eq. (36)."""


def step(J: np.ndarray, e: np.ndarray, gamma_max: float) -> np.ndarray:
    """Joint step for a task error with no joint turning by more than ``gamma_max`` [rad].

    The rows of J are one end-effector's position, or position and orientation (three each), whose
    directions are weighed in blocks of their own.

    References
    ----------
    Mulumbwa, eqs. (33)-(36). Eq. (35) is used with the factor 1/sigma_i and the sum is clamped to gamma_max
    once more, as in the method's source (Buss, Kim 2005); the thesis prints neither.
    """
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    blocks = (slice(0, 3), slice(3, 6)) if J.shape[0] == 6 else (slice(0, J.shape[0]),)
    reach = sum(np.linalg.norm(J[rows], axis=0) for rows in blocks)
    total = np.zeros(J.shape[1])
    for i, s in enumerate(sigma):
        if s < ZERO:
            continue
        N = sum(np.linalg.norm(U[rows, i]) for rows in blocks)
        M = float(np.abs(Vt[i]) @ reach) / s
        gamma = min(1.0, N / M) * gamma_max
        total += _clamped(Vt[i] * (U[:, i] @ e) / s, gamma)
    return _clamped(total, gamma_max)


def _clamped(w: np.ndarray, largest: float) -> np.ndarray:
    size = np.abs(w).max()
    return w if size <= largest else w * (largest / size)
