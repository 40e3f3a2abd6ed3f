"""How often the robot got stuck under each mode, per comparison and per minute."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from scipy.optimize import minimize_scalar
from scipy.special import betaincinv

from analysis.event_rate import exposures, rate_of_comparisons, rate_over_people
from analysis.results import HDI_PROBABILITY, Quantity
from analysis.tabulated import Tabulated
from data.responses import StuckTable


@dataclass(frozen=True)
class StuckRate:
    """Stuck events of one mode: of these people and comparisons, and of people in general.

    Attributes
    ----------
    comparisons : int
        Comparisons that contain the mode.
    stuck : int
        Those of them in which the robot got stuck at least once under this mode.
    participants, participants_stuck : int
        Those who had such comparisons, and those of them with whom the robot got stuck; 0 if participants
        are not known.
    rate_mean, rate_hdi_low, rate_hdi_high : float
        Share of comparisons: Beta(1, 1) prior, 94 % HDI. Comparisons are taken as independent, so it speaks
        of these people and comparisons.
    exposure_min : float
        Known time under the mode [min].
    per_minute : Quantity or None
        Rate of getting stuck [1/min] if all people have the same one, `event_rate.rate_of_comparisons`: it
        speaks of these people and comparisons. None without exposure.
    between : Quantity or None
        Share of a new person's comparisons of the usual length (the median of this mode's), from
        `event_rate.rate_over_people`: it speaks of people in general. None if participants are not known.
    per_minute_between : Quantity or None
        Rate of the median person [1/min], from the same posterior. None without exposure, too.
    share_of_people : Tabulated or None
        The distribution that ``between`` sums up.
    """

    mode: str
    comparisons: int
    stuck: int
    participants: int
    participants_stuck: int
    rate_mean: float
    rate_hdi_low: float
    rate_hdi_high: float
    exposure_min: float = 0.0
    per_minute: Quantity | None = None
    between: Quantity | None = None
    per_minute_between: Quantity | None = None
    share_of_people: Tabulated | None = field(default=None, repr=False, compare=False)


def stuck_rates(table: StuckTable, modes: tuple[str, ...] | None = None) -> tuple[StuckRate, ...]:
    """Stuck rate of every mode, in the order of ``modes`` (by default sorted by name)."""
    rows = table.rows
    return tuple(
        _rate(mode, rows[rows["mode"] == mode]) for mode in modes or tuple(sorted(rows["mode"].unique()))
    )


def share_of_comparisons(stuck: int, comparisons: int) -> Quantity:
    """Posterior of the share of comparisons that get stuck, comparisons independent: Beta(1, 1) prior."""
    a, b = 1.0 + stuck, 1.0 + comparisons - stuck
    low, high = _shortest(lambda p: betaincinv(a, b, p), falls=stuck == 0, rises=stuck == comparisons)
    sd = np.sqrt(a * b / (a + b + 1)) / (a + b)
    return Quantity("stuck_share", a / (a + b), float(sd), low, high)


def _rate(mode: str, rows: pd.DataFrame) -> StuckRate:
    n, k = len(rows), int(rows["stuck"].sum())
    share = share_of_comparisons(k, n)
    by_person = rows.groupby("participant")["stuck"].any()
    are_known = n > 0 and "" not in by_person.index
    people, people_stuck = (len(by_person), int(by_person.sum())) if are_known else (0, 0)
    seconds = rows["exposure_s"].to_numpy(np.float64)
    minutes = float(seconds[seconds > 0].sum()) / 60.0
    per_minute = between = per_minute_between = of_people = None
    if n:
        data, usual = exposures(
            rows["participant"].to_numpy(object), rows["stuck"].to_numpy(bool), seconds / 60.0
        )
        if minutes:
            per_minute = _summary(f"stuck_per_minute_{mode}", rate_of_comparisons(data).rate())
        if are_known:
            posterior = rate_over_people(data)
            of_people = posterior.share(usual)
            between = _summary(f"stuck_rate_{mode}", of_people)
            if minutes:
                per_minute_between = _summary(f"stuck_per_minute_{mode}", posterior.rate())
    return StuckRate(
        mode=mode,
        comparisons=n,
        stuck=k,
        participants=people,
        participants_stuck=people_stuck,
        rate_mean=share.mean,
        rate_hdi_low=share.hdi_low,
        rate_hdi_high=share.hdi_high,
        exposure_min=minutes,
        per_minute=per_minute,
        between=between,
        per_minute_between=per_minute_between,
        share_of_people=of_people,
    )


def _summary(name: str, of: Tabulated) -> Quantity:
    return Quantity(name, of.mean, of.sd, *of.hdi())


def _shortest(quantile: Callable[[float], float], *, falls: bool, rises: bool) -> tuple[float, float]:
    """Ends of the 94 % HDI of a density with one peak, which may lie at an end."""
    if falls:
        return float(quantile(0.0)), float(quantile(HDI_PROBABILITY))
    if rises:
        return float(quantile(1.0 - HDI_PROBABILITY)), float(quantile(1.0))
    best = minimize_scalar(
        lambda p: quantile(p + HDI_PROBABILITY) - quantile(p),
        bounds=(0.0, 1.0 - HDI_PROBABILITY),
        method="bounded",
        options={"xatol": 1e-10},
    )
    return float(quantile(best.x)), float(quantile(best.x + HDI_PROBABILITY))
