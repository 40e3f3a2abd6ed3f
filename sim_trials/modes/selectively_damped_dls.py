"""Selectively damped least squares: the harder a direction is to go, the sooner it is held back."""

import numpy as np

from sim_trials.modes.decomposition import decompose
from sim_trials.modes.method import Method, Parameter, Property, mode_function
from sim_trials.modes.selective_damping import selectively_damped


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
    """Eqs. (33) to (36); parameter: gamma_max."""
    U, V, singular = np.empty((6, 6)), np.empty((6, 6)), np.empty(6)
    decompose(J, U, singular, V)
    selectively_damped(J, U, singular, V, xdot, parameters[0], qdot_out)


METHOD = Method(
    name="selectively_damped_dls",
    summary="Selectively damped least squares: a bound on the joint speeds for each singular direction",
    equation=(
        "qdot = clamp(sum_i clamp(v_i (u_i . xdot) / sigma_i, gamma_i), gamma_max),"
        " gamma_i = gamma_max min(1, N_i / M_i), N_i = |u_i|, M_i = sum_j |v_ji| |J_j| / sigma_i,"
        " norms of linear and angular part added"
    ),
    latex=(
        r"\dot q = \mathrm{clamp}\Big(\sum_i \mathrm{clamp}(\sigma_i^{-1} v_i u_i^T \dot x, \gamma_i),"
        r" \gamma_{\max}\Big), \quad \gamma_i = \min(1, N_i / M_i)\, \gamma_{\max}, \quad"
        r" M_i = \sigma_i^{-1} \sum_j |v_{ji}| \|J_j\|"
    ),
    source=(
        "Mulumbwa, eqs. (33) to (36), after Buss and Kim (2005); eq. (35) with the 1 / sigma_i and eq. (36)"
        " with the last clamp that are missing there. The bound is one on velocities here, since a hand gives"
        " no target; undefined where singular values are equal"
    ),
    parameters=(Parameter("gamma_max", 1.5, 0.01, 1.9, "rad/s", "speed of the fastest joint"),),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_GAMMA_MAX}),
    function=qdot_command,
)
