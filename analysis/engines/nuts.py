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
from numba import carray, cfunc, types
from numpy.typing import NDArray

from analysis.engines.density import log_density
from data.errors import ElbowroomError

_DATA_SIZE = 1
"""The block handed to the core starts with the length of the packed data."""
_OK, _NOT_FINITE = 0, 4
"""Return codes of nutpie: 4 is an error the sampler recovers from, as a divergence."""


@cfunc(
    types.int64(
        types.uint64,
        types.CPointer(types.double),
        types.CPointer(types.double),
        types.CPointer(types.double),
        types.voidptr,
    ),
    cache=True,
    error_model="numpy",
)
def _density(n_dim, position, gradient, logp, block):  # type: ignore[no-untyped-def]  # pragma: no cover
    size = carray(block, (1,), dtype=np.int64)[0]
    data = carray(block, (_DATA_SIZE + size,), dtype=np.int64)[_DATA_SIZE:]
    x = carray(position, (n_dim,))
    slope = carray(gradient, (n_dim,))
    value = log_density(x, slope, data)
    carray(logp, (1,))[0] = value
    if not np.isfinite(value) or not np.all(np.isfinite(slope)):
        return _NOT_FINITE
    return _OK


@cfunc(
    types.int64(
        types.uint64, types.uint64, types.CPointer(types.double), types.CPointer(types.double), types.voidptr
    ),
    cache=True,
    error_model="numpy",
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
        return sys.modules["nutpie._lib"]
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
    return module


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
    settings = core.PyNutsSettings.Diag(seed)
    settings.num_draws, settings.num_tune, settings.num_chains = draws, tune, chains
    settings.target_accept = target_accept
    sizes = {"kept": n_kept}
    variables = core.PyVariable.new_variables(["x"], ["float64"], [(n_kept,)], sizes, {"x": ("kept",)})
    address = block.ctypes.data
    model = core.PyMcModel(
        core.LogpFunc(_density.address, address, block),
        core.ExpandFunc(n_dim, n_kept, _kept.address, address, block),
        variables,
        n_dim,
        sizes,
        {},
        lambda chain_seed: np.random.default_rng(chain_seed).uniform(-1.0, 1.0, n_dim),
        None,
    )
    sampler = core.PySampler.from_pymc(
        settings,
        min(chains, cores or _usable_cores()),
        model,
        core.ProgressType.none(),
        core.PyStorage.arrow(),
    )
    try:
        sampler.wait(None)
    except BaseException:
        sampler.abort()
        raise
    batches, stats = sampler.take_results().get_arrow_trace()
    return Chains(
        np.stack([_column(batch, "x")[-draws * n_kept :].reshape(draws, n_kept) for batch in batches]),
        np.stack([_column(batch, "diverging")[-draws:] for batch in stats]),
    )


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
