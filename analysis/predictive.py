"""Predictive checks: would the fitted model have given answers like these?

One posterior draw of the model's parameters stands for the model. New people with the same schedule answer
by it some hundred times. If the model is right, the draw and the true parameters have the same distribution
given the answers, so that the observed set of answers is exchangeable with the new ones: whatever is
compared, its rank among them is uniform, and the chance of a false alarm is the one that is stated, also for
the largest of many comparisons. A fit sets the model's own scores to zero, so every quantity is first cleared
of what it shares with those scores by a regression over all sets alike, which keeps the exchangeability and
makes small faults visible; otherwise the fit would hide them.

References
----------
Gelman, Meng, Stern 1996, "Posterior predictive assessment of model fitness via realized discrepancies";
Bayarri & Castellanos 2007, "Bayesian checking of the second levels of hierarchical models" (new people, so
that a misfit between people can show); Robins, van der Vaart, Ventura 2000, "Asymptotic distribution of p
values in composite null models" (the usual posterior predictive p-values flag too rarely, and why clearing a
quantity of the scores cures that); Johnson 2007, "Bayesian model assessment using pivotal quantities" (one
draw of the parameters); Westfall & Young 1993, "Resampling-based multiple testing" (the largest of many).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from analysis.answer_quantities import OVER, Share, answer_quantities
from analysis.answer_rows import AnswerRows, answer_rows
from analysis.answer_scores import Scores, scores
from analysis.answer_shares import knows_scale
from analysis.engines.fast import question_seed
from analysis.exchangeable import chances, residuals, sizes
from analysis.identifiability import sides_are_alike
from analysis.new_people import Parameters, parameters_of, replicated
from analysis.results import Draws, Fit, QuestionFit
from data.responses import ResponseTable

Kind = Literal[
    "wins",
    "ties",
    "level",
    "spread",
    "lapse",
    "width_by_person",
    "side_by_person",
    "one_line",
    "camps",
    "repeats",
    "side",
    "side_drift",
    "width_drift",
]
FloatArray = NDArray[np.float64]

SHARES: tuple[Kind, ...] = get_args(Share)
"""Kinds in units of their own, from 0 up."""
UNLIKELY = 0.06
"""A check whose p is at most this is pointed out: the observed value lies outside the central 94 %."""
SURELY_UNLIKELY = 0.06
"""The same for p corrected for the number of checks of the report; such checks become cautions."""
ONE_SIDED: tuple[Kind, ...] = (
    "lapse",
    "width_by_person",
    "side_by_person",
    "one_line",
    "camps",
    "repeats",
)
"""Kinds whose large values alone speak against the model: what they look for cannot be below nothing."""
_FOLLOWING_FROM_ONE_SIDE: tuple[Kind, ...] = ("side", "side_by_person", "side_drift", "one_line", "camps")
MOST_ANSWERS = 10_000
"""With more answers the checks look at people drawn at random, with about so many answers."""
_SETS_OF_FEW, _SETS_OF_MANY = 400, 200
_POINTS = ((300, 64), (2_000, 32), (MOST_ANSWERS, 16))
"""Up to so many answers, so many points of a person's deviations."""
_NOTHING_LEFT = 0.02
"""A quantity that the model's own scores determine but for this share of its spread is no check. Untuned."""
_MOST_SCORES = 40


