"""nutpie's NUTS on a compiled density, without the seconds that ``import nutpie`` costs.

nutpie's Python layer imports ArviZ; its Rust core does not need it. The core is loaded by itself and calls
the compiled density by address, so that neither Python nor its lock stands between two leapfrog steps: chains
run on threads, and each has its own random stream, so that the number of threads cannot change a draw.
"""

import importlib.machinery
import importlib.util
import os
import sys
from dataclasses import dataclass
from functools import cache
from types import ModuleType

import numpy as np
from numba import carray, types
from numpy.typing import NDArray

from analysis.engines.compiled import REGROUPED, c_function, compiled
from analysis.engines.density import log_density
from data.errors import ElbowroomError
from data.private_parts import unsuitable

NUTPIE = "nutpie>=0.16,<0.16.9"
"""The versions whose core has the signatures below."""
_SIGNATURES = {
    "ExpandFunc": "(dim, expanded_dim, ptr, user_data_ptr, keep_alive)",
    "LogpFunc": "(ptr, user_data_ptr, keep_alive)",
    "ProgressType.none": "()",
    "PyMcModel": "(density, expand, variables, dim, dim_sizes, coords, init_func, transform_adapter)",
    "PyNutsSettings.Diag": "(seed=None)",
    "PySampler.from_pymc": "(settings, cores, model, progress_type, store)",
    "PyStorage.arrow": "()",
    "PyVariable.new_variables": "($cls, names, item_types, shapes, dim_sizes, dims)",
}
"""What is called in nutpie's core, which is no public interface: 0.16.9 to 0.16.11 have another."""

_DATA_SIZE = 1
"""The block handed to the core starts with the length of the packed data."""
_OK, _NOT_FINITE = 0, 4
"""Return codes of nutpie: 4 is an error the sampler recovers from, as a divergence."""


@compiled(REGROUPED)
def _are_finite(values: NDArray[np.float64]) -> bool:
    """True if all are finite: 0 times infinity or nan is nan, and so is any sum with it."""
    total = 0.0
    for j in range(values.shape[0]):
        total += 0.0 * values[j]
    return total == 0.0


@c_function(
    types.int64(
        types.uint64,
        types.CPointer(types.double),
        types.CPointer(types.double),
        types.CPointer(types.double),
        types.voidptr,
    )
)
def _density(n_dim, position, gradient, logp, block):  # type: ignore[no-untyped-def]  # pragma: no cover
    size = carray(block, (1,), dtype=np.int64)[0]
    data = carray(block, (_DATA_SIZE + size,), dtype=np.int64)[_DATA_SIZE:]
    x = carray(position, (n_dim,))
    slope = carray(gradient, (n_dim,))
    value = log_density(x, slope, data)
    carray(logp, (1,))[0] = value
    if not np.isfinite(value) or not _are_finite(slope):
        return _NOT_FINITE
    return _OK


@c_function(
    types.int64(
        types.uint64, types.uint64, types.CPointer(types.double), types.CPointer(types.double), types.voidptr
    )
)
def _kept(n_dim, n_kept, position, out, block):  # type: ignore[no-untyped-def]  # pragma: no cover
    x = carray(position, (n_dim,))
    kept = carray(out, (n_kept,))
    for j in range(n_kept):
        kept[j] = x[j]
    return _OK


@dataclass(frozen=True)
class Chains:
    """Raw draws: ``position`` (chain, draw, kept coordinate) and ``diverging`` (chain, draw)."""

    position: NDArray[np.float64]
    diverging: NDArray[np.bool_]


