"""The methods that exist, and how a mode of a study becomes one of them.

Every file of this folder that defines ``METHOD`` is an entry, under the file's name.
"""

import importlib
import pkgutil

from data.errors import ElbowroomError, InputError, one_of
from data.study import Mode
from sim_trials import modes
from sim_trials.modes.method import Method, ResolvedMode


def discover() -> dict[str, Method]:
    """Read every file of this folder; see the head of this module."""
    found = {}
    for module_info in pkgutil.iter_modules(modes.__path__):
        if module_info.name == "registry":
            continue
        module = importlib.import_module(f"{modes.__name__}.{module_info.name}")
        method = getattr(module, "METHOD", None)
        if method is None:
            continue
        if method.name != module_info.name:
            raise ElbowroomError(f"{module.__file__}: METHOD.name is {method.name!r}, not the file's name")
        found[method.name] = method
    return found


METHODS: dict[str, Method] = discover()
"""Every method by name, in alphabetical order."""


def method_names() -> tuple[str, ...]:
    """What a study file may give as ``method``."""
    return tuple(METHODS)


def resolve(mode: Mode) -> ResolvedMode:
    """Find the method of a study's mode and complete its parameters.

    Raises
    ------
    InputError
        Unknown method or parameter, or a value outside its range; the line lists what is valid.
    """
    if mode.method not in METHODS:
        raise one_of(f"mode {mode.name}: method", mode.method, method_names())
    method = METHODS[mode.method]
    for name in mode.parameters:
        if name not in method.parameter_names:
            raise one_of(f"mode {mode.name}: parameter of {method.name}", name, method.parameter_names)
    values = []
    for parameter in method.parameters:
        value = float(mode.parameters.get(parameter.name, parameter.default))
        if not parameter.low <= value <= parameter.high:
            unit = f" {parameter.unit}" if parameter.unit else ""
            raise InputError(
                f"mode {mode.name}: {parameter.name} = {value:g} is not between"
                f" {parameter.low:g} and {parameter.high:g}{unit}"
            )
        values.append(value)
    return ResolvedMode(mode.name, method, tuple(values))
