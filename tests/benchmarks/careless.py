"""What careless answers do to intervals: python tests/benchmarks/careless.py [STUDIES [PROCESSES]]

Simulated studies of 20 people who compare every pair of three modes twice; none of their answers or 15 % are
random. Prints how many 94 % intervals of worths hold the true worth, of a fit without and of one with
a lapse, on the same studies.
"""

import sys
from dataclasses import dataclass, replace

import numpy as np
from joblib import Parallel, delayed

from analysis.calibration import Design, world_of
from analysis.calibration.world import draw_answers, draw_truth
from analysis.fit import fit
from analysis.results import FitSettings
from analysis.softmax import worth_of

DESIGN = Design(participants=20, repetitions=2, n_modes=3)
CARELESS = 0.15
LEVELS = 3
FITS = (FitSettings(), FitSettings(lapse=True))
ALL_OF_THEM = {"cut_1": 0.5, "subject_sd": 0.7, "side_effect": 0.1, "lapse": CARELESS}
"""What is assumed beside the abilities, which come from their prior [logit]."""


@dataclass(frozen=True)
class Held:
    """How many worths of one study their intervals hold, and how wide these are in the mean."""

    holds: tuple[bool, ...]
    width: float


def study(number: int, careless: float = CARELESS) -> tuple[Held | None, ...]:
    """One simulated study under each fit; None where it does not rank."""
    rng = np.random.default_rng([2026, number])
    world = world_of(FitSettings(lapse=True), LEVELS)
    truth = replace(draw_truth(world, DESIGN.n_modes, rng), parameters={**ALL_OF_THEM, "lapse": careless})
    table = draw_answers(world, truth, DESIGN, rng)
    return tuple(_held(table, truth.ability, settings) for settings in FITS)


def _held(table, ability, settings) -> Held | None:
    question = fit(table, replace(settings, seed=1)).questions[0]
    if not question.ranked:
        return None
    worth = worth_of(ability)
    inside = tuple(
        bool(m.worth_hdi_low <= w <= m.worth_hdi_high) for m, w in zip(question.modes, worth, strict=True)
    )
    return Held(inside, float(np.mean([m.worth_hdi_high - m.worth_hdi_low for m in question.modes])))


if __name__ == "__main__":
    studies = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    processes = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    for careless in (0.0, CARELESS):
        results = Parallel(n_jobs=processes)(delayed(study)(k, careless) for k in range(studies))
        for settings, found in zip(FITS, zip(*results, strict=True), strict=True):
            ranked = [held for held in found if held is not None]
            share = np.mean([held.holds for held in ranked])
            # Worths of one study are not independent: the error is over studies.
            error = np.std([np.mean(held.holds) for held in ranked]) / np.sqrt(len(ranked))
            width = np.mean([held.width for held in ranked])
            name = "with" if settings.lapse else "without"
            print(
                f"{100 * careless:3.0f} % careless, {name} lapse: coverage "
                f"{share:.3f} +- {error:.3f}, mean width {width:.3f}, {len(ranked)} of {studies} ranked",
                flush=True,
            )