@dataclass(frozen=True)
class PredictiveCheck:
    """One quantity of the answers, as observed and as the model predicts it.

    Attributes
    ----------
    kind : str
        ``wins``: share of a pair's answers for mode i; ``ties``, ``level``: share of one answer on the
        scale (A and B as they were shown); ``spread``: root mean square, over people and pairs, of each
        person's net answer to a pair around that of all. The others are scores, centred and in units of
        their spread over all sets: ``lapse`` (careless answers), ``width_by_person`` (how much of the scale
        each person uses), ``side_by_person``, ``one_line`` (people differ in one direction more than in
        others), ``camps`` (in two groups along that direction), ``repeats`` (an answer copies the one before
        to the same pair), ``side`` (for models without a side effect), ``side_drift`` and ``width_drift``
        (with the place among a person's answers).
    what : str
        Which pair or which answer; empty for all else.
    observed : float
    predicted_mean, predicted_low, predicted_high : float
        Mean and central 94 % of the predictions, given what the model's own parameters are fitted to; of a
        one-sided kind from the smallest prediction to the 94 % quantile.
    p : float
        Chance of a value as far out if the model is right; both sides count but for one-sided kinds.
    p_all : float
        Chance that the most extreme of all checks of the report is as far out as this one.
    is_high : bool
        True if the observed value is above the middle of the predictions.
    """

    question: str
    kind: Kind
    what: str
    observed: float
    predicted_mean: float
    predicted_low: float
    predicted_high: float
    p: float
    p_all: float
    is_high: bool

    @property
    def is_unlikely(self) -> bool:
        """True if the model hardly ever gives a value as far out."""
        return self.p <= UNLIKELY

    @property
    def is_surely_unlikely(self) -> bool:
        """True if it hardly ever gives a value as far out in any of the checks."""
        return self.p_all <= SURELY_UNLIKELY

    @property
    def z(self) -> float:
        """``p`` as the place on a standard normal; beyond 1.88 the check is pointed out."""
        return float(-ndtri(self.p / 2)) * (1.0 if self.is_high else -1.0)


@dataclass(frozen=True)
class PredictiveChecks:
    """All checks of a report.

    Attributes
    ----------
    checks : tuple of PredictiveCheck
    expected : float
        How many would be pointed out on average if the model were right.
    at_most : int
        In 95 of 100 studies for which the model is right no more than so many are.
    answers, answers_in_all : int
        That the checks look at, and that there are.
    """

    checks: tuple[PredictiveCheck, ...] = ()
    expected: float = 0.0
    at_most: int = 0
    answers: int = 0
    answers_in_all: int = 0


def predictive_checks(table: ResponseTable, fit: Fit) -> PredictiveChecks:
    """All checks of every ranked question, in the order of the fit."""
    compared = [
        _compared(table, fit, question, question.draws)
        for question in fit.questions
        if question.ranked and question.draws is not None
    ]
    compared = [one for one in compared if one.columns]
    if not compared:
        return PredictiveChecks()
    n_sets = min(len(one.p) for one in compared)
    flagged = np.sum([(one.p <= UNLIKELY).sum(axis=1)[:n_sets] for one in compared], axis=0)
    largest = np.max([one.size.max(axis=1)[:n_sets] for one in compared], axis=0)
    return PredictiveChecks(
        tuple(check for one in compared for check in one.checks(largest)),
        float(sum((one.p <= UNLIKELY).sum(axis=1).mean() for one in compared)),
        int(np.quantile(flagged, 0.95, method="higher")),
        sum(one.n for one in compared),
        sum(one.n_in_all for one in compared),
    )


@dataclass(frozen=True)
class _Compared:
    """Quantities of the observed answers (set 0) and of the new ones, cleared: each (set, check)."""

    question: str
    columns: tuple[tuple[Kind, str], ...]
    values: FloatArray
    residual: FloatArray
    p: FloatArray
    size: FloatArray
    n: int
    n_in_all: int

    def checks(self, largest: FloatArray) -> list[PredictiveCheck]:
        """The checks; ``largest`` is the size of the most extreme of all checks, shape (set,)."""
        found = []
        for k, (kind, what) in enumerate(self.columns):
            seen, rest = float(self.values[0, k]), self.residual[:, k]
            middle = seen - float(rest[0])
            tails = (0.0, 1 - UNLIKELY) if kind in ONE_SIDED else (UNLIKELY / 2, 1 - UNLIKELY / 2)
            low, high = middle + np.quantile(rest[1:], tails)
            mean = middle + float(rest[1:].mean())
            if kind in SHARES:
                low, mean, high = np.clip((low, mean, high), 0.0, 1.0 if kind != "spread" else np.inf)
            found.append(
                PredictiveCheck(
                    self.question,
                    kind,
                    what,
                    seen,
                    float(mean),
                    float(low),
                    float(high),
                    float(self.p[0, k]),
                    float((largest >= self.size[0, k]).mean()),
                    bool(rest[0] > np.median(rest)),
                )
            )
        return found


