"""What `--full` adds: everything that needs the models fitted again."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from analysis.covariates import CovariateEffect, covariate_effects
from analysis.fit import fit
from analysis.lag import LagExclusion, LagLimits, lag_changes, without_laggy
from analysis.leaving_out import ModelScore, model_scores
from analysis.results import Fit
from analysis.sensitivity import PriorShift, prior_shifts
from data.errors import InputError
from data.responses import LagTable, MetricTable, ResponseTable

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
    """

    scores: tuple[ModelScore, ...]
    shifts: tuple[PriorShift, ...]
    lag: LagExclusion | None
    effects: tuple[CovariateEffect, ...]


def refits(
    table: ResponseTable,
    fitted: Fit,
    lag: LagTable | None = None,
    metrics: MetricTable | None = None,
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
    return Refits(
        model_scores(table, fitted.settings, tell("Models compared, participants left out")),
        prior_shifts(table, fitted, tell("Other priors")),
        _without_laggy(table, fitted, lag),
        covariate_effects(table, fitted, metrics, tell("Worth on metrics")) if metrics is not None else (),
    )


def _without_laggy(table: ResponseTable, fitted: Fit, lag: LagTable | None) -> LagExclusion | None:
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
    return replace(kept.excluded, changes=lag_changes(fitted, fit(kept.table, fitted.settings)))
