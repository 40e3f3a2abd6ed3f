"""Parts of other packages that are no public interface are there, each with what it is used for.

A failure here names the package, its version and what is missing: it is the first thing to look at after an
upgrade. Nothing else would say it as plainly.
"""

import ctypes
import inspect
import re
from collections.abc import Callable
from importlib import metadata
from pathlib import Path

import mujoco
import numba
import pytest
import streamlit
import typer
from numba.core import cgutils, types
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.http11 import Request

from analysis.engines import nuts
from data.errors import ElbowroomError
from data.private_parts import require, unsuitable
from sim_trials import model
from sim_trials.modes.method import MODE_SIGNATURE
from sim_trials.modes.registry import discover

HOUSE = Path(__file__).resolve().parents[1]
TEST_ID = re.compile(r'data-testid="([A-Za-z-]+)"')


def nutpie_core() -> str:
    """analysis/engines/nuts.py samples by nutpie's core alone, without its Python layer."""
    try:
        nuts._core()
    except ElbowroomError as error:
        return str(error)
    return ""


def mujoco_addresses() -> str:
    """sim_trials/model.py hands the addresses of model and data to compiled loops."""
    robot_model = model.ur10_model()
    data = mujoco.MjData(robot_model)
    for owner in (robot_model, data):
        if not isinstance(getattr(owner, "_address", None), int):
            return f"{type(owner).__name__}._address is not a number"
    # The first entries of both structures, read at these addresses, are the model's sizes and the time.
    if ctypes.c_longlong.from_address(robot_model._address).value & 0xFFFFFFFF != robot_model.nq:
        return "mjModel does not begin with nq"
    return ""


def mujoco_library() -> str:
    """sim_trials/model.py calls mj_step of the library that the bindings use."""
    try:
        library = model._library()
    except ElbowroomError as error:
        return str(error)
    if library.mj_version() != mujoco.mj_version():
        return f"library {library.mj_version()}, bindings {mujoco.mj_version()}"
    return "" if hasattr(library, "mj_step") else "no mj_step"


def numba_function_types() -> str:
    """sim_trials/model.py and first_class.py pass functions by address."""
    owners = {
        types: ("FunctionType", "WrapperAddressProtocol"),
        cgutils: ("create_struct_proxy", "voidptr_t"),
    }
    missing = [
        f"{o.__name__}.{name}" for o, names in owners.items() for name in names if not hasattr(o, name)
    ]
    return f"no {', '.join(missing)}" if missing else ""


def numba_compile_results() -> str:
    """sim_trials/first_class.py asks a compiled function for its address."""
    function = discover()["dls"].function
    if not hasattr(function, "get_compile_result"):
        return "no Dispatcher.get_compile_result"
    result = function.get_compile_result(MODE_SIGNATURE)
    if not hasattr(result.library, "get_pointer_to_function"):
        return "no CodeLibrary.get_pointer_to_function"
    return "" if hasattr(result.fndesc, "llvm_cfunc_wrapper_name") else "no llvm_cfunc_wrapper_name"


def numba_cache_folder() -> str:
    """data/machine_code.py sets the folder for machine code while a function is decorated."""
    return "" if hasattr(numba.config, "CACHE_DIR") else "no config.CACHE_DIR"


def numba_c_functions() -> str:
    """analysis/engines/nuts.py gives nutpie the address of a compiled density."""
    return "" if isinstance(getattr(nuts._density, "address", None), int) else "no address of a cfunc"


def uvicorn_websocket() -> str:
    """app/server/live/socket.py answers the request that opens a websocket."""
    handle = getattr(WebSocketsSansIOProtocol, "handle_connect", None)
    if handle is None:
        return "no WebSocketsSansIOProtocol.handle_connect"
    taken = list(inspect.signature(handle).parameters)
    if taken != ["self", "event"]:
        return f"handle_connect takes {taken}, not self and event"
    source = inspect.getsource(WebSocketsSansIOProtocol)
    return (
        "" if "self.transport" in source and "self.handle_connect(event)" in source else "no self.transport"
    )


def websockets_request() -> str:
    """app/server/live/socket.py reads the path and removes a header."""
    fields = set(getattr(Request, "__dataclass_fields__", {}))
    missing = {"path", "headers"} - fields
    return f"no Request.{', Request.'.join(sorted(missing))}" if missing else ""


def streamlit_app() -> str:
    """app/server/asgi.py mounts Streamlit's app in its own."""
    from streamlit import starlette

    return "" if hasattr(starlette, "App") else "no streamlit.starlette.App"


def streamlit_components() -> str:
    """app/stage and app/console show pages of their own as components of version 2."""
    from streamlit.components.v2 import types as component_types

    missing = [] if hasattr(component_types, "ComponentRenderer") else ["types.ComponentRenderer"]
    missing += [] if hasattr(streamlit.components.v2, "component") else ["component"]
    return f"no streamlit.components.v2.{missing[0]}" if missing else ""


def streamlit_test_ids() -> str:
    """The style sheets of app/ find Streamlit's own elements by their test ids."""
    used = set()
    for path in (*(HOUSE / "app").rglob("*.css"), *(HOUSE / "app").rglob("*.py")):
        used |= set(TEST_ID.findall(path.read_text(encoding="utf-8")))
    scripts = (Path(streamlit.__file__).parent / "static").rglob("*.js")
    bundle = "\n".join(path.read_text(encoding="utf-8", errors="replace") for path in scripts)
    assert len(used) > 10
    # Buttons are named by their kind, in two parts: `stBaseButton-` and `primary`.
    missing = sorted(name for name in used if name not in bundle and name.partition("-")[0] not in bundle)
    return f"no element with test id {', '.join(missing)}" if missing else ""


def typer_errors() -> str:
    """app/cli/main.py turns every wrong option into one line."""
    return "" if hasattr(getattr(typer, "TyperException", None), "format_message") else "no TyperException"


PARTS: tuple[tuple[str, Callable[[], str]], ...] = (
    ("nutpie", nutpie_core),
    ("mujoco", mujoco_addresses),
    ("mujoco", mujoco_library),
    ("numba", numba_function_types),
    ("numba", numba_compile_results),
    ("numba", numba_cache_folder),
    ("numba", numba_c_functions),
    ("uvicorn", uvicorn_websocket),
    ("websockets", websockets_request),
    ("streamlit", streamlit_app),
    ("streamlit", streamlit_components),
    ("streamlit", streamlit_test_ids),
    ("typer", typer_errors),
)


@pytest.mark.parametrize(("package", "look"), PARTS, ids=[look.__name__ for _, look in PARTS])
def test_a_private_part_is_there(package: str, look: Callable[[], str]) -> None:
    missing = look()
    if missing:
        pytest.fail(
            f"{package} {metadata.version(package)}: {missing}. Needed: {look.__doc__}", pytrace=False
        )


def test_a_part_that_is_missing_is_one_line_with_package_version_and_remedy() -> None:
    with pytest.raises(ElbowroomError) as raised:
        require("numba", types, "float64", "no_such_type")
    version = metadata.version("numba")
    assert str(raised.value).startswith(
        f"numba {version} is installed, which Elbowroom cannot use (it has no "
    )
    assert "numba.core.types.no_such_type" in str(raised.value)
    line = str(unsuitable("nutpie", "no such thing", nuts.NUTPIE))
    assert line.endswith("(no such thing): pip install 'nutpie>=0.16,<0.16.9'")
