"""One way to compile a function, and a cache of machine code that notices every change.

Numba's own cache looks at the file a function stands in, but machine code contains what the function
calls, too: after a change in ``kinematics.py`` a cached control loop would go on with the old
kinematics. So machine code is kept in a folder named by a hash of the function's file and of every
file of this package that it imports, directly or not.
"""

import contextlib
import functools
import hashlib
import os
import re
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numba
import platformdirs
from numba.core import types

Function = TypeVar("Function", bound=Callable[..., object])

VECTOR = types.Array(types.float64, 1, "C")
"""Type of a contiguous array of floats, for signatures."""

MATRIX = types.Array(types.float64, 2, "C")
"""Type of a contiguous (row-major) matrix of floats, for signatures."""

_PACKAGE = Path(__file__).parent
_IMPORT = re.compile(rb"^\s*from sim_trials\.([\w.]+) import", re.MULTILINE)
_KEEP_S = 7 * 24 * 3600.0
"""Machine code of an older state of the sources is removed after a week without use."""


def _sources(path: Path, found: dict[Path, bytes]) -> dict[Path, bytes]:
    """The file, and all of this package that it imports, added to ``found``."""
    if path not in found and path.is_file():
        found[path] = path.read_bytes()
        for name in _IMPORT.findall(found[path]):
            _sources(_PACKAGE.joinpath(*name.decode().split(".")).with_suffix(".py"), found)
    return found


@functools.cache
def _cache_root() -> Path | None:
    """Where machine code is kept: ``NUMBA_CACHE_DIR``, next to the sources, or the user's cache folder."""
    choices = [_PACKAGE / "__pycache__", platformdirs.user_cache_path("elbowroom")]
    if numba.config.CACHE_DIR:
        choices = [Path(numba.config.CACHE_DIR)]
    for choice in choices:
        root = choice / "machine_code"
        with contextlib.suppress(OSError):
            root.mkdir(parents=True, exist_ok=True)
            if os.access(root, os.W_OK):
                for folder in root.iterdir():
                    if time.time() - folder.stat().st_mtime > _KEEP_S:
                        shutil.rmtree(folder, ignore_errors=True)
                return root
    return None


@functools.cache
def _cache_folder(source: str) -> str | None:
    """The folder for machine code of the functions in one file; None where none can be written."""
    root = _cache_root()
    sources = _sources(Path(source), {})
    if sources and _PACKAGE not in Path(source).parents:
        # A method from another package: what it calls there stands beside it.
        for neighbour in Path(source).parent.glob("*.py"):
            _sources(neighbour, sources)
    if root is None or not sources:
        return None
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(sources):
        digest.update(path.name.encode() + b"\0" + sources[path])
    folder = root / digest.hexdigest()[:16]
    with contextlib.suppress(OSError):
        folder.mkdir(exist_ok=True)
        os.utime(folder)
        return str(folder)
    return None


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
        folder = _cache_folder(function.__code__.co_filename) if cache else None
        before = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = folder or before
        try:
            result: Function = numba.njit(
                signature, cache=folder is not None, error_model="numpy", nogil=True
            )(function)
        finally:
            numba.config.CACHE_DIR = before
        return result

    return decorate
