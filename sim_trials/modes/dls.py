"""Damped least squares with damping scheduled by the smallest singular value: modes M1 and M2."""

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse, scheduled_damping
from sim_trials.modes.method import Method, Parameter, Property, mode_function


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
    """Eqs. (1) and (2); parameters: lambda0, sigma_t."""
    damped_inverse(J, scheduled_damping(sigma, parameters[0], parameters[1]), xdot, qdot_out)


METHOD = Method(
    name="dls",
    summary="Damped least squares: the same damping towards the singularity and away from it",
    equation=(
        "qdot = J' (J J' + lambda^2 I)^-1 xdot,"
        " lambda = lambda0 (1 - sigma / sigma_t)^2 if sigma < sigma_t else 0"
    ),
    latex=(
        r"\dot q = J^T (J J^T + \lambda^2 I)^{-1} \dot x, \quad"
        r" \lambda = \lambda_0 (1 - \sigma / \sigma_t)^2 \text{ if } \sigma < \sigma_t, \text{ else } 0"
    ),
    source="Carmichael, Aldini, Liu (2017), eqs. (1) and (2), after Nakamura and Hanafusa (1986)",
    parameters=(
        Parameter("lambda0", 0.2, 0.001, 10.0, "", "damping at the singularity; 0.2 in M1, 0.6 in M2"),
        Parameter("sigma_t", 0.25, 0.001, 2.0, "", "smallest singular value below which damping sets in"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.INVERSE_ABOVE_SIGMA_T}),
    function=qdot_command,
)
