"""Which model predicts people best? Each model predicts every participant's answers without having seen them.

A model is fitted once, to everybody. What it would predict of a participant it had not seen follows by
weighting its draws with one over the likelihood of that person's answers, their own deviations integrated
out, the largest weights smoothed. Where the weights cannot be trusted (k-hat above 0.7: the person decides
the fit) the model is fitted again without that person. A fit that a report would not rank by, for want of
convergence above all, is not used here either: its model has no score, and says why.

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
from analysis.counts import count_responses
from analysis.fit import fit
from analysis.marginal import log_likelihoods, of_people
from analysis.model import model_behind
from analysis.order import with_order
from analysis.pareto import smoothed
from analysis.results import Draws, Fit, FitSettings, Link, QuestionFit
from data.answers import FEWEST_LEVELS
from data.responses import ResponseTable

Progress = Callable[[int, int, str], None]
FloatArray = NDArray[np.float64]

FEWEST_PEOPLE = 3
SMALL_DIFFERENCE = 4.0
"""A smaller difference in elpd tells nothing, whatever its standard error (Sivula et al. 2020)."""
_DRAWS = 1000
"""A predictive density needs fewer draws than an interval."""
_OPTION_VARIANTS = {
    "lapse": "careless answers",
    "person_side": "own side effects",
    "person_scale": "own widths of the scale",
    "position": "position and learning",
}
"""What a variant with or without an option is called."""
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
        Sum over participants of the log predictive density of all answers of each; nan if it has no score.
    difference, difference_se : float
        To the report's model and its standard error over participants; 0 for the report's own, nan if either
        has no score.
    participants : int
    refitted : int
        Participants for whom the model had to be fitted again without them.
    reading : str
        In words, cautiously; empty for the report's own model.
    missing : str
        Why there is no score, or nothing to compare it with; else empty.
    """

    question: str
    model: str
    elpd: float
    difference: float
    difference_se: float
    participants: int
    refitted: int
    reading: str
    missing: str = ""


@dataclass(frozen=True)
class _Points:
    """Log predictive density of every participant's answers, for how many it took a fit without them, and why
    it is not known of all."""

    values: FloatArray
    refitted: int
    missing: str = ""


