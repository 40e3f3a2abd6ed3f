"""How the density's functions are compiled; their machine code is kept for the next start."""

from collections.abc import Callable
from typing import TypeVar

import numba

from data.machine_code import machine_code_of

Function = TypeVar("Function", bound=Callable[..., object])

REGROUPED = frozenset({"contract", "reassoc"})
"""Sums may be regrouped, so that several terms are added at a time."""
FUSED = frozenset({"contract"})
"""Products may be fused with sums; nothing else is moved."""


def compiled(fastmath: frozenset[str] = frozenset()) -> Callable[[Function], Function]:
    """Decorator: compile a function at its first call, for the types it is called with, or load it.

    Division by zero gives inf or nan as in NumPy, and the global interpreter lock is released.
    """

    def decorate(function: Function) -> Function:
        with machine_code_of(function.__code__.co_filename) as is_kept:
            result: Function = numba.njit(
                cache=is_kept, error_model="numpy", nogil=True, fastmath=set(fastmath)
            )(function)
        return result

    return decorate


def c_function(signature: object) -> Callable[[Function], "numba.core.ccallback.CFunc"]:
    """Decorator: compile a function that C can call by its ``address``, or load it."""

    def decorate(function: Function) -> "numba.core.ccallback.CFunc":
        with machine_code_of(function.__code__.co_filename) as is_kept:
            return numba.cfunc(signature, cache=is_kept, error_model="numpy")(function)

    return decorate
