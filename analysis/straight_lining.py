"""People who answer in a line: everything on one side, everything "much", everything equal, or too fast.

A line is pointed out where new people whom the fitted model describes would hardly ever give it by chance.
The chance that a person gives it on several questions is the product over the questions, as in the model,
which lets questions share nothing.

References
----------
Johnson 2005, "Ascertaining the validity of individual protocols from web-based personality inventories" (runs
of equal answers); Meade & Craig 2012, "Identifying careless responses in survey data"; Wood, Harms, Lowman,
DeSimone 2017, "Response speed and response consistency as mutually validating indicators of data quality in
online samples" (less than a second an item).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import nan
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from analysis.answer_rows import AnswerRows, answer_rows
from analysis.answer_shares import knows_scale, thinned
from analysis.engines.fast import question_seed
from analysis.fit import fit as fit_again
from analysis.identifiability import sides_are_alike
from analysis.lag import LagChange, lag_changes
from analysis.new_people import chances_for_person, parameters_of
from analysis.results import Fit, QuestionFit
from data.responses import PaceTable, ResponseTable

FloatArray = NDArray[np.float64]
Kind = Literal["all A", "all B", "all much", "all equal", "run", "fast"]

BY_CHANCE = 0.01
"""A line is pointed out if anybody of all participants would give it by chance in fewer studies than this."""
FASTEST_S = 1.0
"""Seconds a question below which nobody reads and answers (Wood et al. 2017)."""
SHORTEST_RUN = 6
"""Shorter runs of one answer to one question are not looked at. Untuned."""
_DRAWS = 1000
_ONE_SIDE: tuple[Kind, Kind] = ("all A", "all B")


@dataclass(frozen=True)
class Line:
    """What one participant did.

    Attributes
    ----------
    kind : str
        ``all A``, ``all B`` (as shown), ``all much`` (the strongest answer of the scale), ``all equal``: in
        all answers to questions that have such answers; ``run``: one answer to one question again and again;
        ``fast``: in the middle of the comparisons a question took less than ``FASTEST_S``.
    answers, of : int
        Answers in the line, and the participant's answers among which it stands; comparisons if ``fast``.
    chance : float
        Of such a line of a new person, by the fitted model; nan if ``fast``.
    seconds : float
        A question, median over the comparisons; nan unless ``fast``.
    question : str
        Of a run.
    """

    participant: str
    kind: Kind
    answers: int
    of: int
    chance: float = nan
    seconds: float = nan
    question: str = ""


@dataclass(frozen=True)
class StraightLining:
    """Who answers in a line, and what the ranking is without them.

    Attributes
    ----------
    changes : tuple of LagChange
        Worth and chance to rank first with everybody and without them; empty if nobody would be left.
    """

    lines: tuple[Line, ...] = ()
    changes: tuple[LagChange, ...] = ()

    @property
    def participants(self) -> tuple[str, ...]:
        """Who answers in a line, each once."""
        return tuple(dict.fromkeys(line.participant for line in self.lines))


def straight_lining(
    table: ResponseTable,
    fit: Fit,
    pace: PaceTable | None = None,
    before_refit: Callable[[], None] | None = None,
) -> StraightLining:
    """Look for people who answer in a line; if there are any, fit the others again.

    Parameters
    ----------
    pace : PaceTable or None
        How long the answers took, where it is known.
    before_refit : callable, optional
        Called if there is something to be fitted again.
    """
    if not table.has_participants:
        return StraightLining()
    lines = (*_lines(table, fit), *_fast(pace))
    found = StraightLining(lines)
    rest = table.rows[~table.rows["participant"].isin(list(found.participants))]
    if not lines or rest[~rest["check"].astype(bool)].empty:
        return found
    if before_refit is not None:
        before_refit()
    others = fit_again(replace(table, rows=rest.reset_index(drop=True)), fit.settings)
    return replace(found, changes=lag_changes(fit, others))


def _fast(pace: PaceTable | None) -> Iterator[Line]:
    if pace is None or pace.rows.empty:
        return
    each = pace.rows["seconds"] / pace.rows["questions"]
    for who, own in each.groupby(pace.rows["participant"], sort=False):
        if own.median() < FASTEST_S:
            yield Line(str(who), "fast", int((own < FASTEST_S).sum()), len(own), seconds=float(own.median()))


@dataclass(frozen=True)
class _Question:
    """One question's answers, with the chance of every answer: a function of the person's rows."""

    name: str
    rows: AnswerRows
    has_sides: bool
    chances: Callable[[NDArray[np.int64]], FloatArray]

    @cached_property
    def _numbers(self) -> Mapping[str, int]:
        return {name: k for k, name in enumerate(self.rows.people)}

    def places_of(self, who: str) -> NDArray[np.int64]:
        """Where a person's answers stand, which are sorted by person."""
        person = self._numbers.get(who)
        if person is None:
            return np.empty(0, dtype=np.int64)
        return np.arange(*np.searchsorted(self.rows.person, [person, person + 1]))

    def levels_of(self, kind: Kind) -> tuple[int, ...]:
        """Places on the scale that belong to a line of this kind; none if the scale has no such answer."""
        levels = self.rows.levels
        half = levels // 2
        match kind:
            case "all A":
                return tuple(range(half)) if self.has_sides else ()
            case "all B":
                return tuple(range(levels - half, levels)) if self.has_sides else ()
            case "all much":
                return (0, levels - 1) if levels > 3 else ()
            case _:
                return (half,) if levels % 2 else ()


