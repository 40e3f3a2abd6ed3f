"""Preference meets physics: do answers go with what was measured of the two laps they compare?

Within a person, the answer (towards A) is set beside the metric of A less that of B, both as ranks about 0
and less the person's own mean: whoever favours a side, or always gives the same answer, adds nothing. People
are the units: what is tested is whether their own correlations lie to one side. All questions and metrics
are tested together, so that a report whose answers have nothing to do with any metric names one in at most
5 % of studies.

Nothing is correlated over the modes: three points that have nothing to do with each other correlate above .98
in one case of eight. `covariates` has a model for four modes and more.

References
----------
Romano & Wolf 2005 (the whole list, see `sign_flips`); Miller 1974, "The jackknife - a review", Biometrika 61
(the interval: Fisher's z of the correlation, people left out one by one).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan, nan, sqrt

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import stdtrit

from analysis.claims import Claim
from analysis.engines.fast import question_seed
from analysis.measures import FEWEST_PEOPLE, MEASURES, measures_in
from analysis.results import HDI_PROBABILITY, Fit
from analysis.sign_flips import FlippedTests, flipped_tests
from data.answers import SCALES
from data.responses import MetricTable, QuestionScale, ResponseTable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]
SECTION = "Preference meets physics"
LIST_ERROR = 0.05
"""Probability that a report names any pair of a question and a metric that do not go together."""
FEWEST_TO_PASS = 6
"""So few people cannot pass by chance with less than `LIST_ERROR`: five agree in one of 16 cases."""


@dataclass(frozen=True)
class Association:
    """One metric beside the answers to one question.

    Attributes
    ----------
    comparisons, participants : int
        Answers whose comparison has the metric of both modes, by people with at least two of them; and these
        people.
    correlation, correlation_low, correlation_high : float
        Rank correlation within people of the answer (towards A) with the metric of A less that of B; 94 %
        interval over people. NaN where answers or metric do not vary within anybody, the interval too with
        fewer than three people.
    mode_share : float
        Of the squared differences between the laps, the share that goes back to the modes: what differences
        between the modes, the same for everybody, explain.
    p_alone : float
        Two-sided p-value by flipping the signs of people, of this metric and question alone.
    p_in_list : float
        The same among all questions and metrics of the report; what passes has at most `LIST_ERROR`.
    """

    question: str
    metric: str
    comparisons: int
    participants: int
    correlation: float
    correlation_low: float
    correlation_high: float
    mode_share: float
    p_alone: float
    p_in_list: float

    @property
    def passes(self) -> bool:
        """Whether it may be named in a list of which all is right with a probability of 95 %."""
        return self.p_in_list <= LIST_ERROR


@dataclass(frozen=True)
class Laps:
    """Behind each answer: the person, the two modes, and the metrics of A less those of B, (answer,
    metric)."""

    metrics: tuple[str, ...]
    person: IntArray
    mode_a: IntArray
    mode_b: IntArray
    difference: FloatArray


@dataclass(frozen=True)
class Products:
    """Sums over each person's comparisons, of shape (person,): metric with answer, metric, answer; and the
    comparisons, of those who have at least two."""

    crossed: FloatArray
    metric: FloatArray
    answer: FloatArray
    comparisons: IntArray

    @property
    def contributions(self) -> FloatArray:
        """Each person's own correlation, in units of its sd under chance: 0 where answers or metric do not
        vary.

        Not the bare sums: with those, a person whose laps hardly differ tips no balance, and the signs of
        seven people would say as little as those of four.
        """
        size = np.sqrt(self.metric * self.answer)
        own = np.divide(self.crossed, size, out=np.zeros(len(size)), where=size > 0)
        return np.asarray(own * np.sqrt(np.maximum(self.comparisons - 1, 0)))


@dataclass(frozen=True)
class PairTests:
    """Pairs of a question and a metric, what people add to each, and how far from chance that is."""

    pairs: tuple[tuple[str, str], ...]
    products: tuple[Products, ...]
    flips: FlippedTests


def associations(table: ResponseTable, metrics: MetricTable, seed: int = 2017) -> tuple[Association, ...]:
    """Every question with every measure; the seed is for the flips with more than twelve people."""
    rows = table.rows[~table.rows["check"].astype(bool)]
    laps = laps_behind(rows, metrics)
    if not laps.metrics or not table.questions:
        return ()
    tested = pair_tests(rows, laps, table.questions, seed)
    asked = rows["question"].to_numpy()
    return tuple(
        _association(pair, product, _mode_share(laps, asked == pair[0], pair[1]), alone, in_list)
        for pair, product, alone, in_list in zip(
            tested.pairs, tested.products, tested.flips.alone, tested.flips.in_list, strict=True
        )
    )


def laps_behind(rows: pd.DataFrame, metrics: MetricTable) -> Laps:
    """What was measured of the two laps behind each answer, none of which is an attention check."""
    names = [measure.name for measure in measures_in(metrics)]
    values = metrics.rows.set_index(["comparison", "mode"])[names]
    of_a, of_b = (
        values.reindex(pd.MultiIndex.from_arrays([rows["comparison"], rows[side]])).to_numpy(float)
        for side in ("mode_a", "mode_b")
    )
    person, _ = pd.factorize(rows["participant"].astype(str))
    mode = pd.factorize(rows[["mode_a", "mode_b"]].to_numpy().ravel())[0].reshape(-1, 2)
    return Laps(tuple(names), person, mode[:, 0], mode[:, 1], of_a - of_b)


def pair_tests(rows: pd.DataFrame, laps: Laps, questions: Sequence[QuestionScale], seed: int) -> PairTests:
    """Every question with every metric, tested together; ``laps`` are those behind ``rows``."""
    asked, responses = rows["question"].to_numpy(), rows["response"].to_numpy()
    pairs, products = [], []
    for question in questions:
        own = np.flatnonzero(asked == question.name)
        towards_a = _towards_a(responses[own], question.levels)
        for k, name in enumerate(laps.metrics):
            pairs.append((question.name, name))
            products.append(_products(laps.person[own], laps.difference[own, k], towards_a))
    added = np.zeros((int(laps.person.max(initial=-1)) + 1, len(pairs)))
    for k, product in enumerate(products):
        added[: len(product.comparisons), k] = product.contributions
    flips = flipped_tests(added, question_seed(seed, "association"))
    return PairTests(tuple(pairs), tuple(products), flips)


def association_claims(found: Sequence[Association], fit: Fit) -> tuple[Claim, ...]:
    """The pairs of a question and a metric that pass, most certain first.

    Their probability is 1 less the error rate at which they enter the list: a bound from a test of all pairs
    together, not a posterior.
    """
    measures = {m.name: m for m in MEASURES}
    shorts = {q.question.name: q.question.short or q.question.name for q in fit.questions}
    passing = sorted((a for a in found if a.passes), key=lambda a: (a.p_in_list, -abs(a.correlation)))
    return tuple(
        Claim(
            SECTION,
            f"In single comparisons “{shorts[a.question]}” went with "
            f"{measures[a.metric].compared(a.correlation)}.",
            1.0 - a.p_in_list,
            a.question,
        )
        for a in passing
    )


def _towards_a(responses: NDArray[np.object_], levels: int) -> FloatArray:
    """Steps of the answers from the middle of the scale, positive towards A."""
    steps = [k for k in range(levels // 2, -(levels // 2) - 1, -1) if k or levels % 2]
    step_of = dict(zip(SCALES[levels], steps, strict=True))
    return np.array([step_of[response] for response in responses], dtype=float)


def _products(person: IntArray, difference: FloatArray, towards_a: FloatArray) -> Products:
    measured = ~np.isnan(difference)
    own = np.bincount(person[measured], minlength=int(person.max(initial=-1)) + 1)
    used = measured & (own >= 2)[person]
    metric, answer = (
        _centred(_signed_ranks(values[used]), person[used], len(own)) for values in (difference, towards_a)
    )
    crossed, metric_squared, answer_squared = (
        np.bincount(person[used], product, len(own)).astype(float)
        for product in (metric * answer, metric**2, answer**2)
    )
    return Products(crossed, metric_squared, answer_squared, np.where(own >= 2, own, 0))


def _centred(values: FloatArray, person: IntArray, people: int) -> FloatArray:
    """Less each person's mean; exactly 0 for somebody with one value throughout."""
    count = np.maximum(np.bincount(person, minlength=people), 1)
    centred = values - (np.bincount(person, values, people) / count)[person]
    return np.asarray(np.where(np.abs(centred) > 1e-9 * np.abs(values).max(initial=0.0), centred, 0.0))


