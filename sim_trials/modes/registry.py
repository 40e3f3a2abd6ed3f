"""The methods that exist, and how a mode of a study becomes one of them.

Every file of this folder that defines ``METHOD`` is an entry, under the file's name. So is every ``METHOD``
that an installed package names as an entry point of the group `ENTRY_POINT_GROUP`, under the entry point's
name::

    [project.entry-points."elbowroom.modes"]
    my_method = "my_package.my_method:METHOD"
"""

import importlib
import pkgutil
from importlib.metadata import EntryPoint, entry_points

from data.errors import ElbowroomError, InputError, one_of
from data.study import Mode
from sim_trials import modes
from sim_trials.modes.method import MODE_SIGNATURE, Method, ResolvedMode

ENTRY_POINT_GROUP = "elbowroom.modes"
"""Where packages announce methods of their own."""


def discover() -> dict[str, Method]:
    """Read every file of this folder and every entry point; see the head of this module.

    Raises
    ------
    ElbowroomError
        A method has another name than its file or entry point, a name is taken, or a package that announces
        a method cannot be imported or announces something else; the line names the file or the package.
    """
    found = _own()
    for point in entry_points(group=ENTRY_POINT_GROUP):
        if point.name in found:
            raise ElbowroomError(f"{_described(point)}: there is a method of this name already")
        found[point.name] = _announced(point)
    return dict(sorted(found.items()))


def _own() -> dict[str, Method]:
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


def _announced(point: EntryPoint) -> Method:
    """The method of an installed package, checked, since its author's tests may not have been."""
    where = _described(point)
    try:
        method = point.load()
    # Whatever a package raises while it is imported.
    except Exception as error:
        raise ElbowroomError(f"{where}: cannot be imported: {type(error).__name__}: {error}") from error
    if not isinstance(method, Method):
        raise ElbowroomError(f"{where}: is a {type(method).__name__}, not a sim_trials.modes.method.Method")
    if method.name != point.name:
        raise ElbowroomError(f"{where}: METHOD.name is {method.name!r}, not the entry point's name")
    if tuple(MODE_SIGNATURE.args) not in getattr(method.function, "signatures", ()):
        raise ElbowroomError(f"{where}: its function is not decorated with @mode_function")
    return method


def _described(point: EntryPoint) -> str:
    package = point.dist.name if point.dist else "unknown package"
    return f"method {point.name} of {package} ({point.value})"


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
        Unknown method or parameter, a value outside its range, or two values that contradict each other; the
        line lists what is valid.
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
    by_name = dict(zip(method.parameter_names, values, strict=True))
    for smaller, larger in method.ascending:
        if by_name[smaller] >= by_name[larger]:
            raise InputError(
                f"mode {mode.name}: {smaller} = {by_name[smaller]:g} must be smaller than"
                f" {larger} = {by_name[larger]:g}"
            )
    return ResolvedMode(mode.name, method, tuple(values))
