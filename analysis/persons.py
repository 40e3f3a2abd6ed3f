"""Each participant's own preferences: what the hierarchical model knows of every person.

The samplers keep the group's parameters alone. Given those, people are independent of each other, so a
person's own deviations follow from that person's answers: at every draw one of the weighted points of
``marginal.py``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.answer_shares import ThinnedDraws, thinned
from analysis.counts import Counts, count_responses
from analysis.diagnostics import hdi
from analysis.marginal import deviations
from analysis.model import Model, model_behind
from analysis.results import HDI_PROBABILITY, Fit, QuestionFit
from analysis.softmax import worth_of
from analysis.zero_sum import zero_sum_basis
from data.responses import ResponseTable

FloatArray = NDArray[np.float64]

MOST_PEOPLE = 60
"""More people than these are drawn from low to high and not one by one."""
MOST_MODES = 50
"""With more modes than these too few points would count, and they would take long."""
_POINTS, _POINTS_OF_MANY = 32, 16
"""For each of up to `MOST_PEOPLE` people, and of more. Measured: 94 % intervals hold 93.0 and 91.6 %; 400
draws without an error would hold 93.2 %. 32 points cost half as much again."""
FEWEST_POINTS = 4.0
"""Effective points a draw below which a person's worths would rest on too few of them. Untuned."""
_FEWEST_DRAWS, _MOST_DRAWS, _MOST_IN_ALL = 100, 400, 120_000
"""Draws of the group's parameters: fewer for each of many people, as each takes a millisecond for thirty."""
_NEW_PEOPLE = 128


@dataclass(frozen=True)
class PersonWorth:
    """One mode in one participant's own order.

    Attributes
    ----------
    worth_mean, worth_hdi_low, worth_hdi_high : float
        Of the person's own worth, 94 % HDI.
    p_first : float
        Posterior probability that the mode is the person's own first.
    """

    participant: str
    mode: str
    worth_mean: float
    worth_hdi_low: float
    worth_hdi_high: float
    p_first: float


@dataclass(frozen=True)
class Agreement:
    """How many people's own first mode is the group's first, on one question.

    Attributes
    ----------
    first : str
        The mode that most often ranks first for the group.
    share_mean, share_hdi_low, share_hdi_high : float
        Share of these participants whose own first it is; 94 % HDI.
    new_person : float
        Probability that it is the own first of someone who has not taken part.
    people : tuple of PersonWorth
        Participant by participant, mode by mode.
    reason : str
        Why nothing is said of single participants, where nothing is; their shares are NaN then, and all else
        too if the model knows no differences between people.
    """

    question: str
    first: str
    share_mean: float
    share_hdi_low: float
    share_hdi_high: float
    new_person: float
    people: tuple[PersonWorth, ...]
    reason: str = ""


def agreements(table: ResponseTable, fit: Fit, seed: int = 2017) -> tuple[Agreement, ...]:
    """One agreement a question, in the order of the fit."""
    return tuple(_agreement(table, fit, question, seed) for question in fit.questions)


def points_of(people: int) -> int:
    """Among how many points each person's abilities are chosen at a draw."""
    return _POINTS if people <= MOST_PEOPLE else _POINTS_OF_MANY


def _agreement(table: ResponseTable, fit: Fit, question: QuestionFit, seed: int) -> Agreement:
    name, nan = question.question.name, float("nan")

    def nothing(reason: str, first: str = "", new_person: float = nan) -> Agreement:
        return Agreement(name, first, nan, nan, nan, new_person, (), reason)

    draws = question.draws
    if draws is None or not question.ranked:
        return nothing("The question is not ranked.")
    if "subject_sd" not in draws.parameters:
        why = (
            "Participants are pooled in this fit"
            if table.has_participants
            else "The answers name no participants"
        )
        return nothing(f"{why}, so nothing is known of single people's own order.")
    modes = question.mode_names
    first = max(range(len(modes)), key=lambda k: question.modes[k].p_best)
    counts = count_responses(table, question.question, in_order=fit.settings.position)
    number = max(_FEWEST_DRAWS, min(_MOST_DRAWS, _MOST_IN_ALL // len(counts.participants)))
    kept, rng = thinned(draws, number), np.random.default_rng(seed)
    new_person = _first_of_new_people(kept, first, rng)
    if len(modes) > MOST_MODES:
        reason = f"Each participant's own worths are worked out for at most {MOST_MODES} modes."
        return nothing(reason, modes[first], new_person)
    model = model_behind(draws.parameters, fit.settings, counts.levels, table.has_participants)
    own, effective = _own_abilities(kept, modes, counts, model, rng)
    if effective < FEWEST_POINTS:
        reason = "Each participant's own worths would rest on too few points to be told."
        return nothing(reason, modes[first], new_person)
    is_first = own.argmax(axis=-1) == first
    shares = is_first.mean(axis=0)
    low, high = hdi(shares, HDI_PROBABILITY)
    return Agreement(
        name,
        modes[first],
        float(shares.mean()),
        float(low),
        float(high),
        new_person,
        _person_worths(counts, modes, own),
    )


def _first_of_new_people(draws: ThinnedDraws, first: int, rng: np.random.Generator) -> float:
    """Share of people of whom nothing is known whose own first is a certain mode; each draw has its own
    people."""
    n_modes = draws.ability.shape[1]
    found = 0
    for ability, sd in zip(draws.ability, draws.parameters["subject_sd"], strict=True):
        z = rng.standard_normal((_NEW_PEOPLE, n_modes - 1)) @ zero_sum_basis(n_modes).T
        found += int(((ability + sd * z).argmax(axis=1) == first).sum())
    return found / (len(draws.ability) * _NEW_PEOPLE)


def _own_abilities(
    draws: ThinnedDraws, modes: tuple[str, ...], counts: Counts, model: Model, rng: np.random.Generator
) -> tuple[FloatArray, float]:
    """Draws of every participant's abilities, (person, draw, mode), and the median effective points a
    draw."""
    place = [modes.index(mode) for mode in counts.modes]
    in_order = ThinnedDraws(draws.ability[:, place], draws.parameters)
    sd, every = draws.parameters["subject_sd"][:, None], np.arange(len(draws.ability))
    own = np.empty((len(counts.participants), *draws.ability.shape))
    points = points_of(len(counts.participants))
    effective = []
    for s, person in enumerate(deviations(counts, model, in_order, points, rng)):
        weights = np.exp(person.log_weight - person.log_weight.max(axis=1, keepdims=True))
        weights /= weights.sum(axis=1, keepdims=True)
        effective.append(1.0 / (weights**2).sum(axis=1))
        chosen = (np.cumsum(weights, axis=1) < rng.random((len(every), 1))).sum(axis=1)
        own_point = person.at[every, chosen.clip(max=weights.shape[1] - 1), : len(modes) - 1]
        z = own_point @ zero_sum_basis(len(modes)).T
        own[s][:, place] = in_order.ability + sd * z
    return own, float(np.median(effective))


def _person_worths(counts: Counts, modes: tuple[str, ...], own: FloatArray) -> tuple[PersonWorth, ...]:
    worth = worth_of(own)
    mean, (low, high) = worth.mean(axis=1), hdi(np.swapaxes(worth, 0, 1), HDI_PROBABILITY)
    first = (own.argmax(axis=-1)[..., None] == np.arange(len(modes))).mean(axis=1)
    return tuple(
        PersonWorth(person, mode, float(mean[s, k]), float(low[s, k]), float(high[s, k]), float(first[s, k]))
        for s, person in enumerate(counts.participants)
        for k, mode in enumerate(modes)
    )
