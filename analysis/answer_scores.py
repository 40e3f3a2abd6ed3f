"""What a set of answers says for and against one drawn set of the model's parameters: scores.

A score is the slope of the log-likelihood. The slopes along the model's own parameters are what a fit sets to
zero; the slopes along what the model leaves out (a share of careless answers, a side effect of each person's
own, ...) are large where leaving it out is wrong, and no other statistic sees a small fault better. People's
own deviations are averaged over by a fixed set of points, weighted by the person's answers.

References
----------
Rao 1948, "Large sample tests of statistical hypotheses concerning several parameters" (score tests); Neyman
1959, "Optimal asymptotic tests of composite statistical hypotheses" (scores cleared of those of the nuisance
parameters).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.answer_rows import AnswerRows
from analysis.new_people import PERSON_SPREADS, Answers, Parameters, People, chances_of, people_of
from analysis.zero_sum import zero_sum_basis

FloatArray = NDArray[np.float64]

_SHAPE_OF_SCALE = ("cut_", "log_nu")
_STEP = 1e-4
_MOST_SURPRISE = 100.0
"""One over the chance of an answer counts as at most this, so that no single answer decides a check."""
_MOST_AT_ONCE = 4_000_000
_FEWEST_IN_CAMPS = 5
_MOST_COORDINATES = 30
"""With more modes the directions in which people differ are not looked for: there are too many."""


@dataclass(frozen=True)
class Scores:
    """Scores of several sets of answers; every array has the shape (set, ...).

    Attributes
    ----------
    nuisance : ndarray, shape (set, parameter)
        Slopes along the model's own parameters.
    n_ability : int
        The first so many of them belong to the modes' abilities, one each.
    checks : mapping of str to ndarray, shape (set,)
        Slopes along what the model leaves out, by the kind of check.
    """

    nuisance: FloatArray
    n_ability: int
    checks: Mapping[str, FloatArray]


def scores(rows: AnswerRows, answers: Answers, at: Parameters, n_points: int) -> Scores:
    """Scores of every set of answers, shape (set, answer), at one draw of the parameters."""
    tables = _tables(rows, at, n_points)
    n_sets, n_people = len(answers), len(rows.people)
    sums = {name: np.empty((n_sets, n_people)) for name in tables.of_people}
    slope, width = np.zeros((n_sets, rows.n)), np.zeros((n_sets, rows.n))
    weights = np.empty((n_sets, n_people, tables.n_points))
    for block in _blocks(rows, tables, n_sets):
        one_hot = (answers[:, block][..., None] == np.arange(rows.levels)).astype(float)
        one_hot = one_hot.transpose(1, 0, 2, 3)
        flat = one_hot.reshape(len(block), n_sets, -1)
        cells = tables.cell[block]
        total = {name: flat @ _flat(table[cells]) for name, table in tables.by_answer.items()}
        log_weight = total["log"]
        weight = np.exp(log_weight - log_weight.max(axis=-1, keepdims=True))
        weight /= weight.sum(axis=-1, keepdims=True)
        who = rows.person[block[:, 0]]
        weights[:, who] = weight.transpose(1, 0, 2)
        for name, of in tables.of_people.items():
            sums[name][:, who] = (weight * of(total)).sum(axis=-1).T
        for name, row_level in (("slope", slope), ("width", width)):
            if name in tables.by_answer:
                mean = weight @ _flat(tables.by_answer[name][cells]).transpose(0, 2, 1)
                by_answer = (mean * flat).reshape(one_hot.shape).sum(axis=-1)
                row_level[:, block.reshape(-1)] = by_answer.transpose(1, 0, 2).reshape(n_sets, -1)
    by_kind = {name: values.sum(axis=1) for name, values in sums.items()}
    return Scores(
        _nuisance(rows, at, slope, by_kind),
        len(at.ability),
        _left_out(rows, answers, tables, weights, slope, width, by_kind, at),
    )


@dataclass(frozen=True)
class _Tables:
    """Values by (cell, level, point): a cell is an ordered pair of modes, a point a person's deviations."""

    cell: Answers
    by_answer: Mapping[str, FloatArray]
    of_people: "Mapping[str, _OfPerson]"
    points: FloatArray

    @property
    def n_points(self) -> int:
        return int(self.by_answer["log"].shape[-1])


class _OfPerson:
    """A person's quantity at every point, from sums over the person's answers: (person, set, point)."""

    def __init__(self, name: str, squared: str = "", by_point: FloatArray | None = None) -> None:
        self.name, self.squared, self.by_point = name, squared, by_point

    def __call__(self, total: Mapping[str, FloatArray]) -> FloatArray:
        if self.by_point is not None:
            return np.broadcast_to(self.by_point, total["log"].shape)
        values = total[self.name]
        return values**2 - total[self.squared] if self.squared else values


