"""Posterior predictive checks: would the fitted model have given answers like these?

New people with the same schedule are drawn from the model, once a draw; what their answers show is set beside
what the answers showed.

References
----------
Gelman, Meng, Stern 1996, "Posterior predictive assessment of model fitness via realized discrepancies";
Bayarri & Castellanos 2007, "Bayesian checking of the second levels of hierarchical models" (new people,
rather than the same ones, so that a misfit between people can show).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from analysis.answer_shares import answer_probabilities, knows_scale, thinned
from analysis.counts import Counts, count_responses
from analysis.engines.fast import question_seed
from analysis.results import Fit, QuestionFit
from analysis.zero_sum import zero_sum_basis
from data.responses import ResponseTable

Kind = Literal["wins", "ties", "level", "spread"]
FloatArray = NDArray[np.float64]

UNLIKELY = 0.05
"""A Bayesian p-value below this, or above 1 less it, is pointed out. A convention."""
_MOST_ANSWERS = 1_500_000
_DRAWS = 400
_LEVEL_NAMES = {
    2: ("A", "B"),
    3: ("A", "about the same", "B"),
    5: ("much A", "A", "about the same", "B", "much B"),
}


@dataclass(frozen=True)
class PredictiveCheck:
    """One quantity of the answers, as observed and as the model predicts it.

    Attributes
    ----------
    kind : {"wins", "ties", "level", "spread"}
        Share of a pair's answers for mode i; share of ties; share of one answer on the scale (A and B as they
        were shown); root mean square, over people and pairs, of each person's net answer to a pair around
        that of all.
    what : str
        Which pair or which answer; empty for ties and spread.
    observed : float
    predicted_mean, predicted_low, predicted_high : float
        Mean and central 94 % of the predictions.
    p : float
        Bayesian p-value: share of predictions above the observed value, half of those equal to it counted.
    """

    question: str
    kind: Kind
    what: str
    observed: float
    predicted_mean: float
    predicted_low: float
    predicted_high: float
    p: float

    @property
    def is_unlikely(self) -> bool:
        """True if the model hardly ever gives a value as far out."""
        return not UNLIKELY <= self.p <= 1 - UNLIKELY


def predictive_checks(table: ResponseTable, fit: Fit) -> tuple[PredictiveCheck, ...]:
    """All checks of every ranked question, in the order of the fit."""
    return tuple(
        check
        for question in fit.questions
        if question.ranked and question.draws is not None
        for check in _checks(table, fit, question)
    )


def _checks(table: ResponseTable, fit: Fit, question: QuestionFit) -> list[PredictiveCheck]:
    assert question.draws is not None
    counts = count_responses(table, question.question)
    if not knows_scale(question.draws.parameters, counts.levels):
        counts = counts.collapsed()
    number = int(min(_DRAWS, max(50, _MOST_ANSWERS // max(counts.n, 1))))
    kept = thinned(question.draws, number)
    modes = question.mode_names
    ability = kept.ability[:, [modes.index(mode) for mode in counts.modes]]
    seed = question_seed(fit.settings.seed, f"predictive {question.question.name}")
    predicted = _replicates(counts, ability, kept.parameters, np.random.default_rng(seed))
    observed = _quantities(counts, counts.responses[None], modes)
    found = []
    for (kind, what), values in _quantities(counts, predicted, modes).items():
        seen = float(observed[kind, what][0])
        low, high = np.quantile(values, [0.03, 0.97])
        p = float((values > seen + 1e-12).mean() + 0.5 * (abs(values - seen) <= 1e-12).mean())
        found.append(
            PredictiveCheck(
                question.question.name, kind, what, seen, float(values.mean()), float(low), float(high), p
            )
        )
    return found


def _replicates(
    counts: Counts, ability: FloatArray, parameters: Mapping[str, FloatArray], rng: np.random.Generator
) -> NDArray[np.int64]:
    """Answers of new people, (draw, cell, level): each draw has its own."""
    n_draws, n_modes = ability.shape
    columns = {name: values[:, None] for name, values in parameters.items()}
    eta = ability[:, counts.mode_a] - ability[:, counts.mode_b] + columns.get("side_effect", 0.0)
    if "subject_sd" in parameters:
        free = rng.standard_normal((n_draws, len(counts.participants), n_modes - 1))
        own = free @ zero_sum_basis(n_modes).T
        between = own[:, counts.participant, counts.mode_a] - own[:, counts.participant, counts.mode_b]
        eta = eta + columns["subject_sd"] * between
    chances = answer_probabilities(eta, columns, counts.levels)
    chances /= chances.sum(axis=-1, keepdims=True)
    return np.asarray(rng.multinomial(counts.responses.sum(axis=1)[None, :], chances))


def _quantities(
    counts: Counts, responses: NDArray[np.int64], modes: tuple[str, ...]
) -> dict[tuple[Kind, str], FloatArray]:
    """Every checked quantity of (replicate, cell, level) answers: each of shape (replicate,)."""
    half, total = counts.levels // 2, responses.sum(axis=(1, 2))
    place = np.array([modes.index(mode) for mode in counts.modes])
    is_turned = place[counts.mode_a] > place[counts.mode_b]
    first, second = responses[..., :half].sum(axis=-1), responses[..., -half:].sum(axis=-1)
    for_i = np.where(is_turned, second, first)
    low, high = (
        np.minimum(place[counts.mode_a], place[counts.mode_b]),
        np.maximum(place[counts.mode_a], place[counts.mode_b]),
    )
    pairs = low * len(modes) + high
    by_pair = np.argsort(pairs, kind="stable")
    every, starts = np.unique(pairs[by_pair], return_index=True)
    wins = np.add.reduceat(for_i[:, by_pair], starts, axis=1)
    shares = wins / np.add.reduceat(responses[0].sum(axis=1)[by_pair], starts)
    found: dict[tuple[Kind, str], FloatArray] = {}
    for column, (i, j) in enumerate(zip(*np.divmod(every, len(modes)), strict=True)):
        found["wins", f"{modes[i]} over {modes[j]}"] = shares[:, column]
    if counts.levels > 2:
        found["ties", ""] = responses[..., half].sum(axis=1) / total
        if counts.levels == 5:
            for k, name in enumerate(_LEVEL_NAMES[5]):
                if k != half:
                    found["level", name] = responses[..., k].sum(axis=1) / total
        else:
            for k in (0, 2):
                found["level", _LEVEL_NAMES[3][k]] = responses[..., k].sum(axis=1) / total
    if len(counts.participants) > 1:
        found["spread", ""] = _spread(counts, for_i, np.where(is_turned, first, second), pairs)
    return found


def _spread(
    counts: Counts, for_i: NDArray[np.int64], for_j: NDArray[np.int64], pairs: NDArray[np.int64]
) -> FloatArray:
    """How far apart people are: root mean square, over people and pairs, of each person's net answer to a
    pair around the net answer of all to it.
    """
    net = (for_i - for_j).astype(float)
    n = counts.responses.sum(axis=1).astype(float)
    squares = np.zeros(len(net))
    keys = counts.participant * (pairs.max() + 1) + pairs
    _, own = np.unique(keys, return_inverse=True)
    _, pair = np.unique(pairs, return_inverse=True)
    n_own = np.bincount(own, n)
    pair_of_own = np.zeros(len(n_own), dtype=np.int64)
    pair_of_own[own] = pair
    n_pair = np.bincount(pair, n)
    for k, values in enumerate(net):
        mine = np.bincount(own, values) / n_own
        all_ = (np.bincount(pair, values) / n_pair)[pair_of_own]
        squares[k] = np.sqrt(np.mean((mine - all_) ** 2))
    return squares