@cache
def _core() -> ModuleType:
    """nutpie's Rust core, loaded without nutpie's Python layer."""
    if "nutpie._lib" in sys.modules:
        return _checked(sys.modules["nutpie._lib"])
    package = importlib.util.find_spec("nutpie")
    if package is None or package.submodule_search_locations is None:
        raise ElbowroomError("engine fast: nutpie is not installed; install it or use another engine")
    places = list(package.submodule_search_locations)
    spec = importlib.machinery.PathFinder.find_spec("nutpie._lib", places)
    if spec is None or spec.loader is None:
        raise ElbowroomError(
            "engine fast: this nutpie has no compiled core; reinstall it or use another engine"
        )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    # An extension of this kind loads once a process: a later `import nutpie` must find this one.
    sys.modules["nutpie._lib"] = module
    return _checked(module)


def _checked(core: ModuleType) -> ModuleType:
    """The core, if what is called in it takes what it is called with."""
    for name, expected in _SIGNATURES.items():
        part: object = core
        for step in name.split("."):
            part = getattr(part, step, None)
        if getattr(part, "__text_signature__", None) != expected:
            has = f"{name}{getattr(part, '__text_signature__', '')}" if part else f"no {name}"
            raise unsuitable("nutpie", f"its core has {has}", NUTPIE)
    return core


def sample(
    data: NDArray[np.int64],
    n_dim: int,
    n_kept: int,
    *,
    seed: int,
    draws: int,
    tune: int,
    chains: int,
    target_accept: float,
    cores: int | None = None,
) -> Chains:
    """Draw from the density that ``data`` packs.

    Parameters
    ----------
    data : ndarray of int64
        ``analysis.engines.density.packed(problem)``.
    n_dim, n_kept : int
        Coordinates in all, and how many of the first are kept.
    cores : int, optional
        Chains sampled at a time; by default as many as this process may use.
    """
    core = _core()
    block = np.concatenate([np.array([len(data)], dtype=np.int64), data])
    address = block.ctypes.data
    sizes = {"kept": n_kept}

    def started(chain: int):  # type: ignore[no-untyped-def]
        of_chain = int(np.random.SeedSequence([seed, chain]).generate_state(1, np.uint64)[0])
        settings = core.PyNutsSettings.Diag(of_chain)
        settings.num_draws, settings.num_tune, settings.num_chains = draws, tune, 1
        settings.target_accept = target_accept
        model = core.PyMcModel(
            core.LogpFunc(_density.address, address, block),
            core.ExpandFunc(n_dim, n_kept, _kept.address, address, block),
            core.PyVariable.new_variables(["x"], ["float64"], [(n_kept,)], sizes, {"x": ("kept",)}),
            n_dim,
            sizes,
            {},
            lambda chain_seed: np.random.default_rng(chain_seed).uniform(-1.0, 1.0, n_dim),
            None,
        )
        return core.PySampler.from_pymc(settings, 1, model, core.ProgressType.none(), core.PyStorage.arrow())

    # The core keeps every coordinate and the gradient of every draw until a sampler is let go: 10 GB for four
    # chains of 100,000 coordinates. So each chain has a sampler of its own, let go as soon as it is done.
    found, running = [], []
    try:
        for chain in range(chains):
            running.append(started(chain))
            if len(running) == (cores or _usable_cores()):
                found.append(_finished(running[0], draws, n_kept))
                del running[0]
        while running:
            found.append(_finished(running[0], draws, n_kept))
            del running[0]
    except BaseException:
        for sampler in running:
            sampler.abort()
        raise
    positions, diverging = zip(*found, strict=True)
    return Chains(np.stack(positions), np.stack(diverging))


def _finished(sampler, draws: int, n_kept: int):  # type: ignore[no-untyped-def]
    """Position and divergence of each draw of a sampler's only chain, once it is done."""
    sampler.wait(None)
    (batch,), (stats,) = sampler.take_results().get_arrow_trace()
    position = _column(batch, "x")[-draws * n_kept :].reshape(draws, n_kept)
    return position.copy(), _column(stats, "diverging")[-draws:].copy()


def _column(batch, name):  # type: ignore[no-untyped-def]
    import pyarrow as pa

    column = pa.array(batch.column(name))
    if hasattr(column, "flatten"):
        column = column.flatten()
    return column.to_numpy(zero_copy_only=False)


def _usable_cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
