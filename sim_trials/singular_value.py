"""The smallest singular value of a 6 x 6 matrix, fast and to nearly full precision.

A control step needs sigma_min once or twice, and nothing else of the decomposition. So J is reduced
to bidiagonal form B, and the smallest eigenvalue of B'B is found alone, without ever forming J J'
(which would leave no correct digit below 1e-8): Laguerre's iteration climbs to it from zero, with
the pivots of B'B - tau computed by the differential quotient-difference recurrence, which keeps
high relative accuracy.

References
----------
Golub, Kahan (1965), "Calculating the singular values and pseudo-inverse of a matrix".
Fernando, Parlett (1994), "Accurate singular values and differential qd algorithms".
Parlett (1998), "The symmetric eigenvalue problem", section 7.5 and appendix (Laguerre).
"""

import math

import numpy as np

from sim_trials.compiled import compiled

_N = 6
_MAX_STEPS = 60
"""Far more Laguerre steps than ever taken (measured: at most 8), so that the loop ends whatever comes."""


@compiled("void(float64[:, ::1], float64[::1], float64[::1])")
def _squared_bidiagonal(A: np.ndarray, q: np.ndarray, e: np.ndarray) -> None:
    """Reduce A by Householder reflections to upper bidiagonal; write the squares of its two diagonals.

    A is overwritten. A column or row that is already zero is left alone.
    """
    for k in range(_N):
        square = 0.0
        for i in range(k, _N):
            square += A[i, k] * A[i, k]
        q[k] = square
        if k < _N - 1 and square > 0.0:
            norm = math.copysign(math.sqrt(square), A[k, k])
            A[k, k] += norm
            scale = 1.0 / (norm * A[k, k])
            for j in range(k + 1, _N):
                dot = 0.0
                for i in range(k, _N):
                    dot += A[i, k] * A[i, j]
                dot *= scale
                for i in range(k, _N):
                    A[i, j] -= dot * A[i, k]
        if k == _N - 1:
            break
        square = 0.0
        for j in range(k + 1, _N):
            square += A[k, j] * A[k, j]
        e[k] = square
        if k < _N - 2 and square > 0.0:
            norm = math.copysign(math.sqrt(square), A[k, k + 1])
            A[k, k + 1] += norm
            scale = 1.0 / (norm * A[k, k + 1])
            for i in range(k + 1, _N):
                dot = 0.0
                for j in range(k + 1, _N):
                    dot += A[k, j] * A[i, j]
                dot *= scale
                for j in range(k + 1, _N):
                    A[i, j] -= dot * A[k, j]


@compiled("float64(float64[:, ::1])")
def smallest_singular_value(J: np.ndarray) -> float:
    """The smallest singular value of J; exactly zero where J is exactly singular.

    Parameters
    ----------
    J : ndarray, shape (6, 6)
        A Jacobian in m and rad (entries up to about 1e70 are safe). It is not changed.

    Returns
    -------
    float
        sigma_min, with an error of a few units of rounding of the **largest** singular value.
    """
    work = np.empty((_N + 2, _N))
    A, q, e = work[:_N], work[_N], work[_N + 1]
    for i in range(_N):
        for j in range(_N):
            A[i, j] = J[i, j]
    _squared_bidiagonal(A, q, e)

    # Pivots below this stand for an exact zero; far under the rounding of J, far above underflow.
    floor = 0.0
    for i in range(_N - 1):
        floor += 1e-40 * (q[i] + e[i])
    floor += 1e-40 * q[_N - 1]
    tau = 0.0
    previous = 0.0
    for _ in range(_MAX_STEPS):
        # p_i are the pivots of B'B - tau; u1, u2 the first and second derivatives of d by tau.
        d, d1, d2 = q[0] - tau, -1.0, 0.0
        s1, s2 = 0.0, 0.0
        for i in range(_N - 1):
            p = d + e[i]
            if not (d > floor and p > floor):
                return math.sqrt(tau)
            inverse = 1.0 / p
            g1 = d1 * inverse
            g2 = d2 * inverse
            s1 -= g1
            s2 += g1 * g1 - g2
            # d_next = q d / p - tau, and d / p = 1 - e / p.
            ratio = q[i + 1] * inverse
            bend = ratio * e[i] * inverse
            d2 = bend * (d2 - 2.0 * d1 * g1)
            d1 = bend * d1 - 1.0
            d = ratio * d - tau
        if not d > floor:
            return math.sqrt(tau)
        g1 = d1 / d
        s1 -= g1
        s2 += g1 * g1 - d2 / d
        # Laguerre from below all the roots: never passes the smallest one.
        root = math.sqrt(max(0.0, (_N - 1) * (_N * s2 - s1 * s1)))
        step = _N / (s1 + root)
        tau += step
        # Convergence is cubic, or linear towards a multiple root: what would come next is below
        # step (step / previous)^2 in both cases.
        gain = step / previous
        if step * gain * gain <= 1e-15 * tau:
            break
        previous = step
    return math.sqrt(tau)
