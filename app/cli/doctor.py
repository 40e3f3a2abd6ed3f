"""`elbowroom doctor`: what this machine lacks, in plain words."""

import os
import platform
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import numpy as np

from data.errors import ElbowroomError


@dataclass(frozen=True)
class Finding:
    """One thing looked at; ``good`` is None where it is only slower or optional."""

    good: bool | None
    text: str


def doctor() -> None:
    """Check this machine: Python, MuJoCo, compilers, the store's folder, a browser.

    Example: elbowroom doctor
    """
    failed = False
    for check in CHECKS:
        finding = check()
        mark = {True: "ok  ", None: "note", False: "FAIL"}[finding.good]
        print(f"{mark}  {finding.text}")
        failed = failed or finding.good is False
    if failed:
        raise ElbowroomError("this machine cannot run everything: see the lines marked FAIL")


def _python() -> Finding:
    cores = os.cpu_count() or 1
    return Finding(
        sys.version_info >= (3, 11),
        f"Python {platform.python_version()} on {platform.system()} {platform.machine()}, {cores} cores "
        "(3.11 or newer is needed)",
    )


def _mujoco() -> Finding:
    from sim_trials.model import new_robot

    try:
        new_robot(np.zeros(6))
    except Exception as error:
        return Finding(False, f"MuJoCo {metadata.version('mujoco')} cannot load the UR10: {error}")
    return Finding(True, f"MuJoCo {metadata.version('mujoco')} loads the UR10")


def _cpp_compiler() -> Finding:
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler:
        return Finding(True, "C++ compiler found: PyTensor runs at full speed")
    return Finding(
        None,
        "no C++ compiler: what PyTensor evaluates by itself is slow, such as the pymc engine's pointwise "
        "log-likelihoods; rankings need no compiler, whichever the engine",
    )


def _numba_cache() -> Finding:
    import numba

    import sim_trials

    folder = Path(sim_trials.__path__[0])
    writable = os.access(folder, os.W_OK)
    where = "beside the source" if writable else "in the user's cache folder"
    return Finding(True, f"numba {numba.__version__} keeps compiled code {where}")


def _store() -> Finding:
    from data.locations import default_store

    folder = Path(default_store()).parent
    existing = next(p for p in (folder, *folder.parents) if p.exists())
    if not os.access(existing, os.W_OK):
        return Finding(False, f"the default store's folder {folder} is not writable: give --store")
    free = shutil.disk_usage(existing).free
    return Finding(
        free > 200e6 or None, f"default store in {folder}, {free / 1e9:.1f} GB free (a study needs about 0.1)"
    )


def _browser() -> Finding:
    for name in ("chromium", "chromium-browser", "google-chrome", "chrome"):
        if shutil.which(name):
            return Finding(True, f"{name} found: the browser tests can run")
    return Finding(None, "no Chromium: browser tests are skipped (on Debian: apt-get install chromium)")


CHECKS: tuple[Callable[[], Finding], ...] = (_python, _mujoco, _cpp_compiler, _numba_cache, _store, _browser)
