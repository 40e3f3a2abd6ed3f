"""Are stuck rates in people in general as good as the report says? Two simulations of many studies.

Calibration: true rates and spreads from the priors, events from the model, and the place of each true value
in its posterior. Then intervals must hold the truth as often as they say (Talts et al. 2018), and of claims
that one mode's rate is higher as many must be right as their chances say.

Equality: two modes that get people stuck equally often, with people who differ, each in a way of their own
under either mode. How often is a difference found at a level of 5 %?

    python tests/benchmarks/stuck_calibration.py --people 7 --comparisons 4 --replicates 1000

Exits with 1 if a coverage or an ECDF lies outside its band, or a test by people errs too often.
"""

import argparse
import sys
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.polynomial.hermite_e import hermegauss
from scipy.stats import binom

from analysis.calibration.uniformity import DRAWS_RANKED, FALSE_ALARM, coverages, uniformities
from analysis.event_likelihood import FloatArray
from analysis.event_rate import (
    LOG_RATE_SD,
    MEDIAN_RATE,
    SPREAD_SCALE,
    RatePosterior,
    exposures,
    rate_over_people,
)
from analysis.results import HDI_PROBABILITY
from analysis.stuck import stuck_rates
from analysis.stuck_contrasts import stuck_contrasts
from data.responses import StuckTable

CLAIMED = 0.95
LEVEL = 0.05


@dataclass(frozen=True)
class Mode:
    """One simulated mode: the median person's log rate [1/min], the spread, and what happened.

    Attributes
    ----------
    rows : DataFrame
        As of a `StuckTable`.
    """

    log_rate: float
    spread: float
    rows: pd.DataFrame

    def share(self, minutes: float) -> float:
        """Share of a new person's comparisons of this length with an event, by Gauss-Hermite quadrature."""
        z, weight = hermegauss(80)
        rate = np.exp(self.log_rate + self.spread * z)
        return float(-np.expm1(-rate * minutes) @ (weight / weight.sum()))


def simulated(
    name: str, log_rate: float, spread: float, own: FloatArray, comparisons: int, rng: np.random.Generator
) -> Mode:
    """What happened to people with these own deviations; comparisons are about two minutes long."""
    person = np.repeat(np.arange(len(own)), comparisons)
    minutes = rng.lognormal(np.log(1.9), 0.3, len(person))
    rate = np.exp(log_rate + spread * own)[person]
    # The first event of a Poisson process comes after an exponential time.
    has_event = rng.exponential(1.0, len(person)) < rate * minutes
    rows = pd.DataFrame(
        {
            "participant": [f"p{k}" for k in person],
            "comparison": [f"c{k}" for k in range(len(person))],
            "mode": name,
            "stuck": has_event,
            "exposure_s": 60.0 * minutes,
        }
    )
    return Mode(log_rate, spread, rows)


def from_prior(name: str, people: int, comparisons: int, rng: np.random.Generator) -> Mode:
    """A mode whose rate and spread come from the priors."""
    log_rate = np.log(MEDIAN_RATE) + LOG_RATE_SD * rng.normal()
    spread = abs(SPREAD_SCALE * rng.normal())
    return simulated(name, float(log_rate), float(spread), rng.normal(size=people), comparisons, rng)


def spread_below(posterior: RatePosterior, spread: float) -> float:
    """Posterior probability of at most this spread, from the middles of cells."""
    weight = np.exp(posterior.log_density - posterior.log_density.max()).sum(axis=0)
    half = (posterior.spread[1] - posterior.spread[0]) / 2
    edges = np.concatenate([posterior.spread - half, [posterior.spread[-1] + half]])
    return float(np.interp(spread, edges, np.concatenate([[0.0], np.cumsum(weight)]) / weight.sum()))


