"""The Jacobian's transpose in place of its inverse, with the best step length."""

import numpy as np

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
    """Eqs. (11) and (13); parameter: speed_share."""
    transpose_step(J, xdot, qdot_out)
    limit_speed(qdot_out, parameters[0])


METHOD = Method(
    name="transpose",
    summary="Jacobian transpose: the hand's velocity taken as a force on the joints",
    equation="qdot = alpha J' xdot, alpha = |J' xdot|^2 / |J J' xdot|^2; joint speeds limited",
    latex=(
        r"\dot q = \alpha J^T \dot x, \quad"
        r" \alpha = \frac{\dot x^T J J^T \dot x}{(J J^T \dot x)^T (J J^T \dot x)}"
    ),
    source=(
        "Beaudoin, Laliberte, Gosselin (2022), eqs. (11) and (13), after Balestrino et al. (1984) and"
        " Wolovich and Elliott (1984); the limit on the speeds is this project's"
    ),
    parameters=(
        Parameter("speed_share", 0.5, 0.01, 0.95, "", "the fastest joint's share of its speed limit"),
    ),
    properties=frozenset(
        {
            Property.NEVER_REVERSES,
            Property.NEVER_AMPLIFIES,
            Property.WITHIN_SPEED_SHARE,
            Property.LEAST_RESIDUAL,
        }
    ),
    function=qdot_command,
)
