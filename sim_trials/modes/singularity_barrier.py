"""A barrier on the smallest singular value: it may fall the more slowly the closer it is to its limit.

The joint velocities are those that follow the command best while ``d sigma / dt`` stays above
``-alpha (sigma - sigma_s)``. With one such constraint the best ones are known in closed form. At the barrier
the robot slides along it: what leads on is taken away, what leads along it or back is followed in full.

Below sigma_s, where a lap may begin, the constraint as published would drive the robot out by itself. A robot
in somebody's hand must not move without a command, so there it only forbids to go deeper.
"""

import numpy as np

from sim_trials.modes.decomposition import decompose, recompose
from sim_trials.modes.method import Method, Parameter, Property, mode_function
from sim_trials.modes.singular_slope import singular_slope
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
    """Parameters: sigma_s, alpha, mu, speed_share."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    squared = parameters[2] * parameters[2]
    for i in range(6):
        gains[i] = singular[i] / (singular[i] * singular[i] + squared)
    recompose(U, gains, V, xdot, qdot_out)

    slope = np.empty(6)
    singular_slope(J, U[5], V[5], slope)
    rate = 0.0
    for k in range(6):
        rate += slope[k] * qdot_out[k]
    least = min(0.0, -parameters[1] * (singular[5] - parameters[0]))
    if rate < least:
        # (J' J + mu^2 I)^-1 slope: the cheapest way to raise the rate.
        way, raised = np.zeros(6), 0.0
        for i in range(6):
            share = 0.0
            for k in range(6):
                share += V[i, k] * slope[k]
            share /= singular[i] * singular[i] + squared
            for k in range(6):
                way[k] += share * V[i, k]
        for k in range(6):
            raised += slope[k] * way[k]
        for k in range(6):
            qdot_out[k] += way[k] * (least - rate) / raised
    limit_speed(qdot_out, parameters[3])


METHOD = Method(
    name="singularity_barrier",
    summary="A control barrier function: the smallest singular value is kept above a limit",
    equation=(
        "minimise |J qdot - xdot|^2 + mu^2 |qdot|^2 subject to g . qdot >= min(0, -alpha (sigma - sigma_s)),"
        " g_i = u_6' (dJ/dq_i) v_6; joint speeds limited"
    ),
    latex=(
        r"\min_{\dot q} |J \dot q - \dot x|^2 + \mu^2 |\dot q|^2 \quad \text{subject to} \quad"
        r" g^T \dot q \ge \min(0, -\alpha (\sigma - \sigma_s)), \quad"
        r" g_i = u_6^T \frac{\partial J}{\partial q_i} v_6"
    ),
    source=(
        "control barrier functions: Ames et al. (2019), European Control Conference; on manipulability and"
        " singular values: arXiv 2109.13349, 2403.09853. Closed form for one constraint, no drive out of the"
        " region below sigma_s, numbers (untuned) and the limit on the speeds are this project's"
    ),
    parameters=(
        Parameter("sigma_s", 0.03, 0.0, 1.0, "", "smallest singular value that the robot goes to"),
        Parameter("alpha", 5.0, 0.1, 100.0, "1/s", "how fast sigma may approach it"),
        Parameter("mu", 0.01, 0.001, 1.0, "", "damping of every direction"),
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_SPEED_SHARE}),
    function=qdot_command,
)
