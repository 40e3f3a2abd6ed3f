"""Damped least squares with the same damping everywhere."""

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
    """Eq. (9); parameter: lambda."""
    damped_inverse(J, parameters[0], xdot, qdot_out)


METHOD = Method(
    name="constant_dls",
    summary="Damped least squares: the same damping near the singularity and far from it",
    equation="qdot = J' (J J' + lambda^2 I)^-1 xdot",
    latex=r"\dot q = J^T (J J^T + \lambda^2 I)^{-1} \dot x",
    source=(
        "Beaudoin, Laliberte, Gosselin (2022), eq. (9), which uses lambda^2 = 0.1; Mulumbwa, eq. (24) with"
        " sigma_i^2 in its denominator; after Wampler (1986) and Nakamura and Hanafusa (1986)"
    ),
    parameters=(Parameter("lambda", 0.15, 0.001, 10.0, "", "damping, not squared"),),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.DAMPED_GAIN}),
    function=qdot_command,
)
