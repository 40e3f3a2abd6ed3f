"""Abilities to worths."""

import numpy as np
from numpy.typing import NDArray


def worth_of(ability: NDArray[np.float64]) -> NDArray[np.float64]:
    """``softmax`` over the last axis: each worth in 0..1, summing to 1 (Bradley & Terry 1952).

    Parameters
    ----------
    ability : ndarray, shape (..., mode)
        [logit]
    """
    odds = np.exp(ability - ability.max(axis=-1, keepdims=True))
    return odds / odds.sum(axis=-1, keepdims=True)
