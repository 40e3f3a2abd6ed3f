"""One way to compile a function; its machine code is kept for the next start."""

from collections.abc import Callable
from typing import TypeVar

import numba
from numba.core import types

from data.machine_code import machine_code_of

Function = TypeVar("Function", bound=Callable[..., object])

VECTOR = types.Array(types.float64, 1, "C")
"""Type of a contiguous array of floats, for signatures."""

MATRIX = types.Array(types.float64, 2, "C")
"""Type of a contiguous (row-major) matrix of floats, for signatures."""


def compiled(signature: object, *, cache: bool = True) -> Callable[[Function], Function]:
    """Decorator: compile a function for one signature, at import, or load it from the cache.

    Division by zero gives inf or nan as in NumPy, and the global interpreter lock is released.

    Parameters
    ----------
    signature : str, numba signature or None
        The only signature: a call with other types is an error, not a second compilation. None
        compiles at the first call, for the types it is called with.
    cache : bool
        False for a function that holds an address of this process, which no other may load.
    """

    def decorate(function: Function) -> Function:
        with machine_code_of(function.__code__.co_filename) as is_kept:
            result: Function = numba.njit(
                signature, cache=cache and is_kept, error_model="numpy", nogil=True
            )(function)
        return result

    return decorate
