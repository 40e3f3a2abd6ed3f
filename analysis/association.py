"""Preference meets physics: do preferred modes, or preferred laps, differ in what was measured of them?

Two views. Across modes: each mode's worth beside its mean metric; with few modes this is a picture and no
evidence. Across comparisons: does the mode that is chosen in a comparison have more, or less, of the metric
in this very comparison? Both are associations: what was measured lies between the mode and the answer, and
nobody set it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.answer_shares import thinned
from analysis.diagnostics import hdi
from analysis.engines.fast import question_seed
from analysis.figures.labels import LIKELY
from analysis.results import HDI_PROBABILITY, Fit, QuestionFit
from data.answers import SCALES
from data.responses import MetricTable, ResponseTable

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Measure:
    """A metric that the report sets beside the worths: its name in the data, and its name in words."""

    name: str
    words: str
    unit: str


MEASURES: tuple[Measure, ...] = (
    Measure("force_mean_edge_n", "force at the edge", "N"),
    Measure("gain_exit", "responsiveness leaving the edge", ""),
    Measure("jerk_rms_m_s3", "jerk", "m/s³"),
    Measure("longest_lock_s", "longest time locked", "s"),
    Measure("duration_s", "time a lap", "s"),
)
"""What the study of 2017 asked for: force, smoothness and being stuck, and responsiveness and time beside
them."""
FEWEST_MODES = 4
"""A line through fewer worths than these says nothing: no model of worth on a metric is fitted."""
_RESAMPLES = 400


@dataclass(frozen=True)
class ModeMeasure:
    """One metric of one mode: mean over participants of their own means, with its 94 % interval."""

    metric: str
    mode: str
    mean: float
    low: float
    high: float
    participants: int


@dataclass(frozen=True)
class Association:
    """One metric beside the answers to one question.

    Attributes
    ----------
    modes : int
        Modes with worth and metric.
    across_modes, across_modes_low, across_modes_high : float
        Correlation of worth and metric over the modes, 94 % HDI over posterior and participants; NaN if the
        question is not ranked.
    comparisons : int
        Answers whose comparison has the metric of both modes.
    across_comparisons, across_comparisons_low, across_comparisons_high : float
        Rank correlation of the answer (towards A) with the metric of A less that of B, about 0; 94 % interval
        by the Bayesian bootstrap over participants.
    p_positive : float
        Share of that bootstrap in which the correlation is above 0.
    """

    question: str
    metric: str
    modes: int
    across_modes: float
    across_modes_low: float
    across_modes_high: float
    comparisons: int
    across_comparisons: float
    across_comparisons_low: float
    across_comparisons_high: float
    p_positive: float

    @property
    def direction(self) -> int:
        """1 or -1 where preferred laps likely had more, or less, of the metric; else 0."""
        if self.p_positive >= (1 + LIKELY) / 2:
            return 1
        return -1 if self.p_positive <= (1 - LIKELY) / 2 else 0


def measures_in(metrics: MetricTable) -> tuple[Measure, ...]:
    """The report's measures that were taken here."""
    rows = metrics.rows
    return tuple(m for m in MEASURES if m.name in rows and rows[m.name].notna().any())


def mode_measures(metrics: MetricTable, modes: Sequence[str], seed: int) -> tuple[ModeMeasure, ...]:
    """Every measure of every mode that has it."""
    found = []
    for measure in measures_in(metrics):
        draws = _mean_draws(metrics, measure.name, modes, seed)
        own = _own_means(metrics, measure.name)
        for k, mode in enumerate(modes):
            known = own[mode].dropna() if mode in own else pd.Series(dtype=float)
            if len(known):
                low, high = hdi(draws[:, k], HDI_PROBABILITY) if len(known) > 1 else (nan, nan)
                found.append(
                    ModeMeasure(measure.name, mode, float(known.mean()), float(low), float(high), len(known))
                )
    return tuple(found)


def associations(table: ResponseTable, fit: Fit, metrics: MetricTable) -> tuple[Association, ...]:
    """Every question of the fit with every measure."""
    seed = fit.settings.seed
    found = []
    for measure in measures_in(metrics):
        means = _mean_draws(metrics, measure.name, fit.modes, seed)
        for question in fit.questions:
            n_modes, across = _across_modes(
                question, means[:, [fit.modes.index(m) for m in question.mode_names]]
            )
            n, rho = _across_comparisons(table, question, metrics, measure.name, seed)
            found.append(
                Association(
                    question.question.name,
                    measure.name,
                    n_modes,
                    *_summary(across),
                    n,
                    *_summary(rho),
                    float((rho > 0).mean() + 0.5 * (rho == 0).mean()) if rho.size else nan,
                )
            )
    order = [q.question.name for q in fit.questions]
    return tuple(sorted(found, key=lambda a: order.index(a.question)))


