"""What `--full` adds: everything that needs the models fitted again."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from analysis.covariates import CovariateEffect, covariate_effects, covariate_refusal
from analysis.fit import fit
from analysis.lag import LagExclusion, LagLimits, lag_changes, without_laggy
from analysis.leaving_out import ModelScore, model_scores
from analysis.moderation import Moderation, moderation
from analysis.results import Fit
from analysis.sensitivity import PriorShift, prior_shifts
from data.errors import InputError
from data.responses import BackgroundTable, LagTable, MetricTable, ResponseTable

Progress = Callable[[int, int, str], None]
LAGGY = LagLimits(latency_ms=100.0, skipped_percent=1.0)
"""What counts as laggy where no limits are asked for. Untuned: from about 100 ms on people notice a delay."""


@dataclass(frozen=True)
class Refits:
    """What refits tell; each part is empty where it doesn't apply.

    Attributes
    ----------
    scores : tuple of ModelScore
        Models compared by how well they predict participants that they were not fitted to.
    shifts : tuple of PriorShift
        Worths under other priors.
    lag : LagExclusion or None
        What leaving out laggy comparisons would change; None if nobody guided the robot.
    effects : tuple of CovariateEffect
        Worth on metrics, where there are modes enough.
    no_effects : str
        Why there are none, as a sentence; empty if there are some, or no laps that could have metrics.
    moderation : Moderation
        Whether people with another background prefer other modes.
    """

    scores: tuple[ModelScore, ...]
    shifts: tuple[PriorShift, ...]
    lag: LagExclusion | None
    effects: tuple[CovariateEffect, ...]
    no_effects: str
    moderation: Moderation


def refits(
    table: ResponseTable,
    fitted: Fit,
    lag: LagTable | None = None,
    metrics: MetricTable | None = None,
    background: BackgroundTable | None = None,
    progress: Callable[[str], Progress] | None = None,
) -> Refits:
    """Fit everything again that a full report compares.

    Parameters
    ----------
    lag : LagTable or None
        None too where the report leaves out laggy comparisons by itself.
    progress : callable or None
        Called with the name of a stage; gives the callable that hears of its steps.
    """
    tell = progress or (lambda name: lambda done, total, now: None)
    scores = model_scores(table, fitted, tell("Models compared, participants left out"))
    shifts = prior_shifts(table, fitted, tell("Other priors"))
    prompt = _without_laggy(table, fitted, lag, tell)
    no_effects = "" if metrics is None else covariate_refusal(fitted, metrics)
    effects = covariate_effects(fitted, metrics)
    groups = moderation(table, fitted, background, tell("Groups of people"))
    return Refits(scores, shifts, prompt, effects, no_effects, groups)


def _without_laggy(
    table: ResponseTable, fitted: Fit, lag: LagTable | None, tell: Callable[[str], Progress]
) -> LagExclusion | None:
    if lag is None:
        return None
    try:
        kept = without_laggy(table, None, lag, LAGGY)
    except InputError:
        # Nothing would be left: said in the report as no change to show.
        names = tuple(dict.fromkeys(table.rows.loc[~table.rows["check"].astype(bool), "comparison"]))
        return LagExclusion(LAGGY, names, len(names), 0)
    if not kept.excluded.comparisons:
        return kept.excluded
    again = fit(kept.table, fitted.settings, tell("Without laggy comparisons"))
    return replace(kept.excluded, changes=lag_changes(fitted, again))
