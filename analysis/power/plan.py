"""All that a power analysis is asked: which study, which people, which sizes, what counts, how precisely."""

from dataclasses import dataclass

import numpy as np

from analysis.power.scenario import BEST, Conclusion, Scenario
from data.answers import SCALES
from data.errors import InputError, one_of
from data.study import Study

MOST_ANSWERS = 20_000
"""Answers to one question that one simulated study may have."""
MOST_REPLICATES = 100_000


@dataclass(frozen=True)
class Plan:
    """A power analysis before it is made.

    Attributes
    ----------
    study : Study
        Its modes, pairs, sides and attention checks are used as they are.
    participants, repetitions : tuple of int
        Sizes to try, each with each: people, and how often a person sees each pair.
    wanted : float
        Share of studies that shall come to the right conclusion.
    replicates : int
        Simulated studies of each size.
    """

    study: Study
    scenario: Scenario
    participants: tuple[int, ...]
    repetitions: tuple[int, ...]
    conclusion: Conclusion = BEST
    wanted: float = 0.8
    replicates: int = 100
    seed: int = 2017

    def study_with(self, repetitions: int) -> Study:
        """The study with each pair shown so many times."""
        protocol = self.study.protocol.model_copy(update={"repetitions": repetitions})
        return self.study.model_copy(update={"protocol": protocol})

    def answers_each(self, repetitions: int) -> int:
        """Answers that a participant gives to a question."""
        return len(self.study.pairs) * repetitions

    @property
    def sizes(self) -> tuple[tuple[int, int], ...]:
        """What is tried, as (repetitions, participants), in order and each once."""
        return tuple((r, n) for r in sorted(set(self.repetitions)) for n in sorted(set(self.participants)))


def mode_pairs(study: Study) -> tuple[tuple[int, int], ...]:
    """The pairs of modes that are compared, by their places."""
    place = {name: k for k, name in enumerate(study.mode_names)}
    return tuple((place[a], place[b]) for a, b in study.pairs)


def check_plan(plan: Plan) -> None:
    """Refuse what makes no study, before any work.

    Raises
    ------
    InputError
        One line: which value, and what is valid.
    """
    _check_people(plan.study, plan.scenario)
    _check_conclusion(plan.study, plan.scenario, plan.conclusion)
    if not 0.0 < plan.wanted < 1.0:
        raise InputError(f"wanted: {plan.wanted:g} is no share above 0 and below 1, such as 0.8")
    if not 1 <= plan.replicates <= MOST_REPLICATES:
        raise InputError(f"replicates: {plan.replicates} is not between 1 and {MOST_REPLICATES}")
    for what, numbers in (("participants", plan.participants), ("repetitions", plan.repetitions)):
        if not numbers or min(numbers) < 1:
            raise InputError(f"{what}: one or more whole numbers from 1 are needed, such as 7, 20, 45")
    people, times = max(plan.participants), max(plan.repetitions)
    if people * plan.answers_each(times) > MOST_ANSWERS:
        raise InputError(
            f"participants, repetitions: {people} people with {plan.answers_each(times)} answers each are "
            f"more than {MOST_ANSWERS} answers"
        )


def _check_people(study: Study, scenario: Scenario) -> None:
    modes, worth = study.mode_names, scenario.worth
    if len(worth) != len(modes):
        count = "1 number" if len(worth) == 1 else f"{len(worth)} numbers"
        raise InputError(f"worth: {count} for {len(modes)} modes; one for each is needed, in their order")
    if not all(np.isfinite(w) and w > 0 for w in worth):
        raise InputError("worth: every worth must be a positive number")
    if max(worth) / min(worth) > 1e6:
        raise InputError("worth: the largest must be at most a million times the smallest")
    if scenario.levels not in SCALES:
        raise one_of("levels", scenario.levels, tuple(str(n) for n in SCALES))
    needed, cuts = (scenario.levels - 1) // 2, scenario.cuts
    if len(cuts) != needed or list(cuts) != sorted(set(cuts)) or not all(0 < c < np.inf for c in cuts):
        raise InputError(
            f"cuts: {scenario.levels} levels need {needed} increasing positive numbers, not "
            f"{', '.join(f'{c:g}' for c in cuts) or 'none'}"
        )
    if not 0.0 <= scenario.subject_sd <= 10.0:
        raise InputError(f"subject_sd: {scenario.subject_sd:g} is not between 0 and 10")
    if not -10.0 <= scenario.side_effect <= 10.0:
        raise InputError(f"side_effect: {scenario.side_effect:g} is not between -10 and 10")


def _check_conclusion(study: Study, scenario: Scenario, conclusion: Conclusion) -> None:
    if not 0.5 <= conclusion.confidence < 1.0:
        raise InputError(f"confidence: {conclusion.confidence:g} is not between 0.5 and 1, such as 0.95")
    if conclusion.kind == "order" and len(set(scenario.worth)) < len(scenario.worth):
        raise InputError("worth: two modes share a worth, so there is no order to be found")
    if conclusion.kind == "pair":
        i, j = conclusion.pair
        if i == j or not all(0 <= k < len(study.modes) for k in (i, j)):
            raise InputError("conclusion: a pair is two different modes of the study")
