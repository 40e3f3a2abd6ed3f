"""Importance weights with their largest smoothed, and how far they can be trusted.

References
----------
Vehtari, Simpson, Gelman, Yao, Gabry 2024, "Pareto smoothed importance sampling" (limit on k).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

FloatArray = NDArray[np.float64]

TRUSTED_BELOW = 0.7
"""Largest k-hat with which a weighted mean is reported (Vehtari et al. 2024, section 3.2.4)."""
_ALIKE = 1e-12
"""Ratios that differ by less are taken as equal: there is no tail then."""


@dataclass(frozen=True)
class Weights:
    """Smoothed weights of draws.

    Attributes
    ----------
    log : ndarray, shape (draw,)
        Logarithms; the weights add up to 1.
    k : float
        Shape of the generalised Pareto distribution that fits the largest ratios: above 0.7 a few draws
        decide; infinite if the ratios have no tail to fit.
    """

    log: FloatArray
    k: float

    @property
    def effective(self) -> float:
        """How many equally weighted draws the weights are worth."""
        return float(np.exp(-logsumexp(2 * self.log)))

    @property
    def trusted(self) -> bool:
        """Whether k-hat allows a mean."""
        return self.k <= TRUSTED_BELOW


def smoothed(log_ratios: FloatArray) -> Weights:
    """Weights from importance ratios, the largest put in order by the distribution that fits them.

    Parameters
    ----------
    log_ratios : ndarray, shape (draw,)
        Target over proposal, up to a constant.
    """
    if np.ptp(log_ratios) < _ALIKE:
        return Weights(np.full_like(log_ratios, -np.log(len(log_ratios))), -np.inf)
    import arviz as az

    log, k = az.psislw(log_ratios)
    return Weights(np.asarray(log), float(k))