def calibration(people: int, comparisons: int, replicates: int, seed: int) -> bool:
    """Print coverages, ECDFs and how many claims are right; True if all is inside."""
    places: dict[str, list[float]] = {"rate": [], "spread": [], "share": []}
    held: dict[str, list[bool]] = {"rate": [], "share": []}
    chances, right = [], []
    for k in range(replicates):
        rng = np.random.default_rng([seed, k])
        pair = []
        for name in ("i", "j"):
            mode = from_prior(name, people, comparisons, rng)
            rows = mode.rows
            data, usual = exposures(
                rows["participant"].to_numpy(object),
                rows["stuck"].to_numpy(bool),
                rows["exposure_s"].to_numpy() / 60.0,
            )
            posterior = rate_over_people(data)
            rate, share, truth = posterior.rate(), posterior.share(usual), mode.share(usual)
            pair.append((share, truth))
            if name == "j":
                continue
            places["rate"].append(float(rate.below(np.array(np.exp(mode.log_rate)))))
            places["share"].append(float(share.below(np.array(truth))))
            places["spread"].append(spread_below(posterior, mode.spread))
            for what, distribution, value in (("rate", rate, np.exp(mode.log_rate)), ("share", share, truth)):
                low, high = distribution.hdi()
                held[what].append(bool(low <= value <= high))
        chance = pair[0][0].p_above(pair[1][0])
        is_above = pair[0][1] > pair[1][1]
        chances.append(max(chance, 1 - chance))
        right.append(is_above == (chance > 0.5))
    ranks = {
        name: np.minimum(np.floor((DRAWS_RANKED + 1) * np.array(values)), DRAWS_RANKED).astype(np.int64)
        for name, values in places.items()
    }
    is_fine = True
    for c in coverages(ranks):
        is_fine &= c.inside
        print(
            f"{c.parameter:7} {100 * c.level:.0f} % central: {100 * c.coverage:.1f} % "
            f"(band {100 * c.band_low:.1f}-{100 * c.band_high:.1f}){'' if c.inside else ' OUTSIDE'}"
        )
    for u in uniformities(ranks):
        is_fine &= u.inside
        print(f"{u.parameter:7} ECDF p {u.p_value:.2g} (limit {u.limit:.2g}){'' if u.inside else ' OUTSIDE'}")
    for what, values in held.items():
        low, high = band(HDI_PROBABILITY, replicates, len(held))
        share = float(np.mean(values))
        is_fine &= low <= share <= high
        print(f"{what:7} 94 % HDI as printed: {100 * share:.1f} % (band {100 * low:.1f}-{100 * high:.1f})")
    for least in (0.5, 0.8, CLAIMED):
        claimed = np.array(chances) >= least
        true, stated = (100 * np.mean(np.array(values)[claimed]) for values in (right, chances))
        print(
            f"claims with a chance of at least {least:g}: {claimed.sum()}, right {true:.1f} %, "
            f"stated {stated:.1f} %"
        )
    return is_fine


def band(share: float, n: int, checks: int) -> tuple[float, float]:
    """Where a share of ``n`` lies, but for a part of `FALSE_ALARM`."""
    tail = FALSE_ALARM / checks / 2
    return float(binom.ppf(tail, n, share)) / n, float(binom.isf(tail, n, share)) / n


def equality(people: int, comparisons: int, replicates: int, seed: int) -> bool:
    """Print how often a difference is found without one; True if the test by people keeps its level."""
    is_fine = True
    most = float(binom.isf(FALSE_ALARM / 6, replicates, LEVEL)) / replicates
    print(f"two modes alike in people in general: a difference found at 5 % [%] (at most {100 * most:.1f})")
    print("share  spread  these: Fisher  within people  chance   people: by people  chance")
    for log_rate, spread in ((np.log(0.1), 0.0), (np.log(0.1), 1.0), (np.log(0.1), 2.0)):
        found = np.zeros(5)
        for k in range(replicates):
            rng = np.random.default_rng([seed, k, int(spread)])
            modes = [
                simulated(name, log_rate, spread, rng.normal(size=people), comparisons, rng) for name in "ij"
            ]
            table = StuckTable(pd.concat([mode.rows for mode in modes], ignore_index=True))
            (c,) = stuck_contrasts(table, stuck_rates(table))
            sure = [max(p, 1 - p) >= 1 - LEVEL / 2 for p in (c.p_i_above_j, c.p_i_above_j_people)]
            found += [
                c.p_fisher <= LEVEL, c.p_within_people <= LEVEL, sure[0], c.p_by_people <= LEVEL, sure[1],
            ]  # fmt: skip
        fisher, within, chance, by_people, chance_people = 100 * found / replicates
        is_fine &= by_people <= 100 * most
        print(
            f"{modes[0].share(1.9):5.2f} {spread:7.1f} {fisher:14.1f} {within:14.1f} {chance:7.1f} "
            f"{by_people:19.1f} {chance_people:7.1f}"
        )
    return is_fine


def main() -> int:
    """Both simulations of one design."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, default=7)
    parser.add_argument("--comparisons", type=int, default=4, help="of each person with a mode")
    parser.add_argument("--replicates", type=int, default=1000, help="of the calibration")
    parser.add_argument("--equal", type=int, default=1000, help="replicates of each row of the equality")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    is_fine = calibration(asked.people, asked.comparisons, asked.replicates, asked.seed)
    return 0 if equality(asked.people, asked.comparisons, asked.equal, asked.seed) and is_fine else 1


if __name__ == "__main__":
    sys.exit(main())
