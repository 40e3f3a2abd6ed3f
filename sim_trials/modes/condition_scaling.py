"""The plain inverse, slowed down and stopped by the Jacobian's condition number, as MoveIt Servo does.

Once stopped it stays so, as its original does: from ``stop_at`` on it answers no command, not even one that
leads away. A lap that passes that condition number cannot be finished under it (`sim_trials.standstill`).
"""

import numpy as np

from sim_trials.kinematics import handle_jacobian
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
    """Scaling as below; parameters: slow_from, stop_at, leaving_factor, probe, speed_share."""
    slow_from, stop_at, leaving_factor = parameters[0], parameters[1], parameters[2]
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    # Compared in products: at a singularity the condition number is infinite.
    if singular[0] >= stop_at * singular[5]:
        qdot_out[:] = 0.0
        return
    for i in range(6):
        gains[i] = 1.0 / singular[i]
    condition = singular[0] * gains[5]
    recompose(U, gains, V, xdot, qdot_out)
    if condition > slow_from:
        # The sign of u_6 is arbitrary: a small step along it tells whether it leads to the singularity.
        ahead, J_ahead = np.empty(6), np.empty((6, 6))
        for k in range(6):
            ahead[k] = q[k] + parameters[3] * gains[5] * V[5, k]
        handle_jacobian(ahead, J_ahead)
        towards = 0.0
        for k in range(6):
            towards += U[5, k] * xdot[k]
        decompose(J_ahead, U, singular, V)
        if singular[0] <= condition * singular[5]:
            towards = -towards
        width = (stop_at - slow_from) * (1.0 if towards > 0.0 else leaving_factor)
        scale = max(1.0 - (condition - slow_from) / width, 0.0)
        for k in range(6):
            qdot_out[k] *= scale
    limit_speed(qdot_out, parameters[4])


METHOD = Method(
    name="condition_scaling",
    summary="Slowing down by condition number, and stopping for good, as MoveIt Servo does",
    equation=(
        "qdot = c J^-1 xdot; with k = sigma_1 / sigma_6, c = 1 up to slow_from, 0 from stop_at, between them"
        " 1 - (k - slow_from) / (stop_at - slow_from), the width times leaving_factor when leaving"
    ),
    latex=(
        r"\dot q = c J^{-1} \dot x, \quad c = 1 - \frac{\kappa - \kappa_1}{f (\kappa_2 - \kappa_1)}"
        r" \text{ for } \kappa_1 < \kappa < \kappa_2, \quad 0 \text{ from } \kappa_2 \text{ on}"
    ),
    source=(
        "MoveIt 2, moveit_servo, velocity scaling for singularity and its default parameters: 17, 30, 2, step"
        " 0.01. From stop_at on it stands still whatever it is asked, so that no hand gets it out again: laps"
        " that lead there cannot be finished. The limit on the speeds is this project's"
    ),
    parameters=(
        Parameter("slow_from", 17.0, 1.0, 1000.0, "", "condition number from which it slows down (m, rad)"),
        Parameter("stop_at", 30.0, 1.0, 10000.0, "", "condition number from which it stands still for good"),
        Parameter("leaving_factor", 2.0, 1.0, 100.0, "", "how much wider the slowing is when leaving"),
        Parameter("probe", 0.01, 1e-6, 0.1, "", "step along u_6 that tells its sign [m and rad, as a norm]"),
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    ascending=(("slow_from", "stop_at"),),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_SPEED_SHARE}),
    function=qdot_command,
)
