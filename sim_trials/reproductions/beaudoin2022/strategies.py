"""The three strategies compared: damped pseudo-inverse, variably damped singular values, transpose."""

from functools import partial

import numpy as np

from sim_trials.reproductions.beaudoin2022.shell import Inverse
from sim_trials.reproductions.solvers import damped_least_squares, jacobian_transpose, variable_damping

DAMPED, VARIABLE, TRANSPOSE = "damped pseudo-inverse", "variable damping", "transpose"
STRATEGIES = (DAMPED, VARIABLE, TRANSPOSE)


def inverse_of(strategy: str, damping_squared: float) -> Inverse:
    """A strategy as a function of Jacobian and velocity; the transpose has no damping."""
    damping = float(np.sqrt(damping_squared))
    known: dict[str, Inverse] = {
        DAMPED: partial(damped_least_squares.step, damping=damping),
        VARIABLE: partial(variable_damping.step, damping=damping),
        TRANSPOSE: jacobian_transpose.step,
    }
    return known[strategy]


def transpose_angle(phi: np.ndarray, b2_m: float, lever_m: float) -> np.ndarray:
    """psi [rad] of the transpose in closed form, ``phi`` being how far joint 2 has turned link 3 over [rad].

    The damped strategies have no such form; the motion does not depend on joints 1, 3, 4 and 5.
    """
    across = b2_m * np.sin(phi) * np.cos(phi) * np.hypot(lever_m, b2_m)
    return np.arctan2(np.abs(across), b2_m**2 * np.cos(phi) ** 2 + lever_m**2)
