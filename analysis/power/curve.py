"""A smooth curve through the shares of right conclusions, and where it reaches what is wanted."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr, ndtri

from analysis.results import HDI_PROBABILITY

FARTHEST = 4
"""How many times the largest size that was tried a sufficient number is looked for."""
_FARTHEST_Z = 5.0
"""Beyond, a share is 0 or 1 to six digits, and tells nothing of the curve."""


@dataclass(frozen=True)
class Enough:
    """The fewest participants with which the wanted share is reached.

    Attributes
    ----------
    low, high : int or None
        94 % interval, from the replicates' uncertainty; None: open upwards.
    """

    participants: int
    low: int
    high: int | None

    @property
    def interval(self) -> str:
        """The interval in brackets."""
        return f"[{self.low}, {self.high}]" if self.high is not None else f"[{self.low} or more]"


@dataclass(frozen=True)
class Curve:
    """The share of right conclusions as ``Phi(intercept + slope sqrt(participants))``.

    A lead is known with an error that falls with the square root of the number of people, and concluded where
    it is some errors above zero; so the probit of the share is a straight line over that root.

    Attributes
    ----------
    covariance : ndarray, shape (2, 2)
        Of intercept and slope; larger where the points scatter more about the curve than counts do.
    largest : int
        The largest size that was tried.
    """

    intercept: float
    slope: float
    covariance: NDArray[np.float64]
    largest: int

    def share(self, participants: ArrayLike) -> NDArray[np.float64]:
        """Share of right conclusions with so many participants."""
        return np.asarray(ndtr(self._line(participants)))

    def band(self, participants: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """94 % interval of the share at each number of participants."""
        x = _design(participants)
        error = np.sqrt(np.einsum("...i,ij,...j->...", x, self.covariance, x))
        reach = ndtri(0.5 + HDI_PROBABILITY / 2) * error
        line = self._line(participants)
        return np.asarray(ndtr(line - reach)), np.asarray(ndtr(line + reach))

    def enough(self, wanted: float) -> Enough | None:
        """The fewest participants with the wanted share; None if they are far beyond the sizes tried.

        The interval ends where the band's upper and lower edge reach the wanted share (Fieller 1954).
        """
        sizes = np.arange(1, FARTHEST * self.largest + 1)
        low, high = self.band(sizes)
        reached = [_first(sizes, edge >= wanted) for edge in (high, self.share(sizes), low)]
        if reached[1] is None or reached[0] is None:
            return None
        return Enough(reached[1], reached[0], reached[2])

    def _line(self, participants: ArrayLike) -> NDArray[np.float64]:
        return _design(participants) @ np.array([self.intercept, self.slope])


def fitted_curve(
    participants: Sequence[int], right: Sequence[int], replicates: Sequence[int]
) -> Curve | None:
    """The most likely curve through counts of right conclusions.

    Half a study is added to either side of each count, so that shares of 0 and 1 leave it finite. None if
    there are fewer than two sizes.
    """
    if len(set(participants)) < 2:
        return None
    x = _design(participants)
    n = np.asarray(replicates, dtype=float) + 1.0
    y = np.asarray(right, dtype=float) + 0.5
    start = np.linalg.lstsq(x, ndtri(y / n), rcond=None)[0]
    at = minimize(lambda b: -(y @ log_ndtr(x @ b) + (n - y) @ log_ndtr(-(x @ b))), start).x
    line = np.clip(x @ at, -_FARTHEST_Z, _FARTHEST_Z)
    share, slope = ndtr(line), np.exp(-0.5 * line**2) / np.sqrt(2 * np.pi)
    variance = share * (1.0 - share)
    information = x.T @ ((n * slope**2 / variance)[:, None] * x)
    pearson = float(((y - n * share) ** 2 / (n * variance)).sum())
    scatter = max(1.0, pearson / max(len(x) - 2, 1))
    return Curve(float(at[0]), float(at[1]), scatter * np.linalg.inv(information), max(participants))


def _design(participants: ArrayLike) -> NDArray[np.float64]:
    root = np.sqrt(np.asarray(participants, dtype=float))
    return np.stack([np.ones_like(root), root], axis=-1)


def _first(sizes: NDArray[np.int64], is_reached: NDArray[np.bool_]) -> int | None:
    return int(sizes[is_reached.argmax()]) if is_reached.any() else None
