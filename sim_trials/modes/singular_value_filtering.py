"""Singular value filtering: the inverse of a Jacobian whose singular values are kept away from zero."""

import numpy as np

from sim_trials.modes.decomposition import decompose, recompose
from sim_trials.modes.filtered_value import filtered_value
from sim_trials.modes.method import Method, Parameter, Property, mode_function
from sim_trials.modes.speed_limit import limit_speed


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
    """Eqs. (30) and (31); parameters: sigma0, nu, speed_share."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    for i in range(6):
        gains[i] = 1.0 / filtered_value(singular[i], parameters[0], parameters[1])
    recompose(U, gains, V, xdot, qdot_out)
    limit_speed(qdot_out, parameters[2])


METHOD = Method(
    name="singular_value_filtering",
    summary="Singular value filtering: the inverse with its singular values kept away from zero",
    equation=(
        "qdot = sum_i v_i (u_i . xdot) / h(sigma_i),"
        " h(s) = (s^3 + nu s^2 + 2 s + 2 sigma0) / (s^2 + nu s + 2); joint speeds limited"
    ),
    latex=(
        r"\dot q = \sum_i \frac{1}{h(\sigma_i)} v_i u_i^T \dot x, \quad"
        r" h(\sigma) = \frac{\sigma^3 + \nu \sigma^2 + 2 \sigma + 2 \sigma_0}{\sigma^2 + \nu \sigma + 2}"
    ),
    source=(
        "Mulumbwa, eqs. (30) and (31), the latter with v_i u_i' in place of u_i v_i'; sigma0 = 0.005 and"
        " nu = 10 are recommended there. Crossing a singularity the motion jumps in sign. The limit on the"
        " speeds is this project's"
    ),
    parameters=(
        Parameter("sigma0", 0.1, 0.001, 1.0, "", "what stands for a singular value of zero"),
        Parameter("nu", 10.0, 0.1, 100.0, "", "shape: the larger, the narrower the region that is filtered"),
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_SPEED_SHARE}),
    function=qdot_command,
)
