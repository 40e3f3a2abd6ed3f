"""A one-dimensional distribution as a table of its distribution function."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import minimize_scalar

from analysis.results import HDI_PROBABILITY

FloatArray = NDArray[np.float64]

_STARTS = 1201
"""Lower ends that are tried for the shortest interval before the best one is refined."""
_FLAT = 1e-12
"""Rises of the distribution function from point to point below which its inverse is too steep to follow."""
_EQUALLY_LIKELY = (np.arange(4000) + 0.5) / 4000


@dataclass(frozen=True)
class Tabulated:
    """A distribution on the line, given by its distribution function at sorted values.

    Attributes
    ----------
    values : ndarray, shape (points,)
        Strictly increasing.
    cdf : ndarray, shape (points,)
        Probability of at most each value, from 0 to 1, never decreasing.
    mean, sd : float
        Integrals that are more exact than the table.
    """

    values: FloatArray
    cdf: FloatArray
    mean: float
    sd: float

    def quantile(self, probability: FloatArray) -> FloatArray:
        """The values that these probabilities lie below."""
        rises = np.concatenate([[True], np.diff(self.cdf) > 0])
        return np.asarray(np.interp(probability, self.cdf[rises], self.values[rises]))

    def below(self, value: FloatArray) -> FloatArray:
        """Probability of at most each value."""
        return np.asarray(np.interp(value, self.values, self.cdf, left=0.0, right=1.0))

    def p_above(self, other: "Tabulated") -> float:
        """Probability that a draw of this one is higher than an independent draw of the other."""
        return float(other.below(self.quantile(_EQUALLY_LIKELY)).mean())

    def hdi(self, probability: float = HDI_PROBABILITY) -> tuple[float, float]:
        """Ends of the shortest interval with this probability, on the scale of ``values``."""

        rises = np.concatenate([[True], np.diff(self.cdf) > _FLAT])
        # Its slope is continuous: the ends are where the slopes at both are the same.
        quantile = PchipInterpolator(self.cdf[rises], self.values[rises])

        def width(start: FloatArray) -> FloatArray:
            return np.asarray(quantile(np.minimum(start + probability, last)) - quantile(start))

        last = float(self.cdf[rises][-1])
        starts = np.linspace(0.0, last - probability, _STARTS)
        best, step = starts[int(width(starts).argmin())], starts[1]
        refined = minimize_scalar(
            lambda start: float(width(np.array([start]))[0]),
            bounds=(max(0.0, best - step), min(starts[-1], best + step)),
            method="bounded",
            options={"xatol": 1e-9},
        ).x
        start = float(min((best, refined), key=lambda at: float(width(np.array([at]))[0])))
        low, high = quantile(start), quantile(min(start + probability, last))
        return float(low), float(high)
