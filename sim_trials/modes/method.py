"""What a method of handling singularities is: its equation, its parameters, its compiled function.

The compiled function has one signature for all methods, so that one compiled control loop takes any
of them as an argument::

    qdot_command(q[6], J[6,6], sigma, xdot[6], dt, parameters[:], memory[:], qdot_out[6]) -> None

q          joint angles [rad]
J          Jacobian at the handle centre, base frame, rows linear then angular
sigma      smallest singular value of J, already computed
xdot       commanded velocity of the handle, base frame [m/s, rad/s]
dt         control period [s]
parameters the method's parameters in their declared order
memory     16 floats for the method alone, zero at the start of a trial
qdot_out   written: joint velocities [rad/s]

Small scratch arrays inside a method (``np.empty``) cost about 30-80 ns each of a control tick of
20 us; the signature therefore carries none.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numba.core import types

from sim_trials.compiled import MATRIX, VECTOR, compiled

MEMORY_LENGTH = 16
"""How many floats a method may keep from one control tick to the next."""

MODE_SIGNATURE = types.void(VECTOR, MATRIX, types.float64, VECTOR, types.float64, VECTOR, VECTOR, VECTOR)
"""Signature of every method's compiled function."""

MODE_TYPE = types.FunctionType(MODE_SIGNATURE)
"""Type of a method as an argument of another compiled function."""

ModeFunction = Callable[
    [np.ndarray, np.ndarray, float, np.ndarray, float, np.ndarray, np.ndarray, np.ndarray], None
]

mode_function = compiled(MODE_SIGNATURE)
"""Decorator for a method's function."""


class Property(StrEnum):
    """A claim a method makes about itself. The tests hold every method to what it declares."""

    NEVER_REVERSES = "never_reverses"
    """The handle never moves against the command: xdot . J qdot >= 0."""

    NEVER_AMPLIFIES = "never_amplifies"
    """The handle never moves faster than commanded: |J qdot| <= |xdot|."""

    INVERSE_ABOVE_SIGMA_T = "inverse_above_sigma_t"
    """J qdot = xdot wherever sigma is at least the parameter ``sigma_t``."""

    WITHIN_SPEED_SHARE = "within_speed_share"
    """No joint is asked for more than the parameter ``speed_share`` of its speed limit."""

    WITHIN_GAMMA_MAX = "within_gamma_max"
    """No joint is asked for more than the parameter ``gamma_max`` [rad/s]."""

    DAMPED_GAIN = "damped_gain"
    """Joint velocities are bounded by the parameter ``lambda``: |qdot| <= |xdot| / (2 lambda)."""

    LEAST_RESIDUAL = "least_residual"
    """The step has the best length for its direction: (xdot - J qdot) . J qdot = 0, as long as no joint is at
    the parameter ``speed_share`` of its speed limit."""


@dataclass(frozen=True)
class Parameter:
    """One number of a method, with the range in which it makes sense (both ends included)."""

    name: str
    default: float
    low: float
    high: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class Method:
    """A way to turn a commanded handle velocity into joint velocities near a singularity.

    Attributes
    ----------
    name : str
        What a study file's ``method`` says; also the name of the file that defines it.
    summary : str
        One line for people.
    equation, latex : str
        The rule, as plain text and for typesetting.
    source : str
        Paper and equation number.
    function : compiled function
        See the head of this module.
    ascending : tuple of (str, str)
        Pairs of parameters of which the first must be smaller than the second.
    """

    name: str
    summary: str
    equation: str
    source: str
    parameters: tuple[Parameter, ...]
    function: ModeFunction = field(repr=False, compare=False)
    properties: frozenset[Property] = frozenset()
    latex: str = ""
    ascending: tuple[tuple[str, str], ...] = ()

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the parameters in the order in which the compiled function reads them."""
        return tuple(parameter.name for parameter in self.parameters)

    def __reduce__(self) -> tuple[Callable[[str], "Method"], tuple[str]]:
        """To another process a method goes by its name: its machine code stays where it is."""
        return _registered, (self.name,)


def _registered(name: str) -> Method:
    from sim_trials.modes.registry import METHODS

    return METHODS[name]


@dataclass(frozen=True)
class ResolvedMode:
    """A mode of a study, its method found and its parameters validated and complete.

    Attributes
    ----------
    name : str
        The mode's name in the study.
    values : tuple of float
        One value for each of ``method.parameters``, in their order.
    """

    name: str
    method: Method
    values: tuple[float, ...]

    @property
    def function(self) -> ModeFunction:
        """The compiled function to hand to the control loop."""
        return self.method.function

    def packed(self) -> np.ndarray:
        """The ``parameters`` argument of the compiled function: a new array, shape (n,)."""
        return np.array(self.values, dtype=np.float64)
