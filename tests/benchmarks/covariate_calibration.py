"""Does the interval of a slope of worth on a metric hold what it says, and what do equal modes claim?

    python tests/benchmarks/covariate_calibration.py --modes 4 --people 7 --sets 400

Slope and residual are drawn from their priors, abilities from these, answers from the abilities; the report's
model is fitted and the slope read from it. Prints the coverage of the 94 % interval, the standardised errors
of the slope, and how often the sign that is named is wrong.
With ``--equal`` all abilities are 0: prints how many sets name a slope at all among ``--metrics`` metrics.
"""

import argparse
from dataclasses import replace

import numpy as np

from analysis.calibration import Design, world_of
from analysis.calibration.world import Truth, draw_answers, draw_truth
from analysis.covariates import RESIDUAL_SD_SCALE, SLOPE_SD, CovariateEffect, slopes_of
from analysis.fit import fit
from analysis.results import FitSettings
from analysis.summaries import draws_in_order

SETTINGS = FitSettings(draws=500, tune=500, chains=2)
LEVELS = 5


def one_set(
    rng: np.random.Generator, design: Design, metrics: int, is_equal: bool
) -> tuple[float, tuple[CovariateEffect, ...]]:
    """A true slope on the first of some metrics, and what the report's model makes of the answers."""
    x = rng.normal(size=(metrics, design.n_modes))
    x -= x.mean(axis=1, keepdims=True)
    x /= x.std(axis=1, keepdims=True)
    world = world_of(SETTINGS, LEVELS)
    slope, ability = 0.0, np.zeros(design.n_modes)
    if not is_equal:
        slope, residual = SLOPE_SD * rng.normal(), RESIDUAL_SD_SCALE * abs(rng.normal())
        own = rng.normal(size=design.n_modes)
        ability = slope * x[0] + residual * (own - own.mean())
    truth = Truth(ability, draw_truth(world, design.n_modes, rng).parameters)
    table = draw_answers(world, truth, design, rng)
    fitted = fit(table, replace(SETTINGS, seed=int(rng.integers(2**31))))
    draws = fitted.questions[0].draws
    assert draws is not None
    draws = draws_in_order(draws, [fitted.modes.index(mode) for mode in design.modes])
    values = {f"metric {k}": (own, 1.0) for k, own in enumerate(x)}
    return slope, slopes_of({"Q": draws}, {"Q": values}, SETTINGS.prior_sd)


def main() -> None:
    """Read the command line, simulate, print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name, value in (("modes", 4), ("people", 7), ("sets", 400), ("metrics", 1), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--equal", action="store_true")
    wish = parser.parse_args()
    design = Design(wish.people, 2, wish.modes)
    print(f"{wish.people} people, {wish.modes} modes, {wish.sets} sets, {wish.metrics} metrics")
    inside, named, wrong, places = 0, 0, 0, []
    for number in range(wish.sets):
        rng = np.random.default_rng([wish.seed, number])
        slope, effects = one_set(rng, design, wish.metrics, wish.equal)
        first = effects[0]
        inside += first.slope_hdi_low <= slope <= first.slope_hdi_high
        places.append((slope - first.slope_mean) / first.slope_sd)
        if wish.equal:
            named += any(e.is_clear for e in effects)
        elif first.is_clear:
            named += 1
            wrong += (first.slope_mean > 0) != (slope > 0)
    error = np.sqrt(0.94 * 0.06 / wish.sets)
    print(f"94 % interval holds the slope in {inside / wish.sets:.3f} (Monte Carlo error {error:.3f})")
    if wish.equal:
        print(f"sets with a slope told apart from 0: {named / wish.sets:.3f}")
        return
    print(f"standardised errors: mean {np.mean(places):+.3f}, sd {np.std(places):.3f}")
    print(f"slopes told apart from 0: {named}, of the wrong sign: {wrong}")


if __name__ == "__main__":
    main()
