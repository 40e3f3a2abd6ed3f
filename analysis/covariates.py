"""Worth on a metric: does what was measured of a mode go with its ability? A regression in two stages.

``ability = slope x + residual_sd ZeroSumNormal(1)`` with x the modes' mean metric, centred, in standard
deviations over the modes; slope ~ Normal(0, 1), residual_sd ~ HalfNormal(1). First, what the answers alone
say of the abilities: the report's posterior, taken as normal, with its prior divided out. Then the line
through that: given residual_sd everything is normal, and residual_sd is summed over a grid. No sampling, so
milliseconds.

The modes are the only observations of x. With few of them a line through their worths fits whatever they are,
so it takes at least four, and the slope stays weakly identified well beyond that.

References
----------
Gasparrini, Armstrong, Kenward 2012, "Multivariate meta-analysis for non-linear and other multi-parameter
associations" (regression on estimates that carry a covariance); Gelman 2006, "Prior distributions for
variance parameters in hierarchical models" (HalfNormal and few groups).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.association import LIST_ERROR
from analysis.claims import Claim
from analysis.measures import MEASURES, measures_in, mode_means
from analysis.results import HDI_PROBABILITY, Draws, Fit
from analysis.zero_sum import zero_sum_basis
from data.responses import MetricTable

FloatArray = NDArray[np.float64]
SLOPES_SECTION = "Worth on metrics"
FEWEST_MODES = 4
"""A line through fewer worths than these says nothing: no model of worth on a metric is fitted."""
SLOPE_SD = 1.0
"""Scale of Normal(0, .) on the slope [logit per sd over modes]. Untuned: as wide as abilities."""
RESIDUAL_SD_SCALE = 1.0
"""Scale of HalfNormal(.) on what the metric leaves of the abilities [logit]. Untuned: the metric may leave
all."""
_RESIDUALS = np.linspace(0.0, 5 * RESIDUAL_SD_SCALE, 251)[1:]
_SLOPES = np.linspace(-6 * SLOPE_SD, 6 * SLOPE_SD, 2401)
_LEAST_PRECISION = 1e-6
"""Of what the answers say along a direction [1/logit²]: noise of the draws must not make it negative."""


@dataclass(frozen=True)
class CovariateEffect:
    """How ability goes with one metric on one question.

    Attributes
    ----------
    metric_sd : float
        One standard deviation of the metric over the modes [unit of the metric].
    slope_mean, slope_sd, slope_hdi_low, slope_hdi_high : float
        Ability for one such standard deviation more [logit]; 94 % HDI.
    p_positive : float
        Posterior probability of a slope above 0.
    residual_sd : float
        Posterior mean of what the metric leaves of the abilities [logit].
    p_in_list : float
        Posterior probability of the smaller side of 0, doubled, and corrected for the number of slopes after
        Holm (1979): the list of those up to `LIST_ERROR` is all right with a probability of 95 % or more.
    """

    question: str
    metric: str
    metric_sd: float
    slope_mean: float
    slope_sd: float
    slope_hdi_low: float
    slope_hdi_high: float
    p_positive: float
    residual_sd: float
    p_in_list: float = 1.0

    @property
    def is_clear(self) -> bool:
        """Whether the slope may be named in a list of which all is right with a probability of 95 %."""
        return self.p_in_list <= LIST_ERROR


def covariate_refusal(fit: Fit, metrics: MetricTable | None) -> str:
    """Why no model of worth on metrics can be fitted, as a sentence; empty if one can."""
    if len(fit.modes) < FEWEST_MODES:
        return (
            f"With {len(fit.modes)} modes a line goes through their worths whatever they are: a model of "
            f"worth on metrics takes at least {FEWEST_MODES} modes."
        )
    if fit.settings.engine == "gibbs":
        return (
            "The gibbs engine's prior is not normal, and the model of worth on metrics builds on one that is."
        )
    if metrics is None:
        return "No metrics of laps stand beside these answers, so there is nothing to set worths on."
    if not _standardised(fit.modes, metrics):
        return (
            "No metric is known of every mode and differs between modes, so there is nothing to set worths "
            "on."
        )
    if not any(q.ranked for q in fit.questions):
        return "No question is ranked, so there are no worths to set on metrics."
    return ""


def covariate_effects(fit: Fit, metrics: MetricTable | None) -> tuple[CovariateEffect, ...]:
    """Every ranked question with every metric that all modes have; none where `covariate_refusal` says
    why."""
    if metrics is None or covariate_refusal(fit, metrics):
        return ()
    ranked = [q for q in fit.questions if q.ranked and len(q.mode_names) >= FEWEST_MODES]
    draws = {q.question.name: q.draws for q in ranked if q.draws is not None}
    values = {q.question.name: _standardised(q.mode_names, metrics) for q in ranked}
    return slopes_of(draws, values, fit.settings.prior_sd)


def slopes_of(
    draws: Mapping[str, Draws],
    metrics: Mapping[str, Mapping[str, tuple[FloatArray, float]]],
    prior_sd: float,
) -> tuple[CovariateEffect, ...]:
    """The slope of every question's abilities on every metric, and which of them stand in the whole list.

    Parameters
    ----------
    draws : mapping of str to Draws
        By question.
    metrics : mapping of str to mapping of str to tuple
        By question and metric: the modes' values, ndarray, shape (mode,), centred and in their own sd, and
        that sd.
    prior_sd : float
        Of the abilities, with which the draws were made.
    """
    effects = [
        _effect(question, metric, sd, x, own, prior_sd)
        for question, own in draws.items()
        for metric, (x, sd) in metrics[question].items()
    ]
    tails = np.array([2 * min(e.p_positive, 1 - e.p_positive) for e in effects])
    return tuple(replace(effect, p_in_list=float(p)) for effect, p in zip(effects, _holm(tails), strict=True))


def covariate_claims(effects: Sequence[CovariateEffect]) -> tuple[Claim, ...]:
    """The slopes that are named, each with the posterior probability of its sign."""
    measures = {m.name: m for m in MEASURES}
    return tuple(
        Claim(
            SLOPES_SECTION,
            f"Modes with {measures[e.metric].compared(e.slope_mean)} rank higher on {e.question}.",
            max(e.p_positive, 1.0 - e.p_positive),
            e.question,
        )
        for e in effects
        if e.is_clear
    )


def _holm(p: FloatArray) -> FloatArray:
    """Holm's (1979) step-down correction of p-values, of shape (test,)."""
    order = np.argsort(p, kind="stable")
    corrected = np.empty(len(p))
    stepped = p[order] * np.arange(len(p), 0, -1)
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(stepped))
    return corrected


