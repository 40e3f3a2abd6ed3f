"""What a calibration found: every replicate's ranks, and the checks they must pass."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from analysis.calibration.uniformity import Coverage, IntArray, Uniformity, coverages, uniformities
from analysis.calibration.world import Design
from analysis.model import Model
from analysis.results import FitSettings


@dataclass(frozen=True)
class Ranked:
    """One quantity of one replicate.

    Attributes
    ----------
    truth : float
    mean, sd : float
        Of the posterior.
    rank : int
        How many of `DRAWS_RANKED` draws lie below the truth.
    """

    parameter: str
    truth: float
    mean: float
    sd: float
    rank: int


@dataclass(frozen=True)
class Replicate:
    """One simulated study, fitted."""

    number: int
    converged: bool
    rhat_max: float
    ess_min: float
    divergences: int
    ranked: tuple[Ranked, ...]


@dataclass(frozen=True)
class Calibration:
    """What came of all replicates.

    The verdict rests on the replicates whose sampling converged, since a report is silent about the others.
    Leaving those out favours nobody: the gate sees the answers and the chains and never the true values, and
    whatever the answers, the truth is a draw from their posterior.

    Attributes
    ----------
    model : Model
        What the truths are drawn from.
    settings : FitSettings
        What the answers are fitted with.
    """

    model: Model
    design: Design
    settings: FitSettings
    seed: int
    replicates: tuple[Replicate, ...]

    @property
    def converged(self) -> tuple[Replicate, ...]:
        """The replicates that a report would rank."""
        return tuple(r for r in self.replicates if r.converged)

    @property
    def failures(self) -> int:
        """Replicates whose sampling did not converge, with all the draws it may take."""
        return len(self.replicates) - len(self.converged)

    @cached_property
    def ranks(self) -> dict[str, IntArray]:
        """Ranks by quantity over the replicates that converged."""
        return _ranks(self.converged)

    @cached_property
    def coverages(self) -> tuple[Coverage, ...]:
        """Every quantity's coverage at every level."""
        return coverages(self.ranks)

    @cached_property
    def uniformities(self) -> tuple[Uniformity, ...]:
        """Every quantity's ECDF against its band."""
        return uniformities(self.ranks)

    @cached_property
    def outside_with_failures(self) -> int:
        """Checks that fail if the replicates without convergence are counted too."""
        if not self.failures:
            return len(self.outside)
        everything = _ranks(self.replicates)
        checks: tuple[Coverage | Uniformity, ...] = (*coverages(everything), *uniformities(everything))
        return sum(not check.inside for check in checks)

    @property
    def outside(self) -> tuple[Coverage | Uniformity, ...]:
        """The checks that fail."""
        checks: tuple[Coverage | Uniformity, ...] = (*self.coverages, *self.uniformities)
        return tuple(check for check in checks if not check.inside)

    @property
    def is_calibrated(self) -> bool:
        """True if no check fails."""
        return not self.outside

    @property
    def table(self) -> pd.DataFrame:
        """One row a replicate and quantity, those without convergence included and marked."""
        return pd.DataFrame(
            [
                {"replicate": r.number, **vars(ranked), "converged": r.converged}
                for r in self.replicates
                for ranked in r.ranked
            ]
        )


def _ranks(replicates: Sequence[Replicate]) -> dict[str, IntArray]:
    names = [ranked.parameter for ranked in replicates[0].ranked]
    table = np.array([[ranked.rank for ranked in r.ranked] for r in replicates], dtype=np.int64)
    return dict(zip(names, table.T, strict=True))
