"""What simulated people felt, as numbers: force, responsiveness and jerk by mode and phase."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd

PHASES = ("lap", "approach", "edge", "exit")
"""The whole lap first, then its phases (``sim_trials.maze.PHASES``)."""
ERRORS_APART = 2.0
"""Two modes differ where their mean paired difference is above so many of its standard errors."""


@dataclass(frozen=True)
class Measure:
    """A metric of a lap: its name by phase, what it is, and its unit."""

    name: str
    stem: str
    unit: str
    meaning: str

    def column(self, phase: str) -> str:
        """The metric's name in a phase (``sim_trials.metrics``)."""
        return "_".join(part for part in (self.stem, "" if phase == "lap" else phase, self.unit) if part)


FORCE = Measure("force", "force_mean", "n", "mean force of the hand [N]")
RESPONSIVENESS = Measure("responsiveness", "gain", "", "velocity along the command, over the command")
JERK = Measure("jerk", "jerk_rms", "m_s3", "jerk of the handle, low-passed [m/s³]")
MEASURES = (FORCE, RESPONSIVENESS, JERK)


def measured_table(metrics: pd.DataFrame) -> pd.DataFrame:
    """Means over people of each measure by phase and mode.

    Parameters
    ----------
    metrics : DataFrame
        One row per ``participant``, comparison and ``mode`` with a column a metric.

    Returns
    -------
    DataFrame
        ``measure, phase, mode, metric, mean, sd, people``: mean and standard deviation over people, each
        of them the mean over their comparisons; whoever never got to a phase is missing there.
    """
    rows = []
    for measure in MEASURES:
        for phase in PHASES:
            for mode, values in by_person(metrics, measure, phase).items():
                known = values.dropna()
                named = (measure.name, phase, mode, measure.column(phase))
                rows.append((*named, known.mean(), known.std(), len(known)))
    columns = ["measure", "phase", "mode", "metric", "mean", "sd", "people"]
    return pd.DataFrame(rows, columns=columns)


def rises(metrics: pd.DataFrame, measure: Measure, phase: str, order: Sequence[str]) -> bool:
    """Whether a measure rises from mode to mode in this order, the same people compared.

    By more than chance: see `ERRORS_APART`.
    """
    people = by_person(metrics, measure, phase)
    for lower, higher in pairwise(order):
        difference = (people[higher] - people[lower]).dropna().to_numpy(float)
        error = difference.std(ddof=1) / np.sqrt(len(difference)) if len(difference) > 1 else np.inf
        if not difference.mean() > ERRORS_APART * error:
            return False
    return True


def by_person(metrics: pd.DataFrame, measure: Measure, phase: str) -> pd.DataFrame:
    """Mean of a measure over each person's comparisons: a row a person, a column a mode."""
    return metrics.pivot_table(
        index="participant", columns="mode", values=measure.column(phase), aggfunc="mean"
    )
