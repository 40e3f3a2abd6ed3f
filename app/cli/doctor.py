"""`elbowroom doctor`: what this machine lacks, in plain words."""

import os
import platform
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from data.errors import ElbowroomError
from data.private_parts import installed_version

_ANSWERS = """participant,mode_a,mode_b,response
p1,M1,M2,A>B
p2,M2,M1,B>A
p3,M1,M2,A>B
p4,M2,M1,A>B
"""
"""Three people of four prefer M1."""


@dataclass(frozen=True)
class Finding:
    """One thing looked at; ``good`` is None where it is only slower or optional."""

    good: bool | None
    text: str


def doctor() -> None:
    """Check this machine: a lap on MuJoCo, a fit, a store, compilers, a browser. It does what it checks.

    Example: elbowroom doctor
    """
    failed = False
    for name, check in CHECKS.items():
        finding = _isolated(name, check)
        mark = {True: "ok  ", None: "note", False: "FAIL"}[finding.good]
        print(f"{mark}  {finding.text}")
        failed = failed or finding.good is False
    if failed:
        raise ElbowroomError("this machine cannot run everything: see the lines marked FAIL")


def _isolated(name: str, check: Callable[[], Finding]) -> Finding:
    """What a check finds; whatever it raises is a finding of one line, and the next check is made."""
    try:
        return check()
    except Exception as error:
        reason = " ".join(str(error).split()) or "no reason given"
        kind = "" if isinstance(error, ElbowroomError) else f"{type(error).__name__}: "
        return Finding(False, f"{name}: {kind}{reason}")


def _python() -> Finding:
    cores = os.cpu_count() or 1
    return Finding(
        sys.version_info >= (3, 11),
        f"Python {platform.python_version()} on {platform.system()} {platform.machine()}, {cores} cores "
        "(3.11 or newer is needed)",
    )


def _lap() -> Finding:
    from app.studies import open_study
    from sim_trials.operators import draw_operator
    from sim_trials.trial import run_trial

    started = time.perf_counter()
    study = open_study("carmichael2017").study
    lap = run_trial(study, study.mode_names[-1], draw_operator(3), seed=1)
    return Finding(
        lap.outcome != "failed",
        f"MuJoCo {installed_version('mujoco')} steps a lap of the UR10: {lap.outcome} after "
        f"{lap.duration_s:.1f} simulated s ({time.perf_counter() - started:.1f} s here, with compiling)",
    )


def _fit() -> Finding:
    from analysis.fit import fit
    from data.response_csv import read_response_csv

    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "answers.csv"
        path.write_text(_ANSWERS, encoding="utf-8")
        question = fit(read_response_csv(path)).questions[0]
    best = max(question.modes, key=lambda mode: mode.worth_mean).mode
    return Finding(
        best == "M1",
        f"nutpie {installed_version('nutpie')} samples a fit of four answers: {best} ranks first "
        f"({time.perf_counter() - started:.1f} s, with compiling)",
    )


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
    from data.store import Store

    with tempfile.TemporaryDirectory() as place, Store.open(Path(place) / "probe.sqlite") as probe:
        probe.log("doctor", "looked")
        if not probe.verify_audit().is_intact:
            return Finding(False, "a new store does not keep what is written to it")
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


CHECKS: dict[str, Callable[[], Finding]] = {
    "Python": _python,
    "a lap of the robot": _lap,
    "a fit": _fit,
    "compiler": _cpp_compiler,
    "numba's cache": _numba_cache,
    "store": _store,
    "browser": _browser,
}