def _standardised(modes: tuple[str, ...], metrics: MetricTable) -> dict[str, tuple[FloatArray, float]]:
    """By metric that every mode has: the modes' means, centred and in their own sd, and that sd."""
    known = {}
    for measure in measures_in(metrics):
        x = mode_means(metrics, measure.name, modes)
        if not np.isnan(x).any() and x.std() > 1e-9 * np.abs(x).max():
            known[measure.name] = ((x - x.mean()) / x.std(), float(x.std()))
    return known


def _effect(
    question: str, metric: str, sd: float, x: FloatArray, draws: Draws, prior_sd: float
) -> CovariateEffect:
    """The posterior of slope and residual sd, in the directions in which what the answers say is independent.

    Along direction i with precision p and estimate m, ``m ~ Normal(slope x_i, sqrt(1 / p + residual_sd^2))``.
    """
    basis = zero_sum_basis(len(x))
    ability = draws.ability.reshape(-1, len(x)) @ basis
    total = np.linalg.inv(np.cov(ability, rowvar=False))
    precision, axes = np.linalg.eigh(total - np.eye(len(total)) / prior_sd**2)
    precision = np.maximum(precision, _LEAST_PRECISION)
    estimate = (axes.T @ total @ ability.mean(axis=0)) / precision
    along = axes.T @ (basis.T @ x)

    weight = 1.0 / (1.0 / precision + _RESIDUALS[:, None] ** 2)
    inverse_variance = (weight * along**2).sum(axis=1) + SLOPE_SD**-2
    mean = (weight * along * estimate).sum(axis=1) / inverse_variance
    fits = 0.5 * np.log(weight).sum(axis=1) - 0.5 * np.log(inverse_variance)
    fits += 0.5 * inverse_variance * mean**2 - 0.5 * (weight * estimate**2).sum(axis=1)
    fits -= 0.5 * (_RESIDUALS / RESIDUAL_SD_SCALE) ** 2
    of_residual = np.exp(fits - fits.max())
    of_residual /= of_residual.sum()

    apart = (_SLOPES - mean[:, None]) * np.sqrt(inverse_variance)[:, None]
    of_slope = of_residual @ (np.exp(-0.5 * apart**2) * np.sqrt(inverse_variance)[:, None])
    of_slope /= of_slope.sum()
    slope_mean = float(of_slope @ _SLOPES)
    low, high = _highest(of_slope)
    return CovariateEffect(
        question,
        metric,
        sd,
        slope_mean,
        float(np.sqrt(of_slope @ (_SLOPES - slope_mean) ** 2)),
        low,
        high,
        float(of_slope[_SLOPES > 0].sum() + 0.5 * of_slope[_SLOPES == 0].sum()),
        float(of_residual @ _RESIDUALS),
    )


def _highest(of_slope: FloatArray) -> tuple[float, float]:
    """Ends of the slopes of highest density that hold 94 % together (a mixture of concentric hills: one
    piece)."""
    order = np.argsort(-of_slope, kind="stable")
    inside = order[: int(np.searchsorted(np.cumsum(of_slope[order]), HDI_PROBABILITY)) + 1]
    return float(_SLOPES[inside.min()]), float(_SLOPES[inside.max()])
