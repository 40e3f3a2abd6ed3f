"""Selective damping, which two methods share: each singular direction gets a bound of its own."""

import math

import numpy as np
from numba.core import types

from sim_trials.compiled import MATRIX, VECTOR, compiled


@compiled(types.void(MATRIX, MATRIX, VECTOR, MATRIX, VECTOR, types.float64, VECTOR))
def selectively_damped(
    J: np.ndarray,
    U: np.ndarray,
    divisors: np.ndarray,
    V: np.ndarray,
    xdot: np.ndarray,
    gamma_max: float,
    qdot: np.ndarray,
) -> None:
    """Write the sum of clamp(w_i, gamma_i) over i, clamped to gamma_max; w_i = v_i (u_i . xdot) / s_i.

    gamma_i = gamma_max min(1, N_i / M_i): M_i is how far all joints together would carry the handle while
    they turn as w_i says, one metre (or radian) along u_i being wanted; N_i is how far it then gets. So a
    direction in which joints mostly work against each other is held back the most. Linear and angular
    velocity have different units and enter both sums as two bodies would, each with a norm of its own. A
    clamp scales a vector to at most that largest entry.

    Parameters
    ----------
    J : ndarray, shape (6, 6)
        Jacobian.
    U, V : ndarray, shape (6, 6)
        From ``decomposition.decompose``.
    divisors : ndarray, shape (6,)
        s_i, what is divided by: sigma_i or what stands for it. Directions with zero are left out.
    xdot : ndarray, shape (6,)
        Commanded velocity of the handle [m/s, rad/s].
    gamma_max : float
        The fastest joint's speed [rad/s].
    qdot : ndarray, shape (6,), written
        Joint velocities [rad/s].
    """
    reach = np.empty(6)
    for j in range(6):
        linear = J[0, j] * J[0, j] + J[1, j] * J[1, j] + J[2, j] * J[2, j]
        angular = J[3, j] * J[3, j] + J[4, j] * J[4, j] + J[5, j] * J[5, j]
        reach[j] = math.sqrt(linear) + math.sqrt(angular)
        qdot[j] = 0.0
    for i in range(6):
        if divisors[i] <= 0.0:
            continue
        along, carried, largest = 0.0, 0.0, 0.0
        for k in range(6):
            along += U[i, k] * xdot[k]
            carried += abs(V[i, k]) * reach[k]
            largest = max(largest, abs(V[i, k]))
        wanted = math.sqrt(U[i, 0] ** 2 + U[i, 1] ** 2 + U[i, 2] ** 2) + math.sqrt(
            U[i, 3] ** 2 + U[i, 4] ** 2 + U[i, 5] ** 2
        )
        # N_i / M_i with M_i = carried / s_i; in products, since s_i may be as small as it likes.
        gamma = gamma_max
        if wanted * divisors[i] < carried:
            gamma = gamma_max * wanted * divisors[i] / carried
        speed = abs(along) * largest
        scale = along / divisors[i] if speed <= gamma * divisors[i] else math.copysign(gamma / largest, along)
        for k in range(6):
            qdot[k] += scale * V[i, k]
    fastest = 0.0
    for k in range(6):
        fastest = max(fastest, abs(qdot[k]))
    if fastest > gamma_max:
        for k in range(6):
            qdot[k] *= gamma_max / fastest
