"""Simulated raters: how a simulated participant answers from what it experienced.

A rater knows the trial metrics of its own laps under A and under B, and nothing else: neither the
modes nor their parameters. Two physical magnitudes are compared as a person would, by their ratio in
units of the smallest ratio that people notice (Weber's law), and the result is blurred by noise. What a
question weighs stands in the study file (``rehearsal``); how much it matters to this person, and what
this person likes besides, is the person's taste. Ties, strong preferences and disagreement follow.

All numbers here were chosen so that ties, strong preferences and disagreement all occur, and are not
fitted to people: for demonstration and rehearsal, no answer of a rater is evidence.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from data.answers import Answer
from data.errors import one_of
from data.study import Question, Study

WEBER_FRACTION = 0.4
"""Ratio of two magnitudes, as a log, that counts as one unit of felt difference.

People tell forces apart from about 7-10 % on (Jones 1989) when they attend to nothing else. With
that, simulated people would never disagree: the modes differ by far more. Chosen so that they do.
"""
STUCK_UNIT = 0.5
"""Difference in the share of laps that ended stuck that counts as one unit. Untuned."""
LONGEST_REACH = 3.0
"""Felt differences saturate here: twice as bad as very bad feels the same. Untuned."""
STUCK_SHARE = "stuck_share"


@dataclass(frozen=True)
class Experience:
    """What one participant experienced under one condition of a comparison.

    Attributes
    ----------
    metrics : mapping
        Mean of each trial metric over the laps in which it is known.
    stuck_share : float
        Share of the laps in which the robot got stuck.
    """

    metrics: Mapping[str, float]
    stuck_share: float


@dataclass(frozen=True)
class Rater:
    """One simulated person's way of answering.

    Attributes
    ----------
    attention : mapping
        Factor on each metric's weight, 1 for the average person.
    taste : mapping
        What this person likes beyond the question, a weight per metric.
    side_bias : float
        Leaning towards A, in units of the answer scale.
    tie_below, much_above : float
        Where this person stops saying "the same" and starts saying "much".
    """

    attention: Mapping[str, float]
    taste: Mapping[str, float]
    side_bias: float
    tie_below: float
    much_above: float


def experience(laps: Sequence[Mapping[str, float]], stuck: Sequence[bool]) -> Experience:
    """Condense the laps under one condition into what is remembered of them.

    Parameters
    ----------
    laps : sequence of mapping
        Metrics of each lap; a metric that a lap doesn't have, or has as NaN, is left out of its mean.
    stuck : sequence of bool
        Whether each lap ended stuck.
    """
    names = sorted({name for lap in laps for name in lap})
    metrics = {}
    for name in names:
        known = [lap[name] for lap in laps if name in lap and np.isfinite(lap[name])]
        if known:
            metrics[name] = float(np.mean(known))
    return Experience(metrics, float(np.mean(stuck)) if stuck else 0.0)


def draw_rater(study: Study, rng: np.random.Generator) -> Rater:
    """A person with tastes of their own, for the metrics that the study's questions weigh."""
    metrics = sorted({metric for question in study.questions for metric in question.rehearsal})
    attention = {m: float(rng.lognormal(0.0, 0.4)) for m in metrics}
    taste = {m: float(rng.normal(0.0, 0.15)) for m in metrics}
    tie_below = float(rng.lognormal(np.log(0.45), 0.35))
    return Rater(
        attention=attention,
        taste=taste,
        side_bias=float(rng.normal(0.0, 0.1)),
        tie_below=tie_below,
        much_above=tie_below + float(rng.lognormal(np.log(1.2), 0.3)),
    )


def felt_difference(a: Experience, b: Experience, metric: str) -> float:
    """How much more of a metric was felt under A than under B, in units people notice.

    0 if either side did not get to experience it (a lap that never reached the exit has no exit force).
    """
    if metric == STUCK_SHARE:
        raw = (a.stuck_share - b.stuck_share) / STUCK_UNIT
    else:
        magnitude_a, magnitude_b = a.metrics.get(metric, 0.0), b.metrics.get(metric, 0.0)
        if magnitude_a <= 0.0 or magnitude_b <= 0.0:
            return 0.0
        raw = float(np.log(magnitude_a / magnitude_b)) / WEBER_FRACTION
    return LONGEST_REACH * float(np.tanh(raw / LONGEST_REACH))


def answer(
    question: Question, rater: Rater, a: Experience, b: Experience, rng: np.random.Generator
) -> Answer:
    """This person's answer to one question after one comparison.

    The leaning towards A is the weighted sum of felt differences plus taste, side bias and logistic
    noise of scale 0.6, cut into the levels of the question's scale by the person's own thresholds.
    """
    leaning = rater.side_bias + float(rng.logistic(0.0, 0.6))
    for metric, taste in rater.taste.items():
        weight = question.rehearsal.get(metric, 0.0) * rater.attention[metric] + taste
        leaning += weight * felt_difference(a, b, metric)
    if question.levels > 2 and abs(leaning) < rater.tie_below:
        return "A=B"
    if question.levels == 5 and abs(leaning) > rater.much_above:
        return "A>>B" if leaning > 0 else "B>>A"
    return "A>B" if leaning > 0 else "B>A"


def check_rehearsal(study: Study, metrics: Sequence[str]) -> None:
    """Refuse a study whose questions weigh a metric that trials don't have.

    Raises
    ------
    InputError
        One line that lists the metrics.
    """
    valid = [*metrics, STUCK_SHARE]
    for number, question in enumerate(study.questions, start=1):
        for metric in question.rehearsal:
            if metric not in valid:
                raise one_of(f"questions.{number}.rehearsal", metric, valid)
