"""Which model predicts people best? Each model predicts every participant's answers without having seen them.

A model is fitted once, to everybody. What it would predict of a participant it had not seen follows by
weighting its draws with one over the likelihood of that person's answers, their own deviations integrated
out, the largest weights smoothed. Where the weights cannot be trusted (k-hat above 0.7: the person decides
the fit) the model is fitted again without that person.

References
----------
Vehtari, Gelman, Gabry 2017, "Practical Bayesian model evaluation using leave-one-out cross-validation" (elpd,
its weights and the standard error of a difference); Merkle, Furr, Rabe-Hesketh 2019, "Bayesian comparison of
latent variable models" (people are left out whole, their own parameters integrated out); Sivula, Magnusson,
Matamoros, Vehtari 2020, "Uncertainty in Bayesian leave-one-out cross-validation based model comparison"
(small differences and few people: the error is unreliable).
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from analysis.answer_shares import ThinnedDraws, thinned
from analysis.counts import Counts, count_responses
from analysis.engines import fast
from analysis.fit import fit
from analysis.marginal import log_likelihoods, of_people
from analysis.model import Model, Problem, model_of
from analysis.pareto import smoothed
from analysis.results import Draws, Fit, FitSettings, Link, QuestionFit
from data.responses import ResponseTable

Progress = Callable[[int, int, str], None]
FloatArray = NDArray[np.float64]

FEWEST_PEOPLE = 3
SMALL_DIFFERENCE = 4.0
"""A smaller difference in elpd tells nothing, whatever its standard error (Sivula et al. 2020)."""
_DRAWS = 1000
"""A predictive density needs fewer draws than an interval."""
_AT_A_TIME = 2
"""Questions share nothing: while one is summed up, another one samples, on all cores."""


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
    refitted : int
        Participants for whom the model had to be fitted again without them.
    reading : str
        In words, cautiously.
    """

    question: str
    model: str
    elpd: float
    difference: float
    difference_se: float
    participants: int
    refitted: int
    reading: str


@dataclass(frozen=True)
class _Points:
    """Log predictive density of every participant's answers, and for how many it took a fit of their own."""

    values: FloatArray
    refitted: int


def model_scores(
    table: ResponseTable, fitted: Fit, progress: Progress | None = None
) -> tuple[ModelScore, ...]:
    """Scores of the report's model and of its alternatives, question by question, by the fast engine.

    Empty if participants are unknown or fewer than three. Questions that are not ranked are left out, and
    alternatives that do not converge.
    """
    if not table.has_participants:
        return ()
    base = _as_fast(fitted.settings)
    asked = [q for q in fitted.questions if q.ranked and q.n_participants >= FEWEST_PEOPLE]
    tell = progress or (lambda done, total, text: None)
    scores: list[ModelScore] = []
    tell(0, len(asked), "")
    with ThreadPoolExecutor(_AT_A_TIME) as pool:
        found = pool.map(lambda q: _question_scores(table, q, fitted, base), asked)
        for done, (question, own) in enumerate(zip(asked, found, strict=True), start=1):
            scores += own
            tell(done, len(asked), question.question.short or question.question.name)
    return tuple(scores)


def _as_fast(settings: FitSettings) -> FitSettings:
    """The fast engine's settings for the same model; the gibbs engine's is pooled and without a side
    effect."""
    if settings.engine != "gibbs":
        return replace(settings, engine="fast")
    return replace(settings, engine="fast", pooled=True, side_effect=False)


def _question_scores(
    table: ResponseTable, question: QuestionFit, fitted: Fit, base: FitSettings
) -> list[ModelScore]:
    counts = count_responses(table, question.question)
    alone = replace(table, questions=(question.question,))
    points: dict[str, _Points] = {}
    for name, settings in _variants(base, counts.levels).items():
        draws = question.draws if not points and fitted.settings.engine != "gibbs" else None
        if draws is None:
            (again,) = fit(alone, settings).questions
            draws = again.draws if again.ranked else None
        if draws is not None:
            points[name] = _pointwise(counts, settings, draws, fitted.modes)
    return _scores(question.question.name, points)


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


def _pointwise(counts: Counts, settings: FitSettings, draws: Draws, modes: tuple[str, ...]) -> _Points:
    """Weighted draws of the fit to everybody, or of a fit without the person where k-hat asks for it."""
    model = model_of(settings, counts.levels, has_participants=True)
    kept = thinned(draws, _DRAWS)
    in_order = ThinnedDraws(kept.ability[:, [modes.index(m) for m in counts.modes]], kept.parameters)
    logs = log_likelihoods(counts, model, in_order)
    values, refitted = np.empty(len(logs)), 0
    for s, of_person in enumerate(logs):
        weights = smoothed(-of_person)
        if weights.trusted:
            values[s] = logsumexp(weights.log + of_person)
        else:
            values[s] = left_out(counts, s, model, settings)
            refitted += 1
    return _Points(values, refitted)


def left_out(counts: Counts, person: int, model: Model, settings: FitSettings) -> float:
    """Log predictive density of one person's answers, by a fit to all others."""
    is_out = np.arange(len(counts.participants)) == person
    rest = of_people(counts, ~is_out)
    problem = Problem(rest if model.hierarchical else rest.pooled(), model)
    kept = thinned(fast.sample([problem], settings)[0], _DRAWS)
    (logs,) = log_likelihoods(of_people(counts, is_out), model, kept)
    return float(logsumexp(logs) - np.log(len(logs)))


def _scores(question: str, points: dict[str, _Points]) -> list[ModelScore]:
    if "as reported" not in points:
        return []
    base = points["as reported"].values
    scores = []
    for model, found in points.items():
        lead = found.values - base
        n = len(lead)
        difference, se = float(lead.sum()), float(np.sqrt(n) * lead.std(ddof=1))
        reading = "" if found.values is base else _reading(difference, se)
        elpd = float(found.values.sum())
        scores.append(ModelScore(question, model, elpd, difference, se, n, found.refitted, reading))
    return scores


def _reading(difference: float, se: float) -> str:
    if abs(difference) < SMALL_DIFFERENCE or abs(difference) < 2 * se:
        return "not told apart"
    return "predicts better" if difference > 0 else "predicts worse"
