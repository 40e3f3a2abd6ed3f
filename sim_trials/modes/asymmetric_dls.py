"""Damped least squares that damps the way into the singularity more than the way out: mode M3."""

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse, scheduled_damping
from sim_trials.modes.displacement import displaced_sigma
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
    """Probe, then eqs. (1) and (2); parameters: lambda0_towards, lambda0_away, sigma_t, displacement_s.

    The probe always uses the heavy damping: the sign it finds can depend on lambda0, and the shorter
    step is the less likely to jump across the singularity, which would look like moving away.
    """
    towards, away, sigma_t = parameters[0], parameters[1], parameters[2]
    damped_inverse(J, scheduled_damping(sigma, towards, sigma_t), xdot, qdot_out)
    if sigma >= sigma_t:
        return
    if displaced_sigma(q, qdot_out, parameters[3]) >= sigma:
        damped_inverse(J, scheduled_damping(sigma, away, sigma_t), xdot, qdot_out)


METHOD = Method(
    name="asymmetric_dls",
    summary="Damped least squares: heavy damping towards the singularity, light damping away from it",
    equation=(
        "as dls, with lambda0 = lambda0_towards if sigma(q + displacement_s qdot) < sigma(q),"
        " else lambda0_away"
    ),
    latex=(
        r"\lambda_0 = \lambda_{0,\mathrm{towards}} \text{ if } \sigma(q + \tau \dot q) < \sigma(q),"
        r" \text{ else } \lambda_{0,\mathrm{away}}"
    ),
    source=(
        "Carmichael, Aldini, Liu (2017), section 2 and table 1; the length of the displacement and the"
        " damping of the probe are not given there and are this project's"
    ),
    parameters=(
        Parameter("lambda0_towards", 0.6, 0.001, 10.0, "", "lambda0 when sigma would fall, and of the probe"),
        Parameter("lambda0_away", 0.2, 0.001, 10.0, "", "lambda0 when sigma would not fall"),
        Parameter("sigma_t", 0.25, 0.001, 2.0, "", "smallest singular value below which damping sets in"),
        Parameter("displacement_s", 0.01, 0.0001, 0.1, "s", "the probe is the motion over this time"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.INVERSE_ABOVE_SIGMA_T}),
    function=qdot_command,
)
