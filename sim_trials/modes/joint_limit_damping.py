"""Damped least squares whose damping grows, joint by joint, towards the ends of the joints' ranges."""

import math

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse
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
    """Eqs. (24), (27) and (28); parameters: c, p, range_rad, floor.

    (J' J + D^2)^-1 J' is D^-1 K' (K K' + I)^-1 with K = J D^-1: the damped inverse with lambda = 1.
    """
    K, inverse = np.empty((6, 6)), np.empty(6)
    for j in range(6):
        share = min(abs(q[j]) / parameters[2], 1.0)
        damping = parameters[3] + parameters[0] * math.pow(share, parameters[1])
        inverse[j] = 1.0 / damping
        for i in range(6):
            K[i, j] = J[i, j] * inverse[j]
    damped_inverse(K, 1.0, xdot, qdot_out)
    for j in range(6):
        qdot_out[j] *= inverse[j]


METHOD = Method(
    name="joint_limit_damping",
    summary="Damped least squares: each joint damped by how near it is to the end of its range",
    equation=(
        "qdot = (J' J + D^2)^-1 J' xdot, D = diag(floor + c |q_i / range|^p),"
        " the ranges being the same to both sides"
    ),
    latex=(
        r"\dot q = (J^T J + D^2)^{-1} J^T \dot x, \quad"
        r" D_{ii} = \lambda_{\min} + c \left|\frac{2 q_i - q_{i,\max} - q_{i,\min}}"
        r"{q_{i,\max} - q_{i,\min}}\right|^p"
    ),
    source=(
        "Mulumbwa, eqs. (27) and (28) in eq. (24), with |.|^p. The floor is this project's: at the middle of"
        " its range, where the elbow locks, a joint would have no damping at all"
    ),
    parameters=(
        Parameter("c", 0.5, 0.0, 10.0, "", "damping added at the ends of the range"),
        Parameter("p", 4.0, 1.0, 20.0, "", "how late the damping grows; even in the source"),
        Parameter(
            "range_rad",
            2.0 * math.pi,
            0.1,
            2.0 * math.pi,
            "rad",
            "half the joints' range; the UR10's is 2 pi",
        ),
        Parameter("floor", 0.15, 0.001, 10.0, "", "damping in the middle of the range"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES}),
    function=qdot_command,
)
