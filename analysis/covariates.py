"""Worth on a metric: does what was measured of a mode go with its ability? A model of record, by PyMC.

``ability = beta x + ZeroSumNormal(sigma)`` with x the modes' mean metric, standardised over the modes;
beta ~ Normal(0, 1), sigma ~ HalfNormal(0.5); side effect, cut-points and people as in the report's model.
With few modes a line through their worths fits whatever it is, so it needs at least four.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.association import FEWEST_MODES, measures_in
from analysis.counts import Counts, count_responses
from analysis.diagnostics import RHAT_BELOW, convergence, hdi
from analysis.model import CUT_GAP_SCALE, SIDE_EFFECT_SD, SUBJECT_SD_SCALE
from analysis.results import HDI_PROBABILITY, Fit, QuestionFit
from analysis.zero_sum import zero_sum_basis
from data.responses import MetricTable, ResponseTable

Progress = Callable[[int, int, str], None]
FloatArray = NDArray[np.float64]
SLOPE_SD = 1.0
"""Scale of Normal(0, .) on beta [logit per sd over modes]. Untuned: as wide as abilities."""
RESIDUAL_SD_SCALE = 0.5
"""Scale of HalfNormal(.) on what the metric leaves of the abilities [logit]. Untuned."""


@dataclass(frozen=True)
class CovariateEffect:
    """How ability goes with one metric on one question.

    Attributes
    ----------
    slope_mean, slope_hdi_low, slope_hdi_high : float
        Ability for one standard deviation more of the metric over the modes [logit]; 94 % HDI.
    p_positive : float
        Posterior probability of a slope above 0.
    residual_sd : float
        Posterior mean of what the metric leaves of the abilities [logit].
    converged : bool
    """

    question: str
    metric: str
    slope_mean: float
    slope_hdi_low: float
    slope_hdi_high: float
    p_positive: float
    residual_sd: float
    converged: bool


def covariate_effects(
    table: ResponseTable, fit: Fit, metrics: MetricTable, progress: Progress | None = None
) -> tuple[CovariateEffect, ...]:
    """Every ranked question with every metric that all modes have; none with fewer than four modes."""
    if len(fit.modes) < FEWEST_MODES or fit.settings.link != "cumulative":
        return ()
    tell = progress or (lambda done, total, now: None)
    means = metrics.rows.groupby("mode").mean(numeric_only=True)
    known = {}
    for measure in measures_in(metrics):
        x = means[measure.name].reindex(fit.modes).to_numpy(float)
        if not np.isnan(x).any() and x.std() > 0:
            known[measure.name] = (x - x.mean()) / x.std()
    ranked = [q for q in fit.questions if q.ranked]
    total, done, found = len(ranked) * len(known), 0, []
    for question in ranked:
        counts = count_responses(table, question.question)
        for name, x in known.items():
            by_name = x[[fit.modes.index(mode) for mode in counts.modes]]
            found.append(_effect(counts, question, name, by_name, fit))
            done += 1
            tell(done, total, question.question.short or question.question.name)
    return tuple(found)


def _effect(counts: Counts, question: QuestionFit, metric: str, x: FloatArray, fit: Fit) -> CovariateEffect:
    import pymc as pm

    used = counts if question.hierarchical else counts.pooled()
    n_modes, n_people, levels = len(used.modes), len(used.participants), used.levels
    basis = zero_sum_basis(n_modes)
    with pm.Model():
        slope = pm.Normal("slope", 0.0, SLOPE_SD)
        residual_sd = pm.HalfNormal("residual_sd", RESIDUAL_SD_SCALE)
        rest = pm.Normal("rest", 0.0, 1.0, shape=n_modes - 1)
        ability = slope * x + residual_sd * pm.math.dot(basis, rest)
        eta = ability[used.mode_a] - ability[used.mode_b]
        if fit.settings.side_effect:
            eta = eta + pm.Normal("side_effect", 0.0, SIDE_EFFECT_SD)
        if question.hierarchical:
            spread = pm.HalfNormal("subject_sd", SUBJECT_SD_SCALE)
            own = pm.math.dot(pm.Normal("own", 0.0, 1.0, shape=(n_people, n_modes - 1)), basis.T)
            eta = eta + spread * (own[used.participant, used.mode_a] - own[used.participant, used.mode_b])
        _likelihood(pm, eta, used.responses[:, ::-1], levels)
        chains = pm.sample(
            draws=500,
            tune=500,
            chains=4,
            nuts_sampler="nutpie",
            random_seed=fit.settings.seed,
            progressbar=False,
            compute_convergence_checks=False,
            target_accept=0.9,
        ).posterior
    draws = np.asarray(chains["slope"])
    low, high = hdi(draws.ravel(), HDI_PROBABILITY)
    return CovariateEffect(
        question.question.name,
        metric,
        float(draws.mean()),
        float(low),
        float(high),
        float((draws > 0).mean()),
        float(np.asarray(chains["residual_sd"]).mean()),
        bool(convergence(draws[None]).rhat_max < RHAT_BELOW),
    )


def _likelihood(pm, eta, ascending, levels) -> None:  # type: ignore[no-untyped-def]
    """Cumulative logit of the counts, answers from B much to A much."""
    half = levels // 2
    if levels == 2:
        pm.Binomial("answers", n=ascending.sum(axis=1), logit_p=eta, observed=ascending[:, 1])
        return
    gaps = pm.HalfNormal("gaps", CUT_GAP_SCALE, shape=half)
    cuts = pm.math.cumsum(gaps)
    theta = pm.math.concatenate([-cuts[::-1], cuts])
    below = pm.math.sigmoid(theta[None, :] - eta[:, None])
    first, last = below[:, :1], 1 - below[:, -1:]
    chances = pm.math.concatenate([first, below[:, 1:] - below[:, :-1], last], axis=1)
    pm.Multinomial(
        "answers", n=ascending.sum(axis=1), p=pm.math.clip(chances, 1e-12, 1.0), observed=ascending
    )
