"""Answers of new people with the schedule of the old ones, at one draw of a fitted model's parameters."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.answer_rows import AnswerRows
from analysis.answer_shares import answer_probabilities
from analysis.model import LEARNING
from analysis.zero_sum import zero_sum_basis

FloatArray = NDArray[np.float64]
Answers = NDArray[np.int64]

PERSON_SPREADS = ("subject_sd", "side_sd", "scale_sd")
"""Parameters that say how much people differ: in their abilities, side effects and widths of the scale."""
_LEAST_CHANCE = 1e-12
_MOST_AT_ONCE = 4_000_000


@dataclass(frozen=True)
class Parameters:
    """One draw.

    Attributes
    ----------
    ability : ndarray, shape (mode,)
    learning : ndarray, shape (mode,)
        What a mode gains by use; 0 where the model has no such part.
    values : mapping of str to float
        The other parameters by name.
    """

    ability: FloatArray
    learning: FloatArray
    values: Mapping[str, float]

    def lead(self, mode_a: Answers, mode_b: Answers, order: FloatArray | None) -> FloatArray:
        """Lead of A over B of someone like the group [logit]; ``order`` is as in ``AnswerRows.order``."""
        lead = self.ability[mode_a] - self.ability[mode_b] + self.values.get("side_effect", 0.0)
        if order is not None:
            place, before_a, before_b = order.T
            lead = lead + self.values.get("side_drift", 0.0) * place
            lead = lead + self.learning[mode_a] * before_a - self.learning[mode_b] * before_b
        return np.asarray(lead)


def parameters_of(
    ability: FloatArray, parameters: Mapping[str, FloatArray], modes: Sequence[str], k: int
) -> Parameters:
    """Draw ``k`` of ``ability`` (draw, mode) and of the other parameters, each of shape (draw,)."""
    values = {name: float(draws[k]) for name, draws in parameters.items()}
    learning = np.array([values.pop(LEARNING + mode, 0.0) for mode in modes])
    return Parameters(ability[k], learning, values)


def replicated(rows: AnswerRows, at: Parameters, number: int, rng: np.random.Generator) -> Answers:
    """So many sets of answers of new people with the same schedule: (set, answer), places on the scale."""
    sets = max(1, _MOST_AT_ONCE // max(1, rows.n * rows.levels, len(rows.people) * len(at.ability)))
    return np.concatenate(
        [_drawn(rows, at, min(sets, number - done), rng) for done in range(0, number, sets)]
    )


def _drawn(rows: AnswerRows, at: Parameters, number: int, rng: np.random.Generator) -> Answers:
    people = people_of(at, (number, len(rows.people)), rng.standard_normal)
    eta = at.lead(rows.mode_a, rows.mode_b, rows.order) + people.side[:, rows.person]
    eta = eta + people.ability[:, rows.person, rows.mode_a] - people.ability[:, rows.person, rows.mode_b]
    chances = chances_of(eta, at.values, rows.levels, people.width[:, rows.person])
    edges = np.cumsum(chances[..., :-1], axis=-1)
    return np.asarray((rng.random((*eta.shape, 1)) > edges).sum(axis=-1), dtype=np.int64)


@dataclass(frozen=True)
class People:
    """Deviations of some people from the group: ``ability`` (..., mode), and each of shape (...)
    ``side`` and ``width``, the log of what a person's cut-points are multiplied by."""

    ability: FloatArray
    side: FloatArray
    width: FloatArray


def people_of(
    at: Parameters, shape: tuple[int, ...], normal: Callable[[tuple[int, ...]], FloatArray]
) -> People:
    """People as the model has them, from standard normal numbers; zero where it knows no difference."""
    n_modes = len(at.ability)
    spread = [at.values.get(name, 0.0) for name in PERSON_SPREADS]
    none = np.zeros(shape)
    ability = np.zeros((*shape, n_modes))
    if spread[0]:
        ability = spread[0] * normal((*shape, n_modes - 1)) @ zero_sum_basis(n_modes).T
    side, width = (s * normal(shape) if s else none for s in spread[1:])
    return People(ability, side, width)


def chances_of(
    eta: FloatArray, values: Mapping[str, float], levels: int, width: FloatArray | float = 0.0
) -> FloatArray:
    """Chance of each answer, (..., level); ``width`` broadcasts against ``eta``."""
    ones = np.ones((1,) * eta.ndim)
    parameters = {name: value * ones for name, value in values.items()}
    chances = np.maximum(answer_probabilities(eta, parameters, levels, width), _LEAST_CHANCE)
    return np.asarray(chances / chances.sum(axis=-1, keepdims=True))


def chances_for_person(
    rows: AnswerRows, places: Answers, at: Sequence[Parameters], rng: np.random.Generator
) -> FloatArray:
    """Chance of every answer of a new person to what stands at some places: (draw, answer, level)."""
    a, b = rows.mode_a[places], rows.mode_b[places]
    order = None if rows.order is None else rows.order[places]
    found = np.empty((len(at), len(places), rows.levels))
    for k, draw in enumerate(at):
        person = people_of(draw, (1,), rng.standard_normal)
        eta = draw.lead(a, b, order) + person.side + person.ability[0, a] - person.ability[0, b]
        found[k] = chances_of(eta, draw.values, rows.levels, person.width)
    return found
