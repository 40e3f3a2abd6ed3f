"""The Jacobian's transpose in place of its inverse, with the best step length."""

import numpy as np

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
    """Eqs. (11) and (13); parameter: speed_share.

    Where J' xdot is zero, the command is one that the arm cannot follow at all, and the quotient is 0 / 0.
    """
    square, moved_square = 0.0, 0.0
    for j in range(6):
        qdot_out[j] = 0.0
        for i in range(6):
            qdot_out[j] += J[i, j] * xdot[i]
        square += qdot_out[j] * qdot_out[j]
    for i in range(6):
        moved = 0.0
        for j in range(6):
            moved += J[i, j] * qdot_out[j]
        moved_square += moved * moved
    # Far below the rounding of any real J' xdot, far above underflow.
    alpha = square / moved_square if moved_square > 1e-200 else 0.0
    for j in range(6):
        qdot_out[j] *= alpha
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