def _summary(draws: FloatArray) -> tuple[float, float, float]:
    if not draws.size:
        return nan, nan, nan
    low, high = hdi(draws, HDI_PROBABILITY)
    return float(draws.mean()), float(low), float(high)


def _own_means(metrics: MetricTable, name: str) -> pd.DataFrame:
    """Each participant's mean of a metric: a row a participant, a column a mode."""
    return metrics.rows.groupby(["participant", "mode"], sort=False)[name].mean().unstack("mode")


def mode_means(metrics: MetricTable, name: str, modes: Sequence[str]) -> FloatArray:
    """Each mode's mean over participants of their own means, NaN where none has it: ndarray, shape
    (mode,)."""
    return np.asarray(_own_means(metrics, name).mean().reindex(list(modes)), dtype=float)


def _mean_draws(metrics: MetricTable, name: str, modes: Sequence[str], seed: int) -> FloatArray:
    """Bayesian bootstrap of each mode's mean over participants, the same weights for all: (draw, mode)."""
    own = _own_means(metrics, name).reindex(columns=list(modes)).to_numpy(float)
    weights = _weights(len(own), question_seed(seed, f"measure {name}"))
    known = ~np.isnan(own)
    with np.errstate(invalid="ignore"):
        return np.asarray((weights @ np.where(known, own, 0.0)) / (weights @ known))


def _weights(n: int, seed: int) -> FloatArray:
    """Dirichlet(1) weights of n participants (Rubin 1981): shape (draw, participant)."""
    gaps = np.random.default_rng(seed).standard_exponential((_RESAMPLES, n))
    return np.asarray(gaps / gaps.sum(axis=1, keepdims=True))


def _across_modes(question: QuestionFit, means: FloatArray) -> tuple[int, FloatArray]:
    known = ~np.isnan(means).all(axis=0)
    n = int(known.sum())
    if question.draws is None or not question.ranked or n < 3:
        return n, np.empty(0)
    ability = thinned(question.draws, _RESAMPLES).ability[:_RESAMPLES, known]
    x = means[: len(ability), known]
    x = x - x.mean(axis=1, keepdims=True)
    y = ability - ability.mean(axis=1, keepdims=True)
    size = np.sqrt((x**2).sum(axis=1) * (y**2).sum(axis=1))
    return n, ((x * y).sum(axis=1)[size > 0] / size[size > 0])


def _across_comparisons(
    table: ResponseTable, question: QuestionFit, metrics: MetricTable, name: str, seed: int
) -> tuple[int, FloatArray]:
    """Answers with both values of the metric, and bootstrap draws of the correlation."""
    rows = table.rows
    rows = rows[(rows["question"] == question.question.name) & ~rows["check"].astype(bool)]
    values = metrics.rows.set_index(["comparison", "mode"])[name]
    of_a, of_b = (
        values.reindex(pd.MultiIndex.from_arrays([rows["comparison"], rows[side]])).to_numpy()
        for side in ("mode_a", "mode_b")
    )
    levels = question.question.levels
    steps = [k for k in range(levels // 2, -(levels // 2) - 1, -1) if k or levels % 2]
    answer = rows["response"].map(dict(zip(SCALES[levels], steps, strict=True))).to_numpy(float)
    known = ~np.isnan(of_a - of_b)
    x, y = _signed_ranks((of_a - of_b)[known]), _signed_ranks(answer[known])
    if len(x) < 3 or not x.any() or not y.any():
        return int(known.sum()), np.empty(0)
    _, person = np.unique(rows["participant"].to_numpy()[known].astype(str), return_inverse=True)
    weights = _weights(int(person.max()) + 1, question_seed(seed, f"{question.question.name} {name}"))
    xy, xx, yy = (np.bincount(person, product) for product in (x * y, x * x, y * y))
    size = np.sqrt((weights @ xx) * (weights @ yy))
    return int(known.sum()), np.asarray((weights @ xy) / np.maximum(size, 1e-300))


def _signed_ranks(values: FloatArray) -> FloatArray:
    """Midranks of the sizes with the signs of the values, 0 for 0: turning A and B round turns the sign
    alone."""
    _, place, count = np.unique(np.abs(values), return_inverse=True, return_counts=True)
    midrank = np.cumsum(count) - (count - 1) / 2
    return np.asarray(np.sign(values) * midrank[place])
