"""Vectors that sum to zero, by K - 1 free coordinates: exactly ZeroSumNormal if those are normal."""

import numpy as np
from numpy.typing import NDArray


def zero_sum_basis(n: int) -> NDArray[np.float64]:
    """An orthonormal basis of the vectors of length ``n`` that sum to zero.

    ``basis @ u`` with ``u ~ Normal(0, sd^2 I)`` has covariance ``sd^2 (I - 1/n)``, which is that of
    ZeroSumNormal(sd). The columns are those of the Householder reflection that takes the last axis to the
    constant vector, so that ``basis @ u`` costs O(n) instead of O(n^2) where it is applied by hand.

    Returns
    -------
    ndarray, shape (n, n - 1)
    """
    root = np.sqrt(n)
    basis = np.eye(n, n - 1) - 1.0 / (root + n)
    basis[-1] = -1.0 / root
    return basis