def _tables(rows: AnswerRows, at: Parameters, n_points: int) -> _Tables:
    n_modes = len(at.ability)
    columns = [rows.mode_a, rows.mode_b] if rows.order is None else [rows.mode_a, rows.mode_b, *rows.order.T]
    keys, cell = np.unique(np.column_stack(columns), axis=0, return_inverse=True)
    a, b = keys[:, 0].astype(np.int64), keys[:, 1].astype(np.int64)
    points = _points(at, n_points)
    apart = (points.ability[:, a] - points.ability[:, b]).T
    eta = at.lead(a, b, None if rows.order is None else keys[:, 2:])[:, None] + apart + points.side

    def log_chances(
        shift: float = 0.0, width: float = 0.0, values: Mapping[str, float] = at.values
    ) -> FloatArray:
        chances = chances_of(eta + shift, values, rows.levels, points.width + width)
        return np.log(chances).transpose(0, 2, 1)

    log = log_chances()
    slope = (log_chances(_STEP) - log_chances(-_STEP)) / (2 * _STEP)
    by_answer = {
        "log": log,
        "slope": slope,
        "slope_squared": slope**2,
        "lapse_left_out": np.minimum(np.exp(-log) / rows.levels, _MOST_SURPRISE / rows.levels) - 1.0,
    }
    of_people = {
        "lapse_left_out": _OfPerson("lapse_left_out"),
        "side_by_person": _OfPerson("slope", "slope_squared"),
    }
    shape = [name for name in at.values if name.startswith(_SHAPE_OF_SCALE)]
    for name in [*shape, *(name for name in at.values if name == "lapse")]:
        step = _STEP * _room(name, at.values)
        above, below = dict(at.values), dict(at.values)
        above[name] += step
        below[name] -= step
        by_answer[name] = (log_chances(values=above) - log_chances(values=below)) / (2 * step)
        of_people[name] = _OfPerson(name)
    if shape:
        by_answer["width"] = (log_chances(width=_STEP) - log_chances(width=-_STEP)) / (2 * _STEP)
        by_answer["width_squared"] = by_answer["width"] ** 2
        of_people["width_by_person"] = _OfPerson("width", "width_squared")
    for name, by_point in (("side_sd", points.side), ("scale_sd", points.width)):
        if at.values.get(name):
            table = by_answer["slope" if name == "side_sd" else "width"]
            by_answer[name] = table * by_point / at.values[name]
            of_people[name] = _OfPerson(name)
    if at.values.get("subject_sd"):
        by_answer["subject_sd"] = slope * apart[:, None, :] / at.values["subject_sd"]
        of_people["subject_sd"] = _OfPerson("subject_sd")
        of_people["spread_of_points"] = _OfPerson("", by_point=(points.ability**2).sum(axis=1))
    own = points.ability @ zero_sum_basis(n_modes)
    return _Tables(cell.ravel().astype(np.int64), by_answer, of_people, own)


