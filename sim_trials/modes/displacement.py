"""A look ahead: the smallest singular value a small displacement away."""

import numpy as np

from sim_trials.compiled import compiled
from sim_trials.kinematics import handle_jacobian
from sim_trials.singular_value import smallest_singular_value


@compiled("float64(float64[::1], float64[::1], float64)")
def displaced_sigma(q: np.ndarray, qdot: np.ndarray, displacement_s: float) -> float:
    """sigma_min of the Jacobian at ``q + displacement_s qdot``, exactly there and not linearised.

    Parameters
    ----------
    q, qdot : ndarray, shape (6,)
        Joint angles [rad] and velocities [rad/s].
    displacement_s : float
        How long the motion is followed [s].
    """
    displaced, J = np.empty(6), np.empty((6, 6))
    for i in range(6):
        displaced[i] = q[i] + displacement_s * qdot[i]
    handle_jacobian(displaced, J)
    return smallest_singular_value(J)
