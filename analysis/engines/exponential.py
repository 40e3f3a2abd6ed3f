"""``exp`` and ``log`` that a compiler can do for several numbers at a time, which calls of libm prevent.

Both are good to a few units in the last place on the range they are made for. They must not be compiled with
reassociation: their first lines live from rounding.
"""

import math

from numba import types
from numba.extending import intrinsic

from analysis.engines.compiled import FUSED, compiled

_ROUNDING = 1.5 * 2.0**52
"""Added to a small number it leaves the nearest whole number in the lowest bits."""
_PER_LN2 = 1.0 / math.log(2.0)
_LN2_HIGH = float.fromhex("0x1.62e42fee00000p-1")
"""ln 2 to 33 bits: times a small whole number it is exact."""
_LN2_LOW = 1.9082149292705877e-10
"""What is missing from ln 2."""
_C2, _C3, _C4, _C5, _C6, _C7, _C8, _C9, _C10, _C11, _C12 = (1 / math.factorial(k) for k in range(2, 13))
_ROOT2, _LN_ROOT2 = math.sqrt(2.0), 0.5 * math.log(2.0)


def _same_bits(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
    return builder.bitcast(arguments[0], context.get_value_type(signature.return_type))


@intrinsic
def _bits(typing, number):  # type: ignore[no-untyped-def]
    return types.int64(types.float64), _same_bits


@intrinsic
def _number(typing, bits):  # type: ignore[no-untyped-def]
    return types.float64(types.int64), _same_bits


@compiled(FUSED)
def exp(x: float) -> float:
    """``e^x`` for x in -700 .. 700: a power of two times a Taylor polynomial on half an ln 2 about 0."""
    shifted = x * _PER_LN2 + _ROUNDING
    n = shifted - _ROUNDING
    r = (x - n * _LN2_HIGH) - n * _LN2_LOW
    p = _C8 + r * (_C9 + r * (_C10 + r * (_C11 + r * _C12)))
    p = _C4 + r * (_C5 + r * (_C6 + r * (_C7 + r * p)))
    p = 1.0 + r * (1.0 + r * (_C2 + r * (_C3 + r * p)))
    # n goes to the exponent of p.
    return _number(_bits(p) + (_bits(shifted) << 52))


@compiled(FUSED)
def log_between_1_and_2(y: float) -> float:
    """``log y`` for y in 1 .. 2: ``log c + 2 artanh((y - c) / (y + c))`` with c the square root of 2."""
    s = (y - _ROOT2) / (y + _ROOT2)
    q = s * s
    p = 1 / 15 + q * (1 / 17 + q * (1 / 19 + q / 21))
    p = 1 / 7 + q * (1 / 9 + q * (1 / 11 + q * (1 / 13 + q * p)))
    return _LN_ROOT2 + 2.0 * s * (1.0 + q * (1 / 3 + q * (1 / 5 + q * p)))


@compiled(FUSED)
def log(y: float) -> float:
    """``log y`` for y from the least normal number on: its exponent, and the logarithm of what is left."""
    bits = _bits(y)
    power = (bits >> 52) - 1023
    # What is left has the exponent 0: a number from 1 to 2.
    left = _number((bits & 0x000FFFFFFFFFFFFF) | 0x3FF0000000000000)
    return power * _LN2_HIGH + (power * _LN2_LOW + log_between_1_and_2(left))
