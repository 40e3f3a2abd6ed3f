"""The share of right conclusions in milliseconds: what the information in the answers lets one expect.

An estimate for sentences and first guesses; `analysis.power.experiment` simulates and fits. A person's
answers are taken as one linear observation: each has the Fisher information of its cumulative logit, and the
person's own deviations are noise that all of their answers share. The posterior is then normal, and so is the
distribution of its mean over studies. How near this comes to fits is measured in analysis/README.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit, ndtr

from analysis.equivalence import EQUIVALENT_BELOW
from analysis.model import SIDE_EFFECT_SD, thresholds
from analysis.power.plan import Plan, mode_pairs
from analysis.power.scenario import Conclusion, Scenario
from analysis.results import FitSettings
from analysis.zero_sum import zero_sum_basis

_STUDIES = 1000
"""Possible studies, and draws from the posterior of each."""
_FARTHEST = 2000
"""The most participants that are looked at."""
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(15)
FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Glance:
    """The expected share of right conclusions by the number of participants, with so many repetitions."""

    plan: Plan
    repetitions: int

    def share(self, participants: int) -> float:
        """Expected share of studies of this size that come to the right conclusion."""
        if self.plan.conclusion.is_equality:
            return _equal_share(self.plan, self._information, participants)
        contrasts = planted_contrasts(self.plan.scenario, self.plan.conclusion)
        if contrasts is None:
            return 0.0
        return _share(self.plan, contrasts, self._information, participants)

    @property
    def enough(self) -> int | None:
        """The fewest participants with the wanted share; None if there are hardly so many."""
        low, high = 0, 1
        while self.share(high) < self.plan.wanted:
            low, high = high, 2 * high
            if high > _FARTHEST:
                return None
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if self.share(middle) >= self.plan.wanted else (middle, high)
        return high

    @property
    def _information(self) -> FloatArray:
        return person_information(mode_pairs(self.plan.study), self.plan.scenario, self.repetitions)


def glance(plan: Plan, repetitions: int | None = None) -> Glance:
    """A plan at a glance; with the study's own repetitions if none are given."""
    return Glance(plan, repetitions or plan.study.protocol.repetitions)


def planted_contrasts(scenario: Scenario, conclusion: Conclusion) -> FloatArray | None:
    """Differences of abilities, shape (differences, modes), that are all above 0 if the conclusion is right.

    None if nothing that could be concluded would be right.
    """
    if not conclusion.can_be_right(scenario):
        return None
    ability = scenario.ability
    order = [int(k) for k in np.argsort(-ability)]
    match conclusion.kind:
        case "best":
            ahead = [(order[0], k) for k in order[1:]]
        case "order":
            ahead = list(pairwise(order))
        case "pair":
            i, j = conclusion.pair
            ahead = [(i, j) if ability[i] > ability[j] else (j, i)]
    unit = np.eye(len(ability))
    return np.array([unit[i] - unit[j] for i, j in ahead])


def person_information(pairs: Sequence[tuple[int, int]], scenario: Scenario, repetitions: int) -> FloatArray:
    """Information in one person's answers on the free ability coordinates and the side effect.

    Returns
    -------
    ndarray, shape (modes, modes)
        The mean over two people, who see the sides of the pairs exchanged.
    """
    return np.mean([a.information for a in answers_of_two(pairs, scenario, repetitions)], axis=0)


@dataclass(frozen=True)
class PersonAnswers:
    """One person's answers as a linear observation of the free ability coordinates and the side effect.

    Attributes
    ----------
    design : ndarray, shape (answers, modes)
        What each answer observes.
    each : ndarray, shape (answers,)
        Variance of each answer about what the person feels.
    own : ndarray, shape (answers, answers)
        Covariance of what the person feels about what the group does.
    """

    design: FloatArray
    each: FloatArray
    own: FloatArray

    @property
    def information(self) -> FloatArray:
        """What the answers tell if the person's own deviations are known to be shared by them."""
        return np.asarray(self.design.T @ np.linalg.solve(np.diag(self.each) + self.own, self.design))

    @property
    def pooled_information(self) -> FloatArray:
        """What they would tell if they came from as many people as there are answers."""
        return np.asarray(self.design.T @ (self.design / self.each[:, None]))

    @property
    def pooled_scatter(self) -> FloatArray:
        """Covariance of the weighted answers that a pooled estimate adds up, as they really are."""
        weighted = self.design / self.each[:, None]
        return np.asarray(weighted.T @ (np.diag(self.each) + self.own) @ weighted)