def _compared(table: ResponseTable, fit: Fit, question: QuestionFit, draws: Draws) -> _Compared:
    modes = question.mode_names
    rows = answer_rows(table, question.question, modes, in_order=fit.settings.position)
    if not knows_scale(draws.parameters, rows.levels):
        rows = rows.collapsed()
    name = question.question.name
    rng = np.random.default_rng(question_seed(fit.settings.seed, f"predictive {name}"))
    n_in_all = rows.n
    rows = _some(rows, rng)
    at = _one_of(draws, modes, rng)
    n_sets = _SETS_OF_FEW if rows.n <= _POINTS[1][0] else _SETS_OF_MANY
    n_points = next((points for most, points in _POINTS if rows.n <= most), _POINTS[-1][1])
    answers = np.concatenate([rows.level[None], replicated(rows, at, n_sets, rng)])
    found = scores(rows, answers, at, n_points)
    quantities: dict[tuple[Kind, str], FloatArray] = {}
    for (share, what), shares in answer_quantities(rows, answers, modes).items():
        quantities[share, what] = shares
    # Where all answers are for one side the fit leaves the side effect out and says so: these would follow.
    is_one_sided = sides_are_alike(np.bincount(rows.level, minlength=rows.levels))
    for kind in get_args(Kind):
        if kind in found.checks and not (is_one_sided and kind in _FOLLOWING_FROM_ONE_SIDE):
            score = found.checks[kind] - found.checks[kind].mean()
            quantities[kind, ""] = score / (float(score.std()) or 1.0)
    columns = tuple(quantities)
    values = np.stack([quantities[column] for column in columns], axis=1)
    residual = _cleared(values, columns, found, at, modes)
    is_left = residual.std(axis=0) > _NOTHING_LEFT * values.std(axis=0) + 1e-9
    columns = tuple(column for column, kept in zip(columns, is_left, strict=True) if kept)
    values, residual = values[:, is_left], residual[:, is_left]
    one_sided = np.array([kind in ONE_SIDED for kind, _ in columns], dtype=bool)
    return _Compared(
        name,
        columns,
        values,
        residual,
        chances(residual, one_sided),
        sizes(residual, one_sided, UNLIKELY),
        rows.n,
        n_in_all,
    )


def _some(rows: AnswerRows, rng: np.random.Generator) -> AnswerRows:
    """People drawn at random with about as many answers as are looked at; all if they have no more."""
    if rows.n <= MOST_ANSWERS:
        return rows
    if len(rows.people) == 1:
        return rows.at(np.sort(rng.choice(rows.n, MOST_ANSWERS, replace=False)))
    order = rng.permutation(len(rows.people))
    counts = np.bincount(rows.person, minlength=len(rows.people))[order]
    chosen = np.zeros(len(rows.people), dtype=bool)
    chosen[order[: 1 + int(np.searchsorted(np.cumsum(counts), MOST_ANSWERS))]] = True
    return rows.of_people(chosen)


def _one_of(draws: Draws, modes: tuple[str, ...], rng: np.random.Generator) -> Parameters:
    ability = draws.ability.reshape(-1, draws.ability.shape[-1])
    parameters = {name: values.reshape(-1) for name, values in draws.parameters.items()}
    return parameters_of(ability, parameters, modes, int(rng.integers(len(ability))))


def _cleared(
    values: FloatArray,
    columns: tuple[tuple[Kind, str], ...],
    found: Scores,
    at: Parameters,
    modes: tuple[str, ...],
) -> FloatArray:
    """What the model's own scores leave of every quantity, by a regression over all sets alike.

    With many modes the abilities' scores are too many for the sets: then those of the two modes of a pair are
    taken for its wins, and else the one along which the abilities as a whole grow.
    """
    scores_ = found.nuisance
    if found.n_ability <= _MOST_SCORES:
        return residuals(values, scores_)
    abilities, rest = scores_[:, : found.n_ability], scores_[:, found.n_ability :]
    common = np.column_stack([abilities @ at.ability, rest])
    residual = residuals(values, common)
    place = {mode: k for k, mode in enumerate(modes)}
    for k, (kind, what) in enumerate(columns):
        if kind == "wins":
            i, j = (place[mode] for mode in _pair(what, place))
            residual[:, k] = residuals(values[:, [k]], np.column_stack([common, abilities[:, [i, j]]]))[:, 0]
    return residual


def _pair(what: str, place: Mapping[str, int]) -> tuple[str, str]:
    parts = what.split(OVER)
    splits = ((OVER.join(parts[:k]), OVER.join(parts[k:])) for k in range(1, len(parts)))
    return next((i, j) for i, j in splits if i in place and j in place)
