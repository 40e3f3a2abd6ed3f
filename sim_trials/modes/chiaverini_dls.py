"""Damped least squares with Chiaverini's schedule: the square of the damping follows that of sigma."""

import math

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse
from sim_trials.modes.method import Method, Parameter, Property, mode_function
from sim_trials.modes.scaled_damping import squared_damping


@mode_function
def qdot_command(
    q: np.ndarray,
    J: np.ndarray,
    sigma: float,
    xdot: np.ndarray,
    dt: float,
    parameters: np.ndarray,
    memory: np.ndarray,
    qdot_out: np.ndarray,
) -> None:
    """Parameters: lambda_max, sigma_t."""
    damped_inverse(J, math.sqrt(squared_damping(sigma, parameters[0], parameters[1])), xdot, qdot_out)


METHOD = Method(
    name="chiaverini_dls",
    summary="Damped least squares: the damping sets in steeply at a threshold (Chiaverini)",
    equation=(
        "qdot = J' (J J' + lambda^2 I)^-1 xdot,"
        " lambda^2 = lambda_max^2 (1 - (sigma / sigma_t)^2) if sigma < sigma_t else 0"
    ),
    latex=(
        r"\dot q = J^T (J J^T + \lambda^2 I)^{-1} \dot x, \quad \lambda^2 = \lambda_{\max}^2"
        r" \left(1 - (\sigma / \sigma_t)^2\right) \text{ if } \sigma < \sigma_t, \text{ else } 0"
    ),
    source=(
        "Chiaverini (1997), Singularity-robust task-priority redundancy resolution, IEEE Trans. Robotics and"
        " Automation 13; Chiaverini, Siciliano, Egeland (1994), IEEE Trans. Control Systems Technology 2. Its"
        " numbers here are those of mode M1"
    ),
    parameters=(
        Parameter("lambda_max", 0.2, 0.001, 10.0, "", "damping at the singularity"),
        Parameter("sigma_t", 0.25, 0.001, 2.0, "", "smallest singular value below which damping sets in"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.INVERSE_ABOVE_SIGMA_T}),
    function=qdot_command,
)
