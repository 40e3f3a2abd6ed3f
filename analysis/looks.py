"""What looking at the results early does to the error rate, where a study stops as soon as it looks good.

Whoever looks often finds a clear first place by chance more often, even if nobody prefers any mode. How often
is simulated in milliseconds: a person's answers are one linear observation with the information that
`analysis.power.glance` takes, and the posterior is normal. How near this comes to whole studies that are
fitted is measured in analysis/README.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, ndtri

from analysis.figures.labels import percent_in_words
from analysis.model import SIDE_EFFECT_SD
from analysis.observed_design import ObservedDesign
from analysis.power.glance import answers_of_two
from analysis.results import FitSettings
from analysis.zero_sum import zero_sum_basis
from data.records import Look

LOOKS_GOOD = 0.95
"""Chance to rank first from which on a study is taken to stop. Untuned: what people use."""
MOST_LOOKS = 120
"""More looks than these are thinned, the first and the last kept: some ten milliseconds in all."""
_STUDIES = 2000
_MOST_NAMED = 6
_MOST_VALUES = 2_000_000
"""Studies times looks times modes; fewer studies where there would be more."""
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(25)

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class LookErrors:
    """Share of studies without any preference that name a first place.

    Attributes
    ----------
    once : float
        At the last look alone.
    stopping : float
        At any look.
    """

    once: float
    stopping: float


@lru_cache(maxsize=64)
def look_errors(
    design: ObservedDesign, people: tuple[float, ...], chance: float = LOOKS_GOOD, seed: int = 1
) -> LookErrors:
    """How often a first place is named with at least this chance although nobody prefers any mode.

    Parameters
    ----------
    people : tuple of float
        Participants at each look, the last one included; a part of a person's answers counts as that part.
    """
    sizes = _thinned(sorted({float(n) for n in people if n > 0}))
    if not sizes:
        return LookErrors(0.0, 0.0)
    one, scatter = _of_one_person(design)
    n_free = len(one) - 1
    studies = min(_STUDIES, max(200, _MOST_VALUES // (len(sizes) * (n_free + 1))))
    prior = np.diag([1.0 / FitSettings.prior_sd**2] * n_free + [1.0 / SIDE_EFFECT_SD**2])
    root, basis = np.linalg.cholesky(scatter), zero_sum_basis(n_free + 1)
    rng = np.random.default_rng(seed)
    score = np.zeros((studies, n_free + 1))
    stopped = is_named = np.zeros(studies, dtype=bool)
    before = 0.0
    for n in sizes:
        score = score + np.sqrt(n - before) * rng.standard_normal(score.shape) @ root.T
        covariance = np.linalg.inv(n * one + prior)
        truth = n * one[:, -1] * design.scenario.side_effect
        ability = (score + truth) @ covariance[:, :n_free] @ basis.T
        spread = basis @ covariance[:n_free, :n_free] @ basis.T
        is_named = _is_named(ability, spread, chance)
        stopped = stopped | is_named
        before = n
    return LookErrors(float(is_named.mean()), float(stopped.mean()))


def earlier(looks: Sequence[Look], shown: Look) -> tuple[Look, ...]:
    """The looks at other answers than these, which is every one that could have stopped the study."""
    return tuple(look for look in looks if look.answers != shown.answers)


def looks_sentence(before: Sequence[Look], shown: Look, design: ObservedDesign | None, when: str) -> str:
    """How often results were looked at, and what that does to the error rate.

    Parameters
    ----------
    before : sequence of Look
        One or more.
    when : str
        Such as ``before this report``.
    """
    numbers = [f"{look.participants:,}" for look in before if look.participants]
    if len(numbers) > _MOST_NAMED:
        people = f"{', '.join(numbers[: _MOST_NAMED - 1])} and so on up to {numbers[-1]}"
    else:
        people = f"{', '.join(numbers[:-1])} and {numbers[-1]}" if len(numbers) > 1 else "".join(numbers)
    with_people = f" (with {people} participant{'' if people == '1' else 's'})" if people else ""
    times = {1: "once", 2: "twice"}.get(len(before), f"{len(before):,} times")
    said = f"The results were looked at {times} {when}{with_people}."
    if design is None or not shown.answers:
        return said
    sizes = tuple(design.people * look.answers / shown.answers for look in (*before, shown))
    errors = look_errors(design, sizes)
    return (
        f"{said} If a study stops as soon as its results look good, the chance that a question names a first "
        f"place with {100 * LOOKS_GOOD:.0f} % or more although nobody prefers any mode rises, with so many "
        f"looks, from about {percent_in_words(errors.once)} to about {percent_in_words(errors.stopping)}."
    )


def _of_one_person(design: ObservedDesign) -> tuple[FloatArray, FloatArray]:
    """The information that the estimate takes a person's answers to have, and the covariance of its score."""
    two = answers_of_two(design.pairs, design.scenario, design.repetitions)
    if not design.is_pooled:
        one = np.mean([a.information for a in two], axis=0)
        return one, one
    one = np.mean([a.pooled_information for a in two], axis=0)
    return one, np.mean([a.pooled_scatter for a in two], axis=0)


def _is_named(ability: FloatArray, covariance: FloatArray, chance: float) -> NDArray[np.bool_]:
    """Whether the leading mode of each study is first with at least this chance.

    A constant for all modes changes no order; so abilities are taken as independent, which they are but for a
    constant where every pair was compared as often as any other.
    """
    n_modes = len(covariance)
    shared = (covariance.sum() - np.trace(covariance)) / (n_modes * (n_modes - 1))
    sd = np.sqrt(np.diag(covariance) - shared)
    leader = ability.argmax(axis=1)
    rows = np.arange(len(ability))
    lead = ability[rows, leader][:, None] - ability
    # The leader is first at most as surely as it is above any single other mode.
    margin = lead / np.hypot(sd[leader][:, None], sd)
    margin[rows, leader] = np.inf
    able = margin.min(axis=1) >= ndtri(chance)
    named = np.zeros(len(ability), dtype=bool)
    if able.any():
        lead, leader = lead[able], leader[able]
        at = (lead[:, :, None] + sd[leader][:, None, None] * _NODES) / sd[None, :, None]
        log_below = log_ndtr(at)
        log_below[np.arange(len(lead)), leader] = 0.0
        named[able] = np.exp(log_below.sum(axis=1)) @ _WEIGHTS / _WEIGHTS.sum() >= chance
    return named


def _thinned(sizes: list[float]) -> list[float]:
    if len(sizes) <= MOST_LOOKS:
        return sizes
    return [sizes[k] for k in np.unique(np.linspace(0, len(sizes) - 1, MOST_LOOKS).round().astype(int))]