def _lines(table: ResponseTable, fit: Fit) -> Iterator[Line]:
    asked = [
        _question(table, fit, question)
        for question in fit.questions
        if question.ranked and question.draws is not None
    ]
    people = list(dict.fromkeys(name for q in asked for name in q.rows.people))
    for who in people:
        own = [(q, q.places_of(who)) for q in asked]
        own = [(q, places) for q, places in own if len(places)]
        whole = [line for kind in (*_ONE_SIDE, "all much", "all equal") for line in _whole(who, kind, own)]
        for line in whole or _runs(who, own):
            if line.chance * len(people) <= BY_CHANCE:
                yield line


def _question(table: ResponseTable, fit: Fit, question: QuestionFit) -> _Question:
    assert question.draws is not None
    rows = answer_rows(table, question.question, question.mode_names, in_order=fit.settings.position)
    if not knows_scale(question.draws.parameters, rows.levels):
        rows = rows.collapsed()
    draws = thinned(question.draws, _DRAWS)
    name = question.question.name
    at = [
        parameters_of(draws.ability, draws.parameters, question.mode_names, k)
        for k in range(len(draws.ability))
    ]
    seed = question_seed(fit.settings.seed, f"in a line {name}")

    def chances(places: NDArray[np.int64]) -> FloatArray:
        return chances_for_person(rows, places, at, np.random.default_rng(seed))

    counts = np.bincount(rows.level, minlength=rows.levels)
    return _Question(name, rows, not sides_are_alike(counts), chances)


_Own = Sequence[tuple[_Question, NDArray[np.int64]]]


def _whole(who: str, kind: Kind, own: _Own) -> Iterator[Line]:
    """The line, if all of a person's answers that can be in it are."""
    able = [(q, places, q.levels_of(kind)) for q, places in own if q.levels_of(kind)]
    n = sum(len(places) for _, places, _ in able)
    if not n or not all(np.isin(q.rows.level[places], levels).all() for q, places, levels in able):
        return
    if kind in _ONE_SIDE and all(_is_one_order(q.rows, places) for q, places, _ in able):
        return
    chance = 1.0
    for q, places, levels in able:
        in_line = q.chances(places)[..., list(levels)].sum(axis=-1)
        chance *= float(in_line.prod(axis=1).mean())
    yield Line(who, kind, n, n, chance)


def _runs(who: str, own: _Own) -> Iterator[Line]:
    """The longest run of one answer to one question; its chance at most, wherever in the row it begins."""
    for q, places in own:
        if not q.rows.has_order or len(places) < SHORTEST_RUN:
            continue
        level = q.rows.level[places]
        edges = np.flatnonzero(np.concatenate([[True], level[1:] != level[:-1], [True]]))
        lengths = np.diff(edges)
        start, length = int(edges[lengths.argmax()]), int(lengths.max())
        run = places[start : start + length]
        is_tie = q.rows.levels % 2 == 1 and level[start] == q.rows.levels // 2
        if length < SHORTEST_RUN or (not is_tie and (not q.has_sides or _is_one_order(q.rows, run))):
            continue
        logs = np.cumsum(np.log(q.chances(places)), axis=1)
        logs = np.concatenate([np.zeros_like(logs[:, :1]), logs], axis=1)
        windows = np.exp(logs[:, length:] - logs[:, :-length]).mean(axis=0)
        chance = min(1.0, float(windows.sum()) * len(own))
        yield Line(who, "run", length, len(places), chance, question=q.name)


def _is_one_order(rows: AnswerRows, places: NDArray[np.int64]) -> bool:
    """Whether one order of the modes explains all of these answers: then a side may be a preference."""
    half = rows.levels // 2
    level, a, b = rows.level[places], rows.mode_a[places], rows.mode_b[places]
    is_for_a, is_for_b = level < half, level >= rows.levels - half
    winner, loser = np.where(is_for_a, a, b), np.where(is_for_a, b, a)
    decided = is_for_a | is_for_b
    n = int(max(a.max(), b.max())) + 1
    graph = csr_array((np.ones(decided.sum()), (winner[decided], loser[decided])), shape=(n, n))
    return bool(connected_components(graph, directed=True, connection="strong")[0] == n)
