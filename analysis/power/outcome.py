"""What came of the simulated studies: counts with their Monte-Carlo intervals, size by size."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd
from scipy.special import betaincinv

from analysis.power.curve import Curve, fitted_curve
from analysis.power.plan import Plan
from analysis.power.scenario import Verdict
from analysis.results import HDI_PROBABILITY


@dataclass(frozen=True)
class PowerPoint:
    """What came of the simulated studies of one size.

    Attributes
    ----------
    repetitions, participants, answers : int
        How often a person sees each pair; people; answers of all of them to one question.
    right, wrong, open, unranked : int
        Studies that concluded what was planted, that concluded something else, that left it open, and whose
        sampling did not converge; together ``replicates``.
    right_share, right_low, right_high : float
        Share of right conclusions, with the equal-tailed 94 % interval of a Beta(1, 1) posterior: what the
        number of replicates leaves uncertain.
    wrong_share, wrong_low, wrong_high : float
        Likewise of wrong ones.
    """

    repetitions: int
    participants: int
    answers: int
    replicates: int
    right: int
    wrong: int
    open: int
    unranked: int
    right_share: float
    right_low: float
    right_high: float
    wrong_share: float
    wrong_low: float
    wrong_high: float

    @classmethod
    def of(cls, repetitions: int, participants: int, answers: int, found: Sequence[Verdict]) -> "PowerPoint":
        """Count the verdicts on the studies of one size."""
        count, n = Counter(found), len(found)
        shares = [
            x for verdict in ("right", "wrong") for x in (count[verdict] / n, *_interval(count[verdict], n))
        ]
        verdicts = (count["right"], count["wrong"], count["open"], count["unranked"])
        return cls(repetitions, participants, answers, n, *verdicts, *shares)


@dataclass(frozen=True)
class Power:
    """The points of all sizes, and the plan they belong to."""

    plan: Plan
    points: tuple[PowerPoint, ...]

    @property
    def table(self) -> pd.DataFrame:
        """One row a size."""
        return pd.DataFrame([vars(point) for point in self.points])

    @property
    def repetitions(self) -> tuple[int, ...]:
        """The numbers of repetitions that were tried."""
        return tuple(dict.fromkeys(point.repetitions for point in self.points))

    def of(self, repetitions: int) -> tuple[PowerPoint, ...]:
        """The points with so many repetitions, by participants."""
        return tuple(point for point in self.points if point.repetitions == repetitions)

    def curve(self, repetitions: int) -> Curve | None:
        """The smooth curve through the points with so many repetitions; None through a single one."""
        points = self.of(repetitions)
        return fitted_curve(
            [p.participants for p in points], [p.right for p in points], [p.replicates for p in points]
        )


def _interval(count: int, n: int) -> tuple[float, float]:
    tail = (1.0 - HDI_PROBABILITY) / 2.0
    low, high = betaincinv(count + 1, n - count + 1, [tail, 1.0 - tail])
    return float(low), float(high)
