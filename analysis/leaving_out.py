"""Which model predicts people best? Each is fitted without some participants, and predicts their answers.

References
----------
Vehtari, Gelman, Gabry 2017, "Practical Bayesian model evaluation using leave-one-out cross-validation"
(elpd and the standard error of a difference); Sivula, Magnusson, Matamoros, Vehtari 2020, "Uncertainty in
Bayesian leave-one-out cross-validation based model comparison" (small differences and few folds: the error is
unreliable).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from analysis.answer_shares import thinned
from analysis.counts import Counts, count_responses
from analysis.engines import fast
from analysis.identifiability import examine
from analysis.model import Problem, model_of
from analysis.persons import log_likelihoods, prior_nodes
from analysis.results import FitSettings, Link
from data.responses import ResponseTable

Progress = Callable[[int, int, str], None]
FloatArray = NDArray[np.float64]

MOST_FOLDS = 20
"""Up to so many participants each is left out alone; more are left out in so many groups."""
SMALL_DIFFERENCE = 4.0
"""A smaller difference in elpd tells nothing, whatever its standard error (Sivula et al. 2020)."""
_DRAWS, _TUNE, _CHAINS = 500, 300, 2
"""A predictive density needs fewer draws than an interval."""
_NODES = 256


@dataclass(frozen=True)
class ModelScore:
    """How well one model predicts the answers of participants it has not seen, on one question.

    Attributes
    ----------
    model : str
        What differs from the model of the report, or that it is the report's.
    elpd : float
        Sum over participants of the log predictive density of all answers of each.
    difference, difference_se : float
        To the report's model and its standard error over participants; 0 for the report's own.
    participants : int
    reading : str
        In words, cautiously.
    """

    question: str
    model: str
    elpd: float
    difference: float
    difference_se: float
    participants: int
    reading: str


def model_scores(
    table: ResponseTable, settings: FitSettings, progress: Progress | None = None
) -> tuple[ModelScore, ...]:
    """Scores of the report's model and of its alternatives, question by question, by the fast engine.

    Empty if participants are unknown or fewer than three. Questions that cannot be ranked are left out.
    """
    if not table.has_participants:
        return ()
    asked = []
    for question in table.questions:
        counts = count_responses(table, question)
        found = examine(counts, table.modes, has_participants=True, side_effect=False)
        if not found.refusal and len(counts.participants) > 2:
            asked.append(
                (
                    counts,
                    _variants(
                        replace(settings, engine="fast", draws=_DRAWS, tune=_TUNE, chains=_CHAINS),
                        counts.levels,
                    ),
                )
            )
    total = sum(len(variants) * _folds(counts) for counts, variants in asked)
    steps = count(1)

    def tell(text: str) -> None:
        if progress is not None:
            progress(next(steps), total, text)

    scores: list[ModelScore] = []
    for counts, variants in asked:
        points = {model: _pointwise(counts, settings, tell) for model, settings in variants.items()}
        scores += _scores(counts.question.name, points)
    return tuple(scores)


def _variants(settings: FitSettings, levels: int) -> dict[str, FitSettings]:
    """The report's model first, then one change at a time."""
    variants = {"as reported": settings}
    side = "without" if settings.side_effect else "with"
    variants[f"{side} a side effect"] = replace(settings, side_effect=not settings.side_effect)
    pooled = "people alike" if not settings.pooled else "people differ"
    variants[pooled] = replace(settings, pooled=not settings.pooled)
    if levels == 3:
        other: Link = "adjacent" if settings.link == "cumulative" else "cumulative"
        variants[f"{other} link"] = replace(settings, link=other)
    return variants


def _folds(counts: Counts) -> int:
    return min(len(counts.participants), MOST_FOLDS)


def _pointwise(counts: Counts, settings: FitSettings, tell: Callable[[str], None]) -> FloatArray:
    """Log predictive density of each participant's answers, from fits without that participant."""
    n, n_modes = len(counts.participants), len(counts.modes)
    model = model_of(settings, counts.levels, has_participants=True)
    nodes = prior_nodes(n_modes, _NODES) if model.hierarchical else np.zeros((1, n_modes))
    found = np.empty(n)
    for fold in range(_folds(counts)):
        out = np.arange(n) % _folds(counts) == fold
        rest = _of_people(counts, ~out)
        draws = fast.sample([Problem(rest if model.hierarchical else rest.pooled(), model)], settings)[0]
        kept = thinned(draws, 200)
        logs = log_likelihoods(_of_people(counts, out), kept.ability, kept.parameters, nodes)
        found[out] = logsumexp(logs, axis=(1, 2)) - np.log(logs[0].size)
        tell(counts.question.short or counts.question.name)
    return found


def _of_people(counts: Counts, chosen: NDArray[np.bool_]) -> Counts:
    """The answers of some participants alone."""
    kept = chosen[counts.participant]
    place = np.cumsum(chosen) - 1
    return replace(
        counts,
        participants=tuple(p for p, is_kept in zip(counts.participants, chosen, strict=True) if is_kept),
        participant=place[counts.participant[kept]].astype(np.int64),
        mode_a=counts.mode_a[kept],
        mode_b=counts.mode_b[kept],
        responses=counts.responses[kept],
    )


def _scores(question: str, points: dict[str, FloatArray]) -> list[ModelScore]:
    base = next(iter(points.values()))
    scores = []
    for model, values in points.items():
        lead = values - base
        n = len(lead)
        difference, se = float(lead.sum()), float(np.sqrt(n) * lead.std(ddof=1))
        reading = "" if values is base else _reading(difference, se)
        scores.append(ModelScore(question, model, float(values.sum()), difference, se, n, reading))
    return scores


def _reading(difference: float, se: float) -> str:
    if abs(difference) < SMALL_DIFFERENCE or abs(difference) < 2 * se:
        return "not told apart"
    return "predicts better" if difference > 0 else "predicts worse"
