"""Mode M3 without its chatter: the two dampings fade into each other as sigma begins to fall or grow."""

import math

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse, scheduled_damping
from sim_trials.modes.displacement import displaced_sigma
from sim_trials.modes.method import Method, Parameter, Property, mode_function

_STARTED, _RATE, _LAMBDA0 = 0, 1, 2
"""Slots of the memory: whether a tick has passed, the filtered rate of sigma [1/s], lambda0 now."""


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
    """Probe as M3 does, filter, fade, limit the rate, then eqs. (1) and (2); parameters as declared below."""
    towards, away, sigma_t = parameters[0], parameters[1], parameters[2]
    displacement_s, filter_s, width, lambda0_rate = parameters[3], parameters[4], parameters[5], parameters[6]
    if memory[_STARTED] == 0.0:
        memory[_STARTED] = 1.0
        memory[_LAMBDA0] = towards

    damped_inverse(J, scheduled_damping(sigma, towards, sigma_t), xdot, qdot_out)
    rate = (displaced_sigma(q, qdot_out, displacement_s) - sigma) / displacement_s
    memory[_RATE] += (1.0 - math.exp(-dt / filter_s)) * (rate - memory[_RATE])

    share = min(max(0.5 + 0.5 * memory[_RATE] / width, 0.0), 1.0)
    wanted = towards + (away - towards) * share * share * (3.0 - 2.0 * share)
    most = lambda0_rate * dt
    memory[_LAMBDA0] += min(max(wanted - memory[_LAMBDA0], -most), most)
    if sigma < sigma_t:
        damped_inverse(J, scheduled_damping(sigma, memory[_LAMBDA0], sigma_t), xdot, qdot_out)


METHOD = Method(
    name="blended_asymmetric_dls",
    summary="Damped least squares: damping that fades between towards and away instead of switching",
    equation=(
        "as asymmetric_dls, with lambda0 = towards + (away - towards) smoothstep(d sigma/dt over +-width),"
        " d sigma/dt low-passed and the rate of lambda0 limited"
    ),
    latex=(
        r"\lambda_0 = \lambda_{0,\mathrm{towards}}"
        r" + (\lambda_{0,\mathrm{away}} - \lambda_{0,\mathrm{towards}})"
        r"\, s^2 (3 - 2 s), \quad s = \mathrm{clip}(\tfrac12 + \dot\sigma / 2 w, 0, 1)"
    ),
    source="this project, after Carmichael, Aldini, Liu (2017), section 2; untuned",
    parameters=(
        Parameter("lambda0_towards", 0.6, 0.001, 10.0, "", "lambda0 while sigma falls, and of the probe"),
        Parameter("lambda0_away", 0.2, 0.001, 10.0, "", "lambda0 while sigma grows"),
        Parameter("sigma_t", 0.25, 0.001, 2.0, "", "smallest singular value below which damping sets in"),
        Parameter("displacement_s", 0.01, 0.0001, 0.1, "s", "the probe is the motion over this time"),
        Parameter("filter_s", 0.05, 0.001, 1.0, "s", "time constant of the filter on the rate of sigma"),
        Parameter("width_per_s", 0.1, 0.001, 10.0, "1/s", "rate of sigma at which the fading is complete"),
        Parameter("lambda0_rate_per_s", 4.0, 0.1, 1000.0, "1/s", "fastest change of lambda0"),
    ),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES, Property.INVERSE_ABOVE_SIGMA_T}),
    function=qdot_command,
)
