"""Numerical filtering: little damping for all directions, much for the one that is being lost."""

import numpy as np

from sim_trials.modes.decomposition import decompose, recompose
from sim_trials.modes.method import Method, Parameter, Property, mode_function
from sim_trials.modes.scaled_damping import squared_damping


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
    """Parameters: lambda, beta_max, sigma_t."""
    U, V, singular, gains = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    decompose(J, U, singular, V)
    for i in range(6):
        damping = parameters[0] * parameters[0]
        if i == 5:
            damping += squared_damping(sigma, parameters[1], parameters[2])
        gains[i] = singular[i] / (singular[i] * singular[i] + damping)
    recompose(U, gains, V, xdot, qdot_out)


METHOD = Method(
    name="numerical_filtering",
    summary="Numerical filtering: damping along the direction that is being lost, hardly any across it",
    equation=(
        "qdot = J' (J J' + lambda^2 I + beta^2 u_6 u_6')^-1 xdot,"
        " beta^2 = beta_max^2 (1 - (sigma / sigma_t)^2) if sigma < sigma_t else 0"
    ),
    latex=(
        r"\dot q = J^T (J J^T + \lambda^2 I + \beta^2 u_6 u_6^T)^{-1} \dot x, \quad \beta^2 ="
        r" \beta_{\max}^2 \left(1 - (\sigma / \sigma_t)^2\right) \text{ if } \sigma < \sigma_t,"
        r" \text{ else } 0"
    ),
    source=(
        "Chiaverini (1997), IEEE Trans. Robotics and Automation 13; Chiaverini, Siciliano, Egeland (1994),"
        " IEEE Trans. Control Systems Technology 2, after Maciejewski and Klein (1988). beta_max is the"
        " damping of mode M1; lambda is untuned"
    ),
    parameters=(
        Parameter("lambda", 0.02, 0.001, 10.0, "", "damping of every direction"),
        Parameter("beta_max", 0.2, 0.0, 10.0, "", "damping added along u_6 at the singularity"),
        Parameter("sigma_t", 0.25, 0.001, 2.0, "", "smallest singular value below which beta sets in"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.DAMPED_GAIN}),
    function=qdot_command,
)
