"""Do the priors decide? Worths and first places under narrower and wider priors.

Another scale of the abilities' prior is fitted again. Another scale of the subject sd's is not: the draws
of the report are weighted by the ratio of the two priors, the largest weights smoothed, and where k-hat
says that they cannot carry it nothing is reported.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import nan

import numpy as np

from analysis.fit import fit
from analysis.model import SUBJECT_SD_SCALE
from analysis.pareto import smoothed
from analysis.results import Draws, Fit, QuestionFit
from data.responses import ResponseTable

Progress = Callable[[int, int, str], None]
FACTORS = (0.5, 2.0)
FEWEST_EFFECTIVE = 100.0
"""Effective draws below which a reweighted posterior is not reported. Untuned."""


@dataclass(frozen=True)
class PriorShift:
    """One mode on one question under another prior; NaN where there is no ranking or too few draws.

    Attributes
    ----------
    prior : str
        E.g. ``ability ~ ZeroSumNormal(0.5)``.
    worth, p_best : float
        Under the report's prior.
    worth_then, p_best_then : float
        Under the other one.
    is_weighted : bool
        True if the report's draws are weighted, False if the model is fitted again.
    """

    question: str
    mode: str
    prior: str
    worth: float
    worth_then: float
    p_best: float
    p_best_then: float
    is_weighted: bool


def prior_shifts(
    table: ResponseTable, fitted: Fit, progress: Progress | None = None
) -> tuple[PriorShift, ...]:
    """Half and twice the scale of the ability prior (refits), then of the subject sd's (reweighted draws)."""
    tell = progress or (lambda done, total, text: None)
    shifts: list[PriorShift] = []
    if fitted.settings.engine != "gibbs":
        for k, factor in enumerate(FACTORS):
            scale = factor * fitted.settings.prior_sd
            again = fit(table, replace(fitted.settings, prior_sd=scale), _part(tell, k))
            for question, other in zip(fitted.questions, again.questions, strict=True):
                then = {m.mode: (m.worth_mean, m.p_best) for m in other.modes}
                shifts += _shifts(question, f"ability ~ ZeroSumNormal({scale:g})", then, False)
    for factor in FACTORS:
        scale = factor * SUBJECT_SD_SCALE
        for question in fitted.questions:
            if question.draws is not None and question.ranked and "subject_sd" in question.draws.parameters:
                then = _reweighted(question.draws, question.mode_names, scale)
                shifts += _shifts(question, f"subject_sd ~ HalfNormal({scale:g})", then, True)
    return tuple(shifts)


def _part(tell: Progress, k: int) -> Progress:
    """Progress of the k-th of the fits, as progress of all of them."""

    def report(done: int, total: int, now: str) -> None:
        tell(k * total + done, len(FACTORS) * total, now)

    return report


def _shifts(
    question: QuestionFit, prior: str, then: dict[str, tuple[float, float]], is_weighted: bool
) -> list[PriorShift]:
    return [
        PriorShift(
            question.question.name,
            m.mode,
            prior,
            m.worth_mean,
            then.get(m.mode, (nan, nan))[0],
            m.p_best,
            then.get(m.mode, (nan, nan))[1],
            is_weighted,
        )
        for m in question.modes
    ]


def _reweighted(draws: Draws, modes: tuple[str, ...], scale: float) -> dict[str, tuple[float, float]]:
    """Worth and chance to rank first under ``subject_sd ~ HalfNormal(scale)``, by smoothed importance
    weights."""
    sd = draws.parameters["subject_sd"].reshape(-1)
    weights = smoothed(0.5 * sd**2 * (SUBJECT_SD_SCALE**-2 - scale**-2))
    if not weights.trusted or weights.effective < FEWEST_EFFECTIVE:
        return {}
    share, worth = np.exp(weights.log), draws.worth.reshape(-1, len(modes))
    is_best = worth.argmax(axis=1)[:, None] == np.arange(len(modes))
    return {
        mode: (float(share @ worth[:, k]), min(1.0, float(share @ is_best[:, k])))
        for k, mode in enumerate(modes)
    }
