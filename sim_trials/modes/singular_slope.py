"""How the smallest singular value changes with each joint."""

import numpy as np

from sim_trials.compiled import compiled


@compiled("void(float64[:, ::1], float64[::1], float64[::1], float64[::1])")
def singular_slope(J: np.ndarray, u: np.ndarray, v: np.ndarray, slope: np.ndarray) -> None:
    """Write d sigma / dq_i = u' (dJ / dq_i) v for a singular direction of a chain of revolute joints.

    With p the linear and w the angular half of a column of J, column k changes with joint i by
    ``w_min(i, k) x p_max(i, k)`` in its linear half and, for i < k, by ``w_i x w_k`` in its angular half: the
    Jacobian alone says how it changes.

    Parameters
    ----------
    J : ndarray, shape (6, 6)
        Jacobian, base frame, rows linear then angular [m, rad].
    u, v : ndarray, shape (6,)
        Left and right singular vector, J v = sigma u. The slope is that of a singular value that occurs once.
    slope : ndarray, shape (6,), written
        d sigma / dq_i [1/rad], sigma in m and rad.

    References
    ----------
    Hourtash (2005), "The kinematic Hessian and higher derivatives".
    """
    for i in range(6):
        total = 0.0
        for k in range(6):
            first, second = min(i, k), max(i, k)
            a0, a1, a2 = J[3, first], J[4, first], J[5, first]
            b0, b1, b2 = J[0, second], J[1, second], J[2, second]
            change = u[0] * (a1 * b2 - a2 * b1) + u[1] * (a2 * b0 - a0 * b2) + u[2] * (a0 * b1 - a1 * b0)
            if i < k:
                b0, b1, b2 = J[3, k], J[4, k], J[5, k]
                change += u[3] * (a1 * b2 - a2 * b1) + u[4] * (a2 * b0 - a0 * b2) + u[5] * (a0 * b1 - a1 * b0)
            total += change * v[k]
        slope[i] = total
