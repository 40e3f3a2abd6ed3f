"""The damped inverse that several methods share: eq. (1) of Carmichael, Aldini, Liu (2017)."""

import numpy as np

from sim_trials.compiled import compiled

_N = 6


@compiled("float64(float64, float64, float64)")
def scheduled_damping(sigma: float, lambda0: float, sigma_t: float) -> float:
    """Eq. (2): lambda = lambda0 (1 - sigma / sigma_t)^2 below the threshold, zero from there on.

    Parameters
    ----------
    sigma : float
        Smallest singular value of the Jacobian (SI units).
    lambda0 : float
        Damping at the singularity.
    sigma_t : float
        Threshold on sigma, positive.
    """
    if sigma >= sigma_t:
        return 0.0
    return lambda0 * (1.0 - sigma / sigma_t) ** 2


@compiled("void(float64[:, ::1], float64, float64[::1], float64[::1])")
def damped_inverse(J: np.ndarray, damping: float, xdot: np.ndarray, qdot: np.ndarray) -> None:
    """Write J' (J J' + lambda^2 I)^-1 xdot, by an L D L' factorisation of the 6 x 6 sum.

    Without damping J must be regular; its condition number is then squared, which costs four of
    sixteen digits at sigma = 0.01.

    Parameters
    ----------
    J : ndarray, shape (6, 6)
        Jacobian.
    damping : float
        lambda, not squared.
    xdot : ndarray, shape (6,)
        Commanded velocity of the handle [m/s, rad/s].
    qdot : ndarray, shape (6,), written
        Joint velocities [rad/s]; may not be ``xdot`` itself.
    """
    S = np.empty((_N, _N))
    for i in range(_N):
        for j in range(i + 1):
            dot = 0.0
            for k in range(_N):
                dot += J[i, k] * J[j, k]
            S[i, j] = dot
        S[i, i] += damping * damping

    # Lower triangle: columns l d below the diagonal, 1 / d on it.
    for j in range(_N):
        inverse = 1.0 / S[j, j]
        for i in range(j + 1, _N):
            factor = S[i, j] * inverse
            for k in range(j + 1, i + 1):
                S[i, k] -= factor * S[k, j]
        S[j, j] = inverse

    for i in range(_N):
        value = xdot[i]
        for k in range(i):
            value -= S[i, k] * qdot[k]
        qdot[i] = value * S[i, i]
    for i in range(_N - 2, -1, -1):
        value = 0.0
        for k in range(i + 1, _N):
            value += S[k, i] * qdot[k]
        qdot[i] -= value * S[i, i]

    y0, y1, y2, y3, y4, y5 = qdot[0], qdot[1], qdot[2], qdot[3], qdot[4], qdot[5]
    for k in range(_N):
        qdot[k] = J[0, k] * y0 + J[1, k] * y1 + J[2, k] * y2 + J[3, k] * y3 + J[4, k] * y4 + J[5, k] * y5
