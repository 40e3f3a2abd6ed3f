"""Ranking in milliseconds for the live console: the pooled posterior's mode and its Laplace approximation.

Rough by design: participants are pooled, so that intervals are narrower than those of a hierarchical fit.
"""

from dataclasses import dataclass

import numpy as np

from analysis.counts import Counts
from analysis.diagnostics import hdi
from analysis.identifiability import examine, sides_are_alike
from analysis.maximum import maximum_a_posteriori
from analysis.model import Model
from analysis.results import HDI_PROBABILITY
from analysis.softmax import worth_of
from analysis.summaries import rank_probabilities

DRAWS = 4000
"""Draws from the Laplace approximation for worths and P(best)."""


@dataclass(frozen=True)
class QuickResult:
    """One mode at a glance: 94 % interval of the worth, from the Laplace approximation."""

    mode: str
    worth: float
    worth_low: float
    worth_high: float
    p_best: float


@dataclass(frozen=True)
class QuickRanking:
    """A question at a glance; ``reason`` says why there are no ``modes``, if there are none."""

    modes: tuple[QuickResult, ...]
    reason: str


def quick_ranking(
    counts: Counts,
    modes: tuple[str, ...],
    *,
    side_effect: bool = True,
    prior_sd: float = 1.0,
    seed: int = 2017,
) -> QuickRanking:
    """Worth, interval and P(best) of every mode, in the order of ``modes``, in milliseconds."""
    found = examine(counts, modes, has_participants=False, side_effect=False)
    if found.refusal:
        return QuickRanking((), found.refusal)
    has_side = side_effect and not sides_are_alike(counts.responses.sum(axis=0))
    model = Model(counts.levels, "cumulative", False, has_side, prior_sd)
    estimate = maximum_a_posteriori(counts, model)
    rng = np.random.default_rng(seed)
    values, vectors = np.linalg.eigh(estimate.ability_covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    ability = estimate.ability + rng.standard_normal((DRAWS, len(modes))) @ root.T
    draws = worth_of(ability)
    low, high = hdi(draws, HDI_PROBABILITY)
    p_best = rank_probabilities(ability)[:, 0]
    worth = draws.mean(axis=0)
    place = [estimate.modes.index(mode) for mode in modes]
    return QuickRanking(
        tuple(
            QuickResult(mode, float(worth[k]), float(low[k]), float(high[k]), float(p_best[k]))
            for mode, k in zip(modes, place, strict=True)
        ),
        "",
    )
