"""Damping of each singular direction by its own singular value, from full at zero to none at a threshold."""

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
    """Eqs. (19) and (29); parameters: lambda, sigma_t."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    for i in range(6):
        share = singular[i] / parameters[1]
        damping = 0.0
        if share < 1.0:
            damping = parameters[0] * parameters[0] * (1.0 - share * share * (3.0 - 2.0 * share))
        gains[i] = singular[i] / (singular[i] * singular[i] + damping)
    recompose(U, gains, V, xdot, qdot_out)


METHOD = Method(
    name="variable_damping_svd",
    summary="Singular value decomposition: each direction damped by its own singular value",
    equation=(
        "qdot = sum_i v_i (u_i . xdot) sigma_i / (sigma_i^2 + lambda_i^2),"
        " lambda_i^2 = lambda^2 (1 - (3 s^2 - 2 s^3)), s = min(1, sigma_i / sigma_t)"
    ),
    latex=(
        r"\dot q = \sum_i \frac{\sigma_i}{\sigma_i^2 + \lambda_i^2} v_i u_i^T \dot x, \quad"
        r" \lambda_i^2 = \lambda^2 [1 - (3 s_i^2 - 2 s_i^3)], \quad s_i = \min(1, \sigma_i / \sigma_t)"
    ),
    source=(
        "Beaudoin, Laliberte, Gosselin (2022), eqs. (19) and (29), whose last minus sign is a misprint:"
        " lambda is said to be the damping at sigma_i = 0. There lambda^2 = 0.1 and sigma_t = 1"
    ),
    parameters=(
        Parameter("lambda", 0.2, 0.001, 10.0, "", "damping where a singular value is zero, not squared"),
        Parameter("sigma_t", 1.0, 0.001, 2.0, "", "singular value below which damping sets in"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.INVERSE_ABOVE_SIGMA_T}),
    function=qdot_command,
)
