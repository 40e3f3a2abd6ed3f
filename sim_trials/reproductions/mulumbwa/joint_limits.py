"""Secondary tasks that keep joints off their limits, for the null space: section 2.5 of the thesis."""

import numpy as np

from sim_trials.reproductions.mulumbwa.arms import LOWER_LIMIT, UPPER_LIMIT

CENTRE = (UPPER_LIMIT + LOWER_LIMIT) / 2.0
"""Middle of each range; eq. (38) prints the difference instead of the sum."""
RANGE = UPPER_LIMIT - LOWER_LIMIT
NORM = 6
"""p of eq. (38): even, not printed."""


def gradient_projection(q: np.ndarray) -> np.ndarray:
    """Minus the gradient of eq. (37), shape (7,)."""
    return -2.0 / q.size * (q - CENTRE) / (UPPER_LIMIT - CENTRE) ** 2


def kinematic_optimisation(q: np.ndarray) -> np.ndarray:
    """Minus the gradient of eq. (38) with K = I and each joint over its own range, shape (7,)."""
    x = (q - CENTRE) / RANGE
    size = np.linalg.norm(x, ord=NORM)
    if size == 0.0:
        return np.zeros_like(q)
    return -np.sign(x) * (np.abs(x) / size) ** (NORM - 1) / RANGE


def violated(q: np.ndarray) -> int:
    """How many joints are outside their range, whole turns aside."""
    wrapped = np.mod(q - CENTRE + np.pi, 2.0 * np.pi) - np.pi + CENTRE
    return int(((wrapped < LOWER_LIMIT - 1e-9) | (wrapped > UPPER_LIMIT + 1e-9)).sum())
