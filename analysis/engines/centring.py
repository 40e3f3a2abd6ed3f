"""How far each participant is centred: by how much the answers say of them, decided before sampling.

Someone of whom the answers say little is sampled best as a deviation from the group (``c = 0``), someone of
whom they say much as an ability of their own (``c = 1``). What matters is ``t = information * sd^2``, which
compares what a person's answers say with what the group says of them. The spread of people is guessed from
how far their answers pull away from the group; where all are alike, ``t`` is small, be there ever so many.

References
----------
Papaspiliopoulos, Roberts, Skoeld 2007, "A general framework for the parametrization of hierarchical models",
Statistical Science 22, section 3.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from analysis.engines.density import log_density, packed
from analysis.model import Problem

STEEPNESS = 4
"""``c = t^4 / (1 + t^4)``: half centred at t = 1. Steeper than the ``t / (1 + t)`` of a known sd, as a spread
that may be zero punishes centring more. Untuned beyond that."""
_MOST_MODES = 100
"""With more modes nobody is centred: hardly anybody answers often enough on thousands of pairs."""
_STEP = 1e-3

Floats = NDArray[np.float64]


def centring(problem: Problem) -> Floats:
    """``c`` of every participant of a hierarchical problem.

    Returns
    -------
    ndarray, shape (participant,)
        From 0 to 1; 0 for those whose answers do not connect the modes.
    """
    counts = problem.counts
    n_own = len(counts.modes) - 1
    found = np.zeros(len(counts.participants))
    pairs = np.bincount(counts.participant, minlength=len(found))
    known = pairs >= n_own
    if not known.any() or len(counts.modes) > _MOST_MODES:
        return found
    data, at = packed(problem), np.append(_group(problem), 0.0)

    def pull(own: Floats) -> Floats:
        """Slope of everybody's log-likelihood at deviations, shape (known participant, n_own)."""
        x = np.concatenate([at, np.tile(own, len(found))])
        slope = np.empty_like(x)
        log_density(x, slope, data)
        return slope[len(at) :].reshape(-1, n_own)[known] + own

    steps = _STEP * np.eye(n_own)
    information = np.stack([pull(-step) - pull(step) for step in steps], axis=1) / (2 * _STEP)
    information = (information + np.swapaxes(information, 1, 2)) / 2
    # If people differ with sd, their pulls have the covariance I + sd^2 I^2: moments give sd.
    apart = (pull(np.zeros(n_own)) ** 2).sum() - np.trace(information, axis1=1, axis2=2).sum()
    variance = max(apart / (information**2).sum(), 0.0)
    t = np.maximum(np.linalg.eigvalsh(information)[:, 0], 0.0) * variance
    found[known] = 1.0 - 1.0 / (1.0 + t**STEEPNESS)
    return found


def _group(problem: Problem) -> Floats:
    """The most probable position of the group if people were alike, in the order of the density."""
    alike = Problem(problem.counts.pooled(), replace(problem.model, hierarchical=False))
    data = packed(alike)

    def uphill(x: Floats) -> tuple[float, Floats]:
        slope = np.empty_like(x)
        return -log_density(x, slope, data), -slope

    return np.asarray(minimize(uphill, np.zeros(alike.n_dim), jac=True, method="L-BFGS-B").x)
