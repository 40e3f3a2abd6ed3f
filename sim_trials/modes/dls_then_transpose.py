"""Damped least squares near a singularity, the transpose very near it: regions of the workspace."""

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse, scheduled_damping
from sim_trials.modes.method import Method, Parameter, Property, mode_function
from sim_trials.modes.speed_limit import limit_speed
from sim_trials.modes.transpose_step import transpose_step


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
    """Parameters: lambda0, sigma_t, sigma_near, speed_share."""
    if sigma < parameters[2]:
        transpose_step(J, xdot, qdot_out)
    else:
        damped_inverse(J, scheduled_damping(sigma, parameters[0], parameters[1]), xdot, qdot_out)
    limit_speed(qdot_out, parameters[3])


METHOD = Method(
    name="dls_then_transpose",
    summary="Damped least squares near the singularity, the Jacobian transpose very near it",
    equation=(
        "qdot = J' (J J' + lambda^2 I)^-1 xdot with lambda as in dls where sigma >= sigma_near,"
        " alpha J' xdot with alpha as in transpose below; joint speeds limited"
    ),
    latex=(
        r"\dot q = J^T (J J^T + \lambda^2 I)^{-1} \dot x \text{ if } \sigma \ge \sigma_n,"
        r" \quad \alpha J^T \dot x \text{ below}"
    ),
    source=(
        "the regions of Sharifi, Doustmohammadi, Talebi (2013), as Carmichael, Aldini, Liu (2017), section 1,"
        " describe them. That paper's own thresholds and damping could not be read: here the damping is eq."
        " (2) of the 2017 paper, the transpose's length eq. (13) of Beaudoin, Laliberte, Gosselin (2022), and"
        " the thresholds are untuned. The motion jumps where the regions meet"
    ),
    parameters=(
        Parameter("lambda0", 0.2, 0.001, 10.0, "", "damping at the singularity, if it were damped there"),
        Parameter("sigma_t", 0.25, 0.001, 2.0, "", "smallest singular value below which damping sets in"),
        Parameter("sigma_near", 0.05, 0.0, 1.0, "", "sigma below which the transpose is used"),
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    ascending=(("sigma_near", "sigma_t"),),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.WITHIN_SPEED_SHARE}),
    function=qdot_command,
)