def answers_of_two(
    pairs: Sequence[tuple[int, int]], scenario: Scenario, repetitions: int
) -> tuple[PersonAnswers, ...]:
    """Answers of two people who see the sides of the pairs exchanged."""
    basis = zero_sum_basis(len(scenario.worth))
    found = []
    for member in (0, 1):
        sides = [
            pair if (member + place + r) % 2 == 0 else pair[::-1]
            for place, pair in enumerate(pairs)
            for r in range(repetitions)
        ]
        difference = np.array([basis[a] - basis[b] for a, b in sides])
        lead = difference @ (basis.T @ scenario.ability) + scenario.side_effect
        design = np.column_stack([difference, np.ones(len(sides))])
        own = scenario.subject_sd**2 * difference @ difference.T
        found.append(PersonAnswers(design, 1.0 / _answer_information(lead, scenario), own))
    return tuple(found)


def _answer_information(lead: FloatArray, scenario: Scenario) -> FloatArray:
    """Fisher information of one answer on its lead, over people, shape (answers,)."""
    edges = thresholds(np.array(scenario.cuts), scenario.levels)
    own = lead[:, None] + np.sqrt(2.0) * scenario.subject_sd * _NODES
    below = expit(edges - own[..., None])
    ends = np.zeros((*own.shape, 1))
    chance = np.diff(np.concatenate([ends, below, ends + 1.0], axis=-1))
    slope = np.diff(np.concatenate([ends, below * (1.0 - below), ends], axis=-1))
    information = (slope**2 / np.maximum(chance, 1e-12)).sum(axis=-1)
    return np.maximum(information @ _WEIGHTS / _WEIGHTS.sum(), 1e-9)


def _equal_share(plan: Plan, one: FloatArray, participants: int) -> float:
    """Share of the posterior's possible means from which each pair is called equal in practice."""
    conclusion, scenario = plan.conclusion, plan.scenario
    if not conclusion.can_be_right(scenario):
        return 0.0
    n_modes = len(scenario.worth)
    basis = zero_sum_basis(n_modes)
    means, covariance = _posterior(plan, one, participants, _STUDIES * 4)
    called = np.ones(len(means), dtype=bool)
    for i, j in conclusion.equal_pairs(n_modes):
        to = basis[i] - basis[j]
        called &= equal_chance(means[:, :-1] @ to, to @ covariance[:-1, :-1] @ to) > conclusion.confidence
    return float(called.mean())


def equal_chance(mean: ArrayLike, variance: ArrayLike) -> FloatArray:
    """Probability that a normal difference of abilities lies within practical equality."""
    mean, sd = np.asarray(mean, dtype=np.float64), np.sqrt(variance)
    return np.asarray(ndtr((EQUIVALENT_BELOW - mean) / sd) - ndtr((-EQUIVALENT_BELOW - mean) / sd))


def posterior_covariance(one: FloatArray, people: float) -> FloatArray:
    """Posterior covariance of the free ability coordinates and the side effect.

    Parameters
    ----------
    one : ndarray, shape (modes, modes)
        A person's information on them.
    people : float
    """
    prior = np.diag([1.0 / FitSettings.prior_sd**2] * (len(one) - 1) + [1.0 / SIDE_EFFECT_SD**2])
    return np.asarray(np.linalg.inv(people * one + prior))


def _posterior(plan: Plan, one: FloatArray, participants: int, studies: int) -> tuple[FloatArray, FloatArray]:
    """Posterior means of so many possible studies, and the covariance of each."""
    known, covariance = participants * one, posterior_covariance(one, participants)
    truth = np.append(zero_sum_basis(len(one)).T @ plan.scenario.ability, plan.scenario.side_effect)
    # The same random numbers for every size, so that the share grows smoothly.
    noise = np.random.default_rng(1).standard_normal((studies, len(one)))
    return covariance @ known @ truth + noise @ (covariance @ np.linalg.cholesky(known)).T, covariance


def _share(plan: Plan, contrasts: FloatArray, one: FloatArray, participants: int) -> float:
    """Share of the posterior's possible means from which the conclusion is drawn."""
    n_free = len(plan.scenario.worth) - 1
    basis = zero_sum_basis(n_free + 1)
    means, covariance = _posterior(plan, one, participants, _STUDIES)
    draws = np.random.default_rng(1).standard_normal((2, _STUDIES, n_free + 1))[1]
    to = contrasts @ basis
    lead = means[:, :n_free] @ to.T
    around = draws @ np.linalg.cholesky(covariance).T[:, :n_free] @ to.T
    holds = np.ones((_STUDIES, _STUDIES), dtype=bool)
    for ahead, error in zip(lead.T, around.T, strict=True):
        holds &= ahead[:, None] > -error
    return float((holds.mean(axis=1) > plan.conclusion.confidence).mean())
