"""The pseudo-inverse: exact wherever the arm can follow, and no faster than its joints may turn."""

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
    """Eqs. (16) to (18); parameters: zero_below, speed_share."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    for i in range(6):
        gains[i] = 1.0 / singular[i] if singular[i] >= parameters[0] else 0.0
    recompose(U, gains, V, xdot, qdot_out)
    limit_speed(qdot_out, parameters[1])


METHOD = Method(
    name="pseudo_inverse",
    summary="Plain inverse: no damping, only a limit on the joint speeds",
    equation=(
        "qdot = c sum_i v_i (u_i . xdot) / sigma_i over sigma_i >= zero_below,"
        " c = min(1, speed_share min_j limit_j / |qdot_j|)"
    ),
    latex=(
        r"\dot q = c \sum_{\sigma_i \ge \sigma_0} \sigma_i^{-1} v_i u_i^T \dot x, \quad"
        r" c = \min(1, s \min_j \dot q_{j,\max} / |\dot q_j|)"
    ),
    source=(
        "Beaudoin, Laliberte, Gosselin (2022), eqs. (5), (16) to (18); the limit on the speeds is this"
        " project's"
    ),
    parameters=(
        Parameter(
            "zero_below", 1e-6, 1e-9, 1.0, "", "singular values below this count as zero: no motion there"
        ),
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_SPEED_SHARE}),
    function=qdot_command,
)
