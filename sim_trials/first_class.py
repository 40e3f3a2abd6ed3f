"""Functions by their addresses, for compiled code that Python calls every few milliseconds.

Numba looks up the type and the address of a function each time it is passed as an argument: 20 to 80 us,
more than a control tick. An address is a plain number, and compiled code makes of it, at no cost, the same
first-class function that the argument would have been.
"""

from collections.abc import Callable
from typing import Any

from numba.core import cgutils, types, typing
from numba.core.base import BaseContext
from numba.extending import intrinsic

from data.private_parts import require
from sim_trials.model import STEP_TYPE
from sim_trials.modes.method import MODE_SIGNATURE, MODE_TYPE, ModeFunction

require("numba", cgutils, "create_struct_proxy", "voidptr_t")


def mode_address(function: ModeFunction) -> int:
    """Address of a method's compiled function; valid as long as the function lives."""
    require("numba", function, "get_compile_result")
    result = function.get_compile_result(MODE_SIGNATURE)  # type: ignore[attr-defined]
    require("numba", result.library, "get_pointer_to_function")
    require("numba", result.fndesc, "llvm_cfunc_wrapper_name")
    address: int = result.library.get_pointer_to_function(result.fndesc.llvm_cfunc_wrapper_name)
    return address


def _function_at(function_type: types.FunctionType) -> Callable[[int], Any]:
    """An intrinsic: the first-class function of a type at an address."""

    def typed(context: object, address: types.Integer) -> tuple[typing.Signature, Callable[..., object]]:
        def generate(
            context: BaseContext, builder: Any, signature: typing.Signature, values: list[Any]
        ) -> object:
            nothing = context.get_constant_null(function_type)
            made = cgutils.create_struct_proxy(function_type)(context, builder, value=nothing)
            made.c_addr = builder.inttoptr(values[0], cgutils.voidptr_t)
            return made._getvalue()

        return function_type(types.intp), generate

    return intrinsic(typed)


step_at: Callable[[int], Callable[[int, int], None]] = _function_at(STEP_TYPE)
"""In compiled code: MuJoCo's step at an address."""

mode_at: Callable[[int], ModeFunction] = _function_at(MODE_TYPE)
"""In compiled code: a method's function at an address."""