def _points(at: Parameters, n_points: int) -> People:
    """Points of people's deviations, each with its opposite; one point, at zero, if people do not differ."""
    if not any(at.values.get(name) for name in PERSON_SPREADS):
        return people_of(at, (1,), np.zeros)
    rng = np.random.default_rng(1948)

    def with_opposites(shape: tuple[int, ...]) -> FloatArray:
        half = rng.standard_normal((shape[0] // 2, *shape[1:]))
        return np.concatenate([half, -half])

    return people_of(at, (n_points,), with_opposites)


def _room(name: str, values: Mapping[str, float]) -> float:
    """By how much a cut-point, or a share, can move before it meets its limits; 1 for anything else."""
    if name == "lapse":
        return min(values[name], 1.0 - values[name])
    if not name.startswith("cut_"):
        return 1.0
    k = int(name.removeprefix("cut_"))
    above = values.get(f"cut_{k + 1}", np.inf)
    return float(min(1.0, values[name] - values.get(f"cut_{k - 1}", 0.0), above - values[name]))


def _flat(table: FloatArray) -> FloatArray:
    """(person, answer, level, point) as (person, answer and level, point)."""
    return table.reshape(len(table), -1, table.shape[-1])


def _blocks(rows: AnswerRows, tables: _Tables, n_sets: int) -> Iterator[Answers]:
    """Places of the answers of people with equally many, (person, answer), few enough to hold at once."""
    counts = np.bincount(rows.person, minlength=len(rows.people))
    starts = np.concatenate([[0], np.cumsum(counts)])
    for n in np.unique(counts[counts > 0]):
        people = np.flatnonzero(counts == n)
        each = n * rows.levels * max(n_sets, tables.n_points) + n_sets * tables.n_points
        at_once = max(1, int(_MOST_AT_ONCE // each))
        for k in range(0, len(people), at_once):
            yield starts[people[k : k + at_once], None] + np.arange(n)


def _nuisance(
    rows: AnswerRows, at: Parameters, slope: FloatArray, by_kind: Mapping[str, FloatArray]
) -> FloatArray:
    ability = np.stack(
        [slope @ ((rows.mode_a == m).astype(float) - (rows.mode_b == m)) for m in range(len(at.ability))],
        axis=1,
    )
    columns = [ability]
    if rows.order is not None:
        place, before_a, before_b = rows.order.T
        gains = [
            before_a * (rows.mode_a == m) - before_b * (rows.mode_b == m) for m in range(len(at.ability))
        ]
        columns.append(slope @ np.column_stack([place, *gains]))
    for name in at.values:
        values = slope.sum(axis=1) if name == "side_effect" else by_kind.get(name)
        if values is not None:
            columns.append(values[:, None])
    if "spread_of_points" in by_kind:
        columns.append(by_kind["spread_of_points"][:, None])
    return np.concatenate(columns, axis=1)


def _left_out(
    rows: AnswerRows,
    answers: Answers,
    tables: _Tables,
    weights: FloatArray,
    slope: FloatArray,
    width: FloatArray,
    by_kind: Mapping[str, FloatArray],
    at: Parameters,
) -> dict[str, FloatArray]:
    checks = {} if "lapse" in at.values else {"lapse": by_kind["lapse_left_out"]}
    if "side_effect" not in at.values:
        checks["side"] = slope.sum(axis=1)
    if not rows.has_people:
        return checks
    if len(rows.people) > 1:
        for kind, spread in (("width_by_person", "scale_sd"), ("side_by_person", "side_sd")):
            if kind in by_kind and spread not in at.values:
                checks[kind] = by_kind[kind]
    if "subject_sd" in by_kind and len(rows.people) >= _FEWEST_IN_CAMPS:
        checks |= _shape_of_people(weights @ tables.points)
    if rows.has_order:
        if (rows.before >= 0).any():
            checks["repeats"] = _copied(rows, answers, tables, weights)
        counts = np.bincount(rows.person, minlength=len(rows.people))
        if counts.max() > 1:
            starts = np.concatenate([[0], np.cumsum(counts)])[:-1]
            time = np.arange(rows.n) - starts[rows.person] - (counts[rows.person] - 1) / 2
            if "side_drift" not in at.values:
                checks["side_drift"] = slope @ time
            if "width" in tables.by_answer:
                checks["width_drift"] = width @ time
    return checks


def _shape_of_people(own: FloatArray) -> dict[str, FloatArray]:
    """Whether people's deviations, (set, person, coordinate), spread as those of normal people do.

    ``one_line``: how much of their spread lies along one direction. ``camps``: Sarle's coefficient of
    bimodality along that direction, large for two camps whether equally large (few in the middle) or not
    (skewed).
    """
    n_own = own.shape[-1]
    if n_own > _MOST_COORDINATES:
        return {}
    own = own - own.mean(axis=1, keepdims=True)
    spread, axes = np.linalg.eigh(own.transpose(0, 2, 1) @ own)
    along = (own @ axes[..., -1:])[..., 0]
    second, third, fourth = ((along**k).mean(axis=1) for k in (2, 3, 4))
    found = {"camps": (third**2 + second**3) / np.maximum(fourth * second, 1e-300)}
    if n_own > 1:
        found["one_line"] = spread[:, -1] / np.maximum(spread.sum(axis=1), 1e-300)
    return found


def _copied(rows: AnswerRows, answers: Answers, tables: _Tables, weights: FloatArray) -> FloatArray:
    """Slope along the share of repeated answers that are copies of the answer before."""
    again = np.flatnonzero(rows.before >= 0)
    found = np.zeros(len(answers))
    at_once = max(1, _MOST_AT_ONCE // (len(answers) * tables.n_points))
    for k in range(0, len(again), at_once):
        now = again[k : k + at_once]
        last = rows.before[now]
        is_turned = rows.turned[now] != rows.turned[last]
        copy = np.where(is_turned, rows.levels - 1 - answers[:, last], answers[:, last])
        chance = np.exp(tables.by_answer["log"][tables.cell[now], answers[:, now]])
        surprise = np.minimum(1.0 / chance, _MOST_SURPRISE)
        mean = (weights[:, rows.person[now]] * surprise).sum(axis=-1)
        found += ((answers[:, now] == copy) * mean - 1.0).sum(axis=1)
    return found
