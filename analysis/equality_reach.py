"""Could a study of this size show that two modes are equal in practice? Said beside what it leaves open.

Equality needs a difference that is known within about a sixth of a logit: with few people, modes that are
exactly equal stay open in every study. The share of studies that would call two equal modes equal is
worked out at once, as `analysis.power.glance` does.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from analysis.equivalence import EQUIVALENT_BELOW
from analysis.figures.labels import LIKELY, percent_in_words
from analysis.observed_design import ObservedDesign, observed_design
from analysis.power.glance import FloatArray, answers_of_two, equal_chance, posterior_covariance
from analysis.results import Fit
from analysis.zero_sum import zero_sum_basis

WANTED = 0.8
"""Share of studies of equal modes that shall call them equal: the power that is usually planned for."""
HARDLY = 0.2
"""Below this share the report says that the study could not show equality. Untuned."""
_FARTHEST = 100_000
"""The most participants that are looked at."""
_HALVINGS = 40


@dataclass(frozen=True)
class EqualityReach:
    """How often a study would call two modes equal that are.

    Attributes
    ----------
    share : float
        Expected share of studies like this one, the mean over its pairs.
    people : float
        How many people with all answers this study is worth.
    enough : int or None
        The fewest people with ``WANTED``; None if hardly any number reaches it.
    """

    share: float
    people: float
    enough: int | None

    @property
    def is_too_small(self) -> bool:
        """Whether equality is out of this study's reach."""
        return self.share < HARDLY

    @property
    def about_open(self) -> str:
        """What “open” does not mean, in short; empty where equality is within reach."""
        if not self.is_too_small:
            return ""
        needed = "" if self.enough is None else f"; it takes about {_rounded(self.enough)} participants"
        return f"“Open” does not mean equal: so few answers cannot show that modes are equal{needed}."

    @property
    def sentence(self) -> str:
        """What that means for pairs which are left open; empty where equality is within reach."""
        if not self.is_too_small:
            return ""
        share = "no study" if self.share == 0.0 else f"{percent_in_words(self.share)} of studies"
        needed = (
            f"about {_rounded(self.enough)} participants"
            if self.enough is not None
            else "far more participants than can be had"
        )
        return (
            "So few answers cannot show that modes are equal: even of two that are exactly equal, "
            f"{share} of this size would call them equal in practice. For {100 * WANTED:.0f} % of studies to "
            f"do so it takes {needed}, if people differ as much as is estimated here. “elbowroom "
            "power --conclusion equal” plans for it."
        )


def reach_of(fit: Fit) -> EqualityReach | None:
    """What the study could show of equal modes; None where people are not known or taken as alike."""
    design = observed_design(fit)
    if design is None or not any(q.ranked and q.hierarchical for q in fit.questions):
        return None
    return equality_reach(design)


def equality_reach(design: ObservedDesign) -> EqualityReach:
    """What a study of this design could show of modes that are equal."""
    two = answers_of_two(design.pairs, design.scenario, design.repetitions)
    one = np.asarray(np.mean([a.information for a in two], axis=0))
    enough = None
    if _share(design, one, _FARTHEST) >= WANTED:
        low, high = 0, _FARTHEST
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if _share(design, one, middle) >= WANTED else (middle, high)
        enough = high
    return EqualityReach(_share(design, one, design.people), design.people, enough)


def _share(design: ObservedDesign, one: FloatArray, people: float) -> float:
    """Share of studies that call two equal modes equal, the mean over the pairs that were compared."""
    basis = zero_sum_basis(len(one))
    to = np.array([basis[i] - basis[j] for i, j in design.pairs])
    prior, posterior = (
        ((to @ posterior_covariance(one, n)[:-1, :-1]) * to).sum(axis=1) for n in (0.0, people)
    )
    # Over studies of equal modes the posterior mean varies by what the answers took off the prior's variance.
    spread = np.sqrt(np.maximum(posterior * (1.0 - posterior / prior), 1e-12))
    shares = 2.0 * ndtr(_farthest_mean(posterior) / spread) - 1.0
    return float(np.where(equal_chance(0.0, posterior) > LIKELY, shares, 0.0).mean())


def _farthest_mean(variance: FloatArray) -> FloatArray:
    """The largest posterior mean with which a pair is called equal, by bisection; 0 if there is none."""
    low, high = np.zeros_like(variance), np.full_like(variance, EQUIVALENT_BELOW)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        is_equal = equal_chance(middle, variance) > LIKELY
        low, high = np.where(is_equal, middle, low), np.where(is_equal, high, middle)
    return low


def _rounded(people: int) -> str:
    """Two digits: more would be said than is known."""
    digits = max(len(str(people)) - 2, 0)
    return f"{round(people, -digits):,}"