def _signed_ranks(values: FloatArray) -> FloatArray:
    """Midranks of the sizes with the signs of the values, 0 for 0: turning A and B round turns the sign
    alone."""
    _, place, count = np.unique(np.abs(values), return_inverse=True, return_counts=True)
    midrank = np.cumsum(count) - (count - 1) / 2
    return np.asarray(np.sign(values) * midrank[place])


def _association(
    pair: tuple[str, str], own: Products, mode_share: float, alone: float, in_list: float
) -> Association:
    correlation, low, high = _correlation(own)
    is_tested = not isnan(correlation)
    return Association(
        *pair,
        int(own.comparisons.sum()),
        int((own.comparisons > 0).sum()),
        correlation,
        low,
        high,
        mode_share,
        float(alone) if is_tested else nan,
        float(in_list) if is_tested else nan,
    )


def _correlation(own: Products) -> tuple[float, float, float]:
    """Correlation within people and its interval: Fisher's z, people left out one by one, Student's t."""
    crossed, metric, answer = own.crossed, own.metric, own.answer
    size = sqrt(metric.sum() * answer.sum())
    if size == 0:
        return nan, nan, nan
    correlation = float(crossed.sum()) / size
    took_part = (metric > 0) | (answer > 0)
    n = int(took_part.sum())
    left = np.sqrt((metric.sum() - metric[took_part]) * (answer.sum() - answer[took_part]))
    if n < FEWEST_PEOPLE or left.min() <= 1e-9 * size:
        return correlation, nan, nan
    without = (crossed.sum() - crossed[took_part]) / left
    if max(np.abs(without).max(), abs(correlation)) >= 1 - 1e-12:
        return correlation, nan, nan
    z = np.arctanh(without)
    se = sqrt((n - 1) / n * ((z - z.mean()) ** 2).sum())
    half = float(stdtrit(n - 1, (1 + HDI_PROBABILITY) / 2)) * se
    middle = float(np.arctanh(correlation))
    return correlation, float(np.tanh(middle - half)), float(np.tanh(middle + half))


def _mode_share(laps: Laps, is_own: NDArray[np.bool_], metric: str) -> float:
    """Least squares of the differences on the two modes; NaN where no laps differ."""
    difference = laps.difference[:, laps.metrics.index(metric)]
    measured = is_own & ~np.isnan(difference)
    a, b, d = laps.mode_a[measured], laps.mode_b[measured], difference[measured]
    total = float((d**2).sum())
    if total == 0:
        return nan
    n_modes = int(max(a.max(), b.max())) + 1
    met = np.bincount(a * n_modes + b, minlength=n_modes**2).reshape(n_modes, n_modes)
    met = met + met.T
    lead = np.bincount(a, d, n_modes) - np.bincount(b, d, n_modes)
    of_modes = np.linalg.pinv(np.diag(met.sum(axis=1)) - met, hermitian=True) @ lead
    return min(1.0, float(lead @ of_modes) / total)
