"""What a report says beyond the ranking and needs no refit for, gathered in one place."""

from dataclasses import dataclass

from analysis.answer_shares import PairShares, answer_shares
from analysis.association import Association, associations
from analysis.consistency import Consistency, consistencies
from analysis.equality_reach import EqualityReach, reach_of
from analysis.equivalence import Equivalence, equivalences
from analysis.measures import ModeMeasure, mode_measures
from analysis.monte_carlo import MonteCarloError, monte_carlo_errors
from analysis.persons import Agreement, agreements
from analysis.predictive import PredictiveChecks, predictive_checks
from analysis.results import Fit
from analysis.strength import Strength, strengths
from data.responses import MetricTable, ResponseTable


@dataclass(frozen=True)
class CloserLook:
    """Each part in the order of the fit's questions; empty where nothing is known.

    Attributes
    ----------
    shares : tuple of tuples of PairShares
        Question by question.
    errors : tuple of MonteCarloError
        Of the means and chances of the ranking itself.
    equality : EqualityReach or None
        What a study of this size could show of equal modes, where that is known.
    measures, associations
        Of the metrics of the laps, where there are laps.
    """

    shares: tuple[tuple[PairShares, ...], ...]
    strengths: tuple[Strength, ...]
    equivalences: tuple[Equivalence, ...]
    agreements: tuple[Agreement, ...]
    consistencies: tuple[Consistency, ...]
    checks: PredictiveChecks
    measures: tuple[ModeMeasure, ...] = ()
    associations: tuple[Association, ...] = ()
    errors: tuple[MonteCarloError, ...] = ()
    equality: EqualityReach | None = None


def closer_look(table: ResponseTable, fit: Fit, metrics: MetricTable | None = None) -> CloserLook:
    """Everything beyond the ranking that the draws, the answers and the laps tell without a refit."""
    shares = answer_shares(table, fit)
    seed = fit.settings.seed
    return CloserLook(
        shares,
        strengths(fit, shares),
        equivalences(fit),
        agreements(table, fit, seed),
        consistencies(table),
        predictive_checks(table, fit),
        mode_measures(metrics, fit.modes) if metrics is not None else (),
        associations(table, metrics, seed) if metrics is not None else (),
        monte_carlo_errors(fit),
        reach_of(fit),
    )
