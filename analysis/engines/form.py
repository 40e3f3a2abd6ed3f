"""In which form each participant is sampled, decided before sampling: where they stand and how far centred.

Two things tie participants to their spread, so that a sampler moves it slowly, and both are taken out here:

- Where answers pull a deviation to depends on the spread: it stands as what is left beside that (`density.py`
  says how), to first order in the answers.
- How wide a deviation is open depends on the spread too. Someone of whom the answers say little is sampled
  best as a deviation from the group (``c = 0``), someone of whom they say much as an ability of their own
  (``c = 1``). What matters is ``t = information * sd^2`` in each direction, which compares what a person's
  answers say with what the group says of them.

The spread is guessed from how far answers pull away from the group; where all are alike, ``t`` is small, be
there ever so many answers. Nothing here changes the model: another form is another set of coordinates.

References
----------
Papaspiliopoulos, Roberts, Skoeld 2007, "A general framework for the parametrization of hierarchical models",
Statistical Science 22, section 3.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from analysis.engines.density import log_density, packed
from analysis.engines.people import Form
from analysis.model import Problem

STEEPNESS = 4
"""``c = t^4 / (1 + t^4)`` in the direction least known: half centred at t = 1. Steeper than
``t / (1 + t)`` of a known sd, as a spread that may be zero punishes centring more. Untuned beyond that."""
SPREAD_KNOWN = 30.0
"""Information on the log of the spread at which it counts as half known: an error of a fifth. Untuned."""
_MOST_MODES = 100
"""With more modes the direction least known is not sought: hardly anybody answers on thousands of pairs."""
_PROBES = 8
"""Directions in which information is looked at, if there are as many. Untuned."""
_STEP = 1e-3
"""Step of a finite difference in a deviation [logit]."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class _Answers:
    """Everybody's log-likelihood near the group, all at once: ``at`` is the group's position."""

    problem: Problem
    data: NDArray[np.int64]
    at: Floats

    def pull(self, own: Floats) -> Floats:
        """Slope in everybody's deviations, at these deviations, both of shape (participant, K-1)."""
        x = np.zeros(self.problem.n_dim)
        end = len(self.at) + own.size
        x[: len(self.at)], x[len(self.at) : end] = self.at, own.ravel()
        slope = np.empty_like(x)
        log_density(x, slope, self.data)
        return slope[len(self.at) : end].reshape(own.shape) + own

    def information(self, towards: Floats) -> Floats:
        """Information times a direction of each participant, both of shape (participant, K-1)."""
        return (self.pull(-_STEP * towards) - self.pull(_STEP * towards)) / (2 * _STEP)


def form_of(problem: Problem) -> Form:
    """The form in which a hierarchical problem is sampled well."""
    shape = (len(problem.counts.participants), len(problem.counts.modes) - 1)
    # The spreads stand last, each at 1: nobody has a side or a width of their own in what follows.
    group = _group(problem)
    at = np.append(group, np.zeros(problem.n_global - len(group)))
    answers = _Answers(problem, packed(problem), at)
    pull = answers.pull(np.zeros(shape))
    length = np.linalg.norm(pull, axis=1, keepdims=True)
    ahead = np.divide(pull, length, out=np.zeros(shape), where=length > 0)
    along = np.maximum((ahead * answers.information(ahead)).sum(axis=1), 0.0)

    # Traces of the information and of its square, from all directions or from random ones (Hutchinson).
    seen = [(d, answers.information(np.tile(d, (shape[0], 1)))) for d in _directions(shape[1])]
    trace = np.sum([moved @ d for d, moved in seen], axis=0)
    squares = np.sum([(moved**2).sum(axis=1) for _, moved in seen], axis=0)
    # If people differ with sd, their pulls have the covariance I + sd^2 I^2: moments give sd. It is too small
    # where people answer seldom, as one answer does not tell a person from chance; c stays near 0 then.
    apart = max((pull**2).sum() - trace.sum(), 0.0)
    variance = apart / squares.sum() if apart else 0.0
    weak = _centring_of_little(variance * trace, variance**2 * squares, shape[1])
    return Form(np.maximum(weak, _centring_of_much(answers, variance)), pull, along)


def _directions(n: int) -> Floats:
    """The axes, or random directions as long together; shape (direction, n)."""
    if n <= _PROBES:
        return np.eye(n)
    signs = np.random.default_rng(0).choice([-1.0, 1.0], size=(_PROBES, n))
    return np.asarray(signs / np.sqrt(_PROBES))


def _centring_of_little(t: Floats, t_squared: Floats, n: int) -> Floats:
    """``c`` where answers say little of each of many people, from the sums of ``t`` and its square.

    With a known spread the least squares of all directions is ``a = sum t (1 + t) / sum (1 + t)^2``: for one
    direction, ``t / (1 + t)``. That holds while answers are nearly linear in a deviation; ``1 - a`` turns it
    down where they say much.
    """
    a = (t + t_squared) / (n + 2 * t + t_squared)
    known = 2 * (t_squared / (1 + t / n) ** 2).sum()
    return np.asarray(a * (1 - a) * known / (known + SPREAD_KNOWN))


def _centring_of_much(answers: _Answers, variance: float) -> Floats:
    """``c`` from the direction of which answers say least; 0 for those whose do not connect the modes."""
    counts = answers.problem.counts
    n_people, n = len(counts.participants), len(counts.modes) - 1
    c = np.zeros(n_people)
    connected = np.bincount(counts.participant, minlength=n_people) >= n
    if connected.any() and n < _MOST_MODES:
        axes = [np.tile(axis, (n_people, 1)) for axis in np.eye(n)]
        information = np.stack([answers.information(axis)[connected] for axis in axes], axis=1)
        information = (information + np.swapaxes(information, 1, 2)) / 2
        t = np.maximum(np.linalg.eigvalsh(information)[:, 0], 0.0) * variance
        c[connected] = 1.0 - 1.0 / (1.0 + t**STEEPNESS)
    return c


def _group(problem: Problem) -> Floats:
    """The most probable position of the group if people were alike, in the order of the density."""
    alike = Problem(problem.counts.pooled(), problem.model.alike)
    data = packed(alike)

    def uphill(x: Floats) -> tuple[float, Floats]:
        slope = np.empty_like(x)
        return -log_density(x, slope, data), -slope

    return np.asarray(minimize(uphill, np.zeros(alike.n_dim), jac=True, method="L-BFGS-B").x)
