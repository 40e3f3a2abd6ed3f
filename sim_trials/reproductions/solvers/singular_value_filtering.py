"""Singular values lifted off zero, so that the Jacobian never loses rank."""

import numpy as np

SIGMA_0 = 0.005
SHAPE = 10.0
"""Smallest singular value and shape factor as recommended; Mulumbwa, section 2.4.4."""


def lifted(sigma: np.ndarray, sigma_0: float = SIGMA_0, shape: float = SHAPE) -> np.ndarray:
    """Filtered singular values; lifted(0) = sigma_0, and hardly changed where sigma is large.

    References
    ----------
    Mulumbwa, eq. (30).
    """
    above = sigma**3 + shape * sigma**2 + 2.0 * sigma + 2.0 * sigma_0
    return above / (sigma**2 + shape * sigma + 2.0)


def filtered(J: np.ndarray) -> np.ndarray:
    """The Jacobian with its singular values lifted: Mulumbwa, eq. (29)."""
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    return (U * lifted(sigma)) @ Vt


def condition_number(sigma: np.ndarray) -> float:
    """Condition number of the filtered Jacobian: Mulumbwa, eq. (32)."""
    high = lifted(sigma)
    return float(high[0] / high[-1])