def model_scores(
    table: ResponseTable, fitted: Fit, progress: Progress | None = None
) -> tuple[ModelScore, ...]:
    """Scores of the report's model and of its alternatives, question by question, by the fast engine.

    Empty if participants are unknown or fewer than three. Questions that are not ranked are left out.
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
    # Every variant, also without a person, keeps the places that comparisons have in the whole table.
    table = with_order(table) if base.position or _knows_order(table) else table
    alone = replace(table, questions=(question.question,))
    points: dict[str, _Points] = {}
    variants = _variants(base, question.question.levels, _knows_order(table))
    if base.side_effect and question.draws is not None and "side_effect" not in question.draws.parameters:
        # The answers make it unknown, so that the report's own model is without it.
        del variants["without a side effect"]
    for name, settings in variants.items():
        found = question
        if points or fitted.settings.engine == "gibbs":
            (found,) = fit(alone, settings).questions
        points[name] = _pointwise(alone, settings, found)
    return _scores(question.question.name, points)


def _knows_order(table: ResponseTable) -> bool:
    """True if every row is one answer, so that the rows say in which order answers were given."""
    asked = ~table.rows["check"].astype(bool)
    return bool((table.rows.loc[asked, "count"] == 1).all())


def _variants(settings: FitSettings, levels: int, knows_order: bool) -> dict[str, FitSettings]:
    """The report's model first, then one change at a time.

    An option that is on is left out, and one that is off is switched on where it has a meaning.
    """
    variants = {"as reported": settings}
    side = "without" if settings.side_effect else "with"
    variants[f"{side} a side effect"] = replace(settings, side_effect=not settings.side_effect)
    pooled = "people alike" if not settings.pooled else "people differ"
    # People who are alike differ neither in their sides nor in their widths.
    variants[pooled] = replace(settings, pooled=not settings.pooled, person_side=False, person_scale=False)
    if levels == 3:
        other: Link = "adjacent" if settings.link == "cumulative" else "cumulative"
        variants[f"{other} link"] = replace(settings, link=other)
    for option, what in _OPTION_VARIANTS.items():
        means_something = (
            option == "lapse"
            or (option == "position" and knows_order)
            or (option == "person_side" and not settings.pooled)
            or (option == "person_scale" and not settings.pooled and levels > FEWEST_LEVELS)
        )
        if means_something:
            is_on = getattr(settings, option)
            name = f"{'without' if is_on else 'with'} {what}"
            variants[name] = replace(settings, **{option: not is_on})  # type: ignore[arg-type]
    return variants


def _pointwise(table: ResponseTable, settings: FitSettings, fitted: QuestionFit) -> _Points:
    """Weighted draws of the fit to everybody, or of a fit without the person where k-hat asks for it."""
    if not fitted.ranked or fitted.draws is None:
        return _Points(np.full(fitted.n_participants, np.nan), 0, "the model did not converge")
    logs = _log_likelihoods(table, settings, fitted.draws)
    values, refitted, failed = np.empty(len(logs)), 0, 0
    for s, of_person in enumerate(logs):
        weights = smoothed(-of_person)
        if weights.trusted:
            values[s] = logsumexp(weights.log + of_person)
            continue
        values[s] = left_out(table, s, settings)
        refitted += 1
        failed += bool(np.isnan(values[s]))
    missing = f"no ranking from the fit without a participant, {failed} times" if failed else ""
    return _Points(values, refitted, missing)


def left_out(table: ResponseTable, person: int, settings: FitSettings) -> float:
    """Log predictive density of one person's answers, by a fit to all others.

    Parameters
    ----------
    table : ResponseTable
        Of one question.
    person : int
        Place among the sorted participants.

    Returns
    -------
    float
        nan if the fit to all others does not rank: it did not converge, or they do not connect the modes.
    """
    (question,) = table.questions
    name = count_responses(table, question).participants[person]
    rest = replace(table, rows=table.rows[table.rows["participant"] != name].reset_index(drop=True))
    (fitted,) = fit(rest, settings).questions
    if not fitted.ranked or fitted.draws is None:
        return float("nan")
    logs = _log_likelihoods(table, settings, fitted.draws, person)
    return float(logsumexp(logs[0]) - np.log(logs.shape[1]))


def _log_likelihoods(
    table: ResponseTable, settings: FitSettings, draws: Draws, person: int | None = None
) -> FloatArray:
    """Of every participant's answers, or of one's, to the one question: (participant, draw)."""
    (question,) = table.questions
    counts = count_responses(table, question, in_order=settings.position)
    if person is not None:
        counts = of_people(counts, np.arange(len(counts.participants)) == person)
    kept = thinned(draws, _DRAWS)
    place = [table.modes_of(question).index(mode) for mode in counts.modes]
    model = model_behind(draws.parameters, settings, counts.levels, has_participants=True)
    return log_likelihoods(counts, model, ThinnedDraws(kept.ability[:, place], kept.parameters))


def _scores(question: str, points: dict[str, _Points]) -> list[ModelScore]:
    base = points["as reported"]
    scores = []
    for model, found in points.items():
        lead = found.values - base.values
        n = len(lead)
        difference, se = float(lead.sum()), float(np.sqrt(n) * lead.std(ddof=1))
        missing = found.missing
        if base.missing and not missing:
            missing = "the report's own model has no score"
        reading = "" if found is base else "not scored" if missing else _reading(difference, se)
        elpd = float(found.values.sum())
        scores.append(ModelScore(question, model, elpd, difference, se, n, found.refitted, reading, missing))
    return scores


def _reading(difference: float, se: float) -> str:
    if abs(difference) < SMALL_DIFFERENCE or abs(difference) < 2 * se:
        return "not told apart"
    return "predicts better" if difference > 0 else "predicts worse"
