"""Singular value filtering, then selective damping: the method that Mulumbwa prefers."""

import numpy as np

from sim_trials.modes.decomposition import decompose
from sim_trials.modes.filtered_value import filtered_value
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
    """Eqs. (29), (30) and (33) to (36); parameters: sigma0, nu, gamma_max.

    Joints reach as far as the filtered Jacobian says.
    """
    U, V, singular, filtered = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty((6, 6))
    decompose(J, U, singular, V)
    for i in range(6):
        for j in range(6):
            filtered[i, j] = J[i, j]
    for i in range(6):
        value = filtered_value(singular[i], parameters[0], parameters[1])
        for k in range(6):
            for j in range(6):
                filtered[k, j] += (value - singular[i]) * U[i, k] * V[i, j]
        singular[i] = value
    selectively_damped(filtered, U, singular, V, xdot, parameters[2], qdot_out)


METHOD = Method(
    name="filtered_selectively_damped_dls",
    summary="Singular value filtering and selectively damped least squares together",
    equation="as selectively_damped_dls, with h(sigma_i) of singular_value_filtering for sigma_i",
    latex=(
        r"\dot q = \mathrm{clamp}\Big(\sum_i \mathrm{clamp}(h(\sigma_i)^{-1} v_i u_i^T \dot x, \gamma_i),"
        r" \gamma_{\max}\Big)"
    ),
    source=(
        "Mulumbwa, section 3.2.2: eqs. (29) and (30), then eqs. (33) to (36), all with their corrections."
        " Crossing a singularity the motion jumps in sign"
    ),
    parameters=(
        Parameter("sigma0", 0.05, 0.001, 1.0, "", "what stands for a singular value of zero; 0.005 there"),
        Parameter("nu", 10.0, 0.1, 100.0, "", "shape: the larger, the narrower the region that is filtered"),
        Parameter("gamma_max", 1.5, 0.01, 1.9, "rad/s", "speed of the fastest joint"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_GAMMA_MAX}),
    function=qdot_command,
)
