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
from numpy.typing import NDArray
from scipy.special import expit

from analysis.model import SIDE_EFFECT_SD
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
        noise = np.diag(1.0 / _answer_information(lead, scenario))
        noise += scenario.subject_sd**2 * difference @ difference.T
        design = np.column_stack([difference, np.ones(len(sides))])
        found.append(design.T @ np.linalg.solve(noise, design))
    return np.mean(found, axis=0)


def _answer_information(lead: FloatArray, scenario: Scenario) -> FloatArray:
    """Fisher information of one answer on its lead, over people, shape (answers,)."""
    cuts = scenario.cuts
    edges = np.array([*(-c for c in reversed(cuts)), *(cuts or (0.0,))])
    own = lead[:, None] + np.sqrt(2.0) * scenario.subject_sd * _NODES
    below = expit(edges - own[..., None])
    ends = np.zeros((*own.shape, 1))
    chance = np.diff(np.concatenate([ends, below, ends + 1.0], axis=-1))
    slope = np.diff(np.concatenate([ends, below * (1.0 - below), ends], axis=-1))
    information = (slope**2 / np.maximum(chance, 1e-12)).sum(axis=-1)
    return np.maximum(information @ _WEIGHTS / _WEIGHTS.sum(), 1e-9)


def _share(plan: Plan, contrasts: FloatArray, one: FloatArray, participants: int) -> float:
    """Share of the posterior's possible means from which the conclusion is drawn."""
    n_free = len(plan.scenario.worth) - 1
    basis = zero_sum_basis(n_free + 1)
    prior = np.diag([1.0 / FitSettings.prior_sd**2] * n_free + [1.0 / SIDE_EFFECT_SD**2])
    known = participants * one
    covariance = np.linalg.inv(known + prior)
    truth = np.append(basis.T @ plan.scenario.ability, plan.scenario.side_effect)
    # The same random numbers for every size, so that the share grows smoothly.
    studies, draws = np.random.default_rng(1).standard_normal((2, _STUDIES, n_free + 1))
    spread = covariance @ np.linalg.cholesky(known)
    means = covariance @ known @ truth + studies @ spread.T
    to = contrasts @ basis
    lead = means[:, :n_free] @ to.T
    around = draws @ np.linalg.cholesky(covariance).T[:, :n_free] @ to.T
    holds = np.ones((_STUDIES, _STUDIES), dtype=bool)
    for ahead, error in zip(lead.T, around.T, strict=True):
        holds &= ahead[:, None] > -error
    return float((holds.mean(axis=1) > plan.conclusion.confidence).mean())
