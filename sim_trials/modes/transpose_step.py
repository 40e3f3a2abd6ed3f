"""The step along the Jacobian's transpose that several methods share."""

import numpy as np

from sim_trials.compiled import compiled


@compiled("void(float64[:, ::1], float64[::1], float64[::1])")
def transpose_step(J: np.ndarray, xdot: np.ndarray, qdot: np.ndarray) -> None:
    """Write alpha J' xdot with the alpha that leaves the least error: |J' xdot|^2 / |J J' xdot|^2.

    Where J' xdot is zero the arm cannot follow the command at all, and the quotient would be 0 / 0.

    Parameters
    ----------
    J : ndarray, shape (6, 6)
        Jacobian.
    xdot : ndarray, shape (6,)
        Commanded velocity of the handle [m/s, rad/s].
    qdot : ndarray, shape (6,), written
        Joint velocities [rad/s]; may not be ``xdot`` itself.

    References
    ----------
    Beaudoin, Laliberte, Gosselin (2022), eqs. (11) and (13).
    """
    square, moved_square = 0.0, 0.0
    for j in range(6):
        qdot[j] = 0.0
        for i in range(6):
            qdot[j] += J[i, j] * xdot[i]
        square += qdot[j] * qdot[j]
    for i in range(6):
        moved = 0.0
        for j in range(6):
            moved += J[i, j] * qdot[j]
        moved_square += moved * moved
    # Far below the rounding of any real J' xdot, far above underflow.
    alpha = square / moved_square if moved_square > 1e-200 else 0.0
    for j in range(6):
        qdot[j] *= alpha
