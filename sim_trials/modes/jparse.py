"""J-PARSE: an inverse kept well conditioned, and commands in lost directions scaled down."""

import numpy as np

from sim_trials.modes.decomposition import decompose, recompose
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
    """Parameters: gamma, gain, speed_share."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    least = parameters[0] * singular[0]
    for i in range(6):
        if singular[i] > least:
            gains[i] = 1.0 / singular[i]
        else:
            gains[i] = parameters[1] * singular[i] / (least * least) if least > 0.0 else 0.0
    recompose(U, gains, V, xdot, qdot_out)
    limit_speed(qdot_out, parameters[2])


METHOD = Method(
    name="jparse",
    summary="J-PARSE: singular directions kept invertible, commands along them scaled down",
    equation=(
        "qdot = sum_i g_i v_i (u_i . xdot), g_i = 1 / sigma_i where sigma_i > gamma sigma_1,"
        " gain sigma_i / (gamma sigma_1)^2 elsewhere; joint speeds limited"
    ),
    latex=(
        r"\dot q = J_s^{+} J_p J_p^{+} \dot x + J_s^{+} \Phi \dot x, \quad \Phi = \sum_{\sigma_i \le \gamma"
        r" \sigma_1} k \frac{\sigma_i}{\gamma \sigma_1} u_i u_i^T"
    ),
    source=(
        "Guptasarma, Strong, Zhen, Kennedy (2025), arXiv 2505.00306: safety Jacobian, projection and scaled"
        " singular directions, written out by singular directions; gamma = 0.1 is the default of the authors'"
        " package. The limit on the speeds is this project's"
    ),
    parameters=(
        Parameter("gamma", 0.1, 0.001, 0.99, "", "sigma_i / sigma_1 up to which a direction is singular"),
        Parameter("gain", 1.0, 0.0, 1.0, "", "how far commands along singular directions are followed"),
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_SPEED_SHARE}),
    function=qdot_command,
)
