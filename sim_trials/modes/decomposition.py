"""The singular value decomposition of a 6 x 6 Jacobian, by one-sided Jacobi rotations.

Methods that treat each singular direction by itself need all of it, not sigma_min alone. Rotations of
pairs of columns make J V orthogonal; its columns then are sigma_i u_i. It is exact to a few units of
rounding of the largest singular value, needs neither LAPACK nor memory that grows, and costs about a
third of the four physics steps of a control tick.

References
----------
Hestenes (1958), "Inversion of matrices by biorthogonalization and related results".
Demmel, Veselic (1992), "Jacobi's method is more accurate than QR".
"""

import math

import numpy as np

from sim_trials.compiled import compiled

_N = 6
_MAX_SWEEPS = 20
"""Far more sweeps than ever taken (measured: at most 7), so that the loop ends whatever comes."""
_ORTHOGONAL = 1e-30
"""Two columns are orthogonal when the square of their product is below this share of their squares."""
_NOTHING = 1e-140
"""Squares below this stand for an exact zero: their products would underflow."""


@compiled("boolean(float64[:, ::1], float64[:, ::1], float64[::1])")
def _sweep(W: np.ndarray, V: np.ndarray, squares: np.ndarray) -> bool:
    """Rotate every pair of rows of W once, and V alike; False if none needed it."""
    for i in range(_N):
        square = 0.0
        for k in range(_N):
            square += W[i, k] * W[i, k]
        squares[i] = square
    turned = False
    for i in range(_N - 1):
        for j in range(i + 1, _N):
            a, b = squares[i], squares[j]
            if a <= _NOTHING or b <= _NOTHING:
                continue
            c = 0.0
            for k in range(_N):
                c += W[i, k] * W[j, k]
            if c * c <= _ORTHOGONAL * a * b:
                continue
            turned = True
            zeta = (b - a) / (2.0 * c)
            t = math.copysign(1.0 / (abs(zeta) + math.sqrt(1.0 + zeta * zeta)), zeta)
            cosine = 1.0 / math.sqrt(1.0 + t * t)
            sine = t * cosine
            for k in range(_N):
                w, v = W[i, k], V[i, k]
                W[i, k] = cosine * w - sine * W[j, k]
                W[j, k] = sine * w + cosine * W[j, k]
                V[i, k] = cosine * v - sine * V[j, k]
                V[j, k] = sine * v + cosine * V[j, k]
            squares[i] = a - t * c
            squares[j] = b + t * c
    return turned


@compiled("void(float64[:, ::1], int64)")
def _complete(U: np.ndarray, i: int) -> None:
    """Make row i a unit vector across the rows before it."""
    best, most = 0, -1.0
    for axis in range(_N):
        # What is left of this axis across the rows so far; the largest is the safest to start from.
        left = 1.0
        for j in range(i):
            left -= U[j, axis] * U[j, axis]
        if left > most:
            best, most = axis, left
    for k in range(_N):
        U[i, k] = 1.0 if k == best else 0.0
    for _ in range(2):
        for j in range(i):
            dot = 0.0
            for k in range(_N):
                dot += U[i, k] * U[j, k]
            for k in range(_N):
                U[i, k] -= dot * U[j, k]
    square = 0.0
    for k in range(_N):
        square += U[i, k] * U[i, k]
    for k in range(_N):
        U[i, k] /= math.sqrt(square)


@compiled("void(float64[:, ::1], float64[:, ::1], float64[::1], float64[:, ::1])")
def decompose(J: np.ndarray, U: np.ndarray, sigma: np.ndarray, V: np.ndarray) -> None:
    """Write J = sum over i of sigma_i u_i v_i', the largest first.

    Parameters
    ----------
    J : ndarray, shape (6, 6)
        Jacobian in m and rad (entries up to about 1e70 are safe). It is not changed.
    U, V : ndarray, shape (6, 6), written
        **Row** i is u_i (task space) and v_i (joint space). Where sigma_i is zero, u_i is any unit vector
        across the others: its sign means nothing there.
    sigma : ndarray, shape (6,), written
        Singular values, descending; none is negative.
    """
    for i in range(_N):
        for j in range(_N):
            U[i, j] = J[j, i]
            V[i, j] = 1.0 if i == j else 0.0
    for _ in range(_MAX_SWEEPS):
        if not _sweep(U, V, sigma):
            break
    # The squares were brought along with the rotations; now they are taken from the columns.
    for i in range(_N):
        square = 0.0
        for k in range(_N):
            square += U[i, k] * U[i, k]
        sigma[i] = math.sqrt(square) if square > _NOTHING else 0.0
    for i in range(_N - 1):
        largest = i
        for j in range(i + 1, _N):
            if sigma[j] > sigma[largest]:
                largest = j
        if largest != i:
            sigma[i], sigma[largest] = sigma[largest], sigma[i]
            for k in range(_N):
                U[i, k], U[largest, k] = U[largest, k], U[i, k]
                V[i, k], V[largest, k] = V[largest, k], V[i, k]
    for i in range(_N):
        if sigma[i] > 1e-14 * sigma[0]:
            for k in range(_N):
                U[i, k] /= sigma[i]
        else:
            _complete(U, i)


@compiled("void(float64[:, ::1], float64[::1], float64[:, ::1], float64[::1], float64[::1])")
def recompose(U: np.ndarray, gains: np.ndarray, V: np.ndarray, xdot: np.ndarray, qdot: np.ndarray) -> None:
    """Write the sum over i of gains_i v_i (u_i . xdot): any inverse that treats each direction by itself.

    Parameters
    ----------
    U, V : ndarray, shape (6, 6)
        From `decompose`.
    gains : ndarray, shape (6,)
        What stands for 1 / sigma_i.
    xdot : ndarray, shape (6,)
        Commanded velocity of the handle [m/s, rad/s].
    qdot : ndarray, shape (6,), written
        Joint velocities [rad/s]; may not be ``xdot`` itself.
    """
    for k in range(_N):
        qdot[k] = 0.0
    for i in range(_N):
        share = 0.0
        for k in range(_N):
            share += U[i, k] * xdot[k]
        share *= gains[i]
        for k in range(_N):
            qdot[k] += share * V[i, k]
