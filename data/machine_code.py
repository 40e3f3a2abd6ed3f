"""Where compiled functions are kept, so that every change of their sources is noticed.

Numba's own cache looks at the file a function stands in, but machine code contains what the function
calls, too: after a change in ``kinematics.py`` a cached control loop would go on with the old
kinematics. So machine code is kept in a folder named by a hash of the function's file and of every
file of this project that it imports, directly or not.
"""

import contextlib
import functools
import hashlib
import os
import re
import shutil
import time
from collections.abc import Iterator
from pathlib import Path

import platformdirs

PACKAGES = ("analysis", "data", "sim_trials")
_HOUSE = Path(__file__).parents[1]
_IMPORT = re.compile(rf"^\s*from ((?:{'|'.join(PACKAGES)})\.[\w.]+) import".encode(), re.MULTILINE)
_KEEP_S = 7 * 24 * 3600.0
"""Machine code of an older state of the sources is removed after a week without use."""


@contextlib.contextmanager
def machine_code_of(source: str) -> Iterator[bool]:
    """Within it, numba keeps the code of the functions of one file where it belongs.

    Parameters
    ----------
    source : str
        The file that the functions stand in.

    Yields
    ------
    bool
        False where nothing can be kept; ``cache=True`` would fail then.
    """
    import numba

    folder = folder_of(source)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = folder or before
    try:
        yield folder is not None
    finally:
        numba.config.CACHE_DIR = before


@functools.cache
def folder_of(source: str) -> str | None:
    """The folder for machine code of the functions in one file; None where none can be written."""
    root = _root()
    sources = _sources(Path(source), {})
    if sources and not any(_HOUSE / package in Path(source).parents for package in PACKAGES):
        # A method from another package: what it calls there stands beside it.
        for neighbour in Path(source).parent.glob("*.py"):
            _sources(neighbour, sources)
    if root is None or not sources:
        return None
    import numba

    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(sources):
        digest.update(path.name.encode() + b"\0" + sources[path])
    folder = root / digest.hexdigest()[:16]
    with contextlib.suppress(OSError):
        folder.mkdir(exist_ok=True)
        os.utime(folder)
        return str(folder)
    return None


@functools.cache
def _root() -> Path | None:
    """Where all is kept: ``NUMBA_CACHE_DIR``, next to the sources, or the user's cache folder."""
    import numba

    choices = [Path(__file__).parent / "__pycache__", platformdirs.user_cache_path("elbowroom")]
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


def _sources(path: Path, found: dict[Path, bytes]) -> dict[Path, bytes]:
    """The file, and all of this project that it imports, added to ``found``."""
    if path not in found and path.is_file():
        found[path] = path.read_bytes()
        for name in _IMPORT.findall(found[path]):
            _sources(_HOUSE.joinpath(*name.decode().split(".")).with_suffix(".py"), found)
    return found
