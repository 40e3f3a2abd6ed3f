"""Damped least squares with damping scheduled by manipulability, as it was first proposed."""

import numpy as np

from sim_trials.modes.decomposition import decompose, recompose
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
    """Parameters: lambda0, w_t."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    manipulability = 1.0
    for i in range(6):
        manipulability *= singular[i]
    damping = parameters[0] * max(1.0 - manipulability / parameters[1], 0.0)
    for i in range(6):
        squared = singular[i] * singular[i] + damping * damping
        # Without damping an exact zero stays a direction that does not move.
        gains[i] = singular[i] / squared if squared > 0.0 else 0.0
    recompose(U, gains, V, xdot, qdot_out)


METHOD = Method(
    name="manipulability_dls",
    summary="Damped least squares: damping scheduled by manipulability (Nakamura and Hanafusa)",
    equation=(
        "qdot = J' (J J' + lambda^2 I)^-1 xdot, lambda^2 = lambda0^2 (1 - w / w_t)^2 if w < w_t else 0,"
        " w = sqrt(det(J J'))"
    ),
    latex=(
        r"\dot q = J^T (J J^T + \lambda^2 I)^{-1} \dot x, \quad \lambda^2 = \lambda_0^2 (1 - w / w_t)^2"
        r" \text{ if } w < w_t, \text{ else } 0, \quad w = \sqrt{\det(J J^T)}"
    ),
    source=(
        "Nakamura and Hanafusa (1986), the singularity-robust inverse with its scale factor"
        " k = k0 (1 - w / w_t)^2, k0 being lambda0^2; w as in Yoshikawa (1985). w mixes all directions: it is"
        " small where one of them is, and where all are moderately so. lambda0 is that of mode M1; w_t is"
        " untuned"
    ),
    parameters=(
        Parameter("lambda0", 0.2, 0.001, 10.0, "", "damping at a singularity"),
        Parameter("w_t", 0.15, 1e-5, 10.0, "", "manipulability below which damping sets in [m and rad]"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES}),
    function=qdot_command,
)
