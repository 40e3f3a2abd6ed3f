"""The answer of `elbowroom power` against two others: one without chance, and one from another world."""

from functools import cache
from itertools import product

import numpy as np
import pandas as pd
import pytest
from scipy.special import expit
from scipy.stats import binom

from analysis.calibration.world import Design, Truth
from analysis.calibration.world import draw_answers as answers_of_the_world
from analysis.fit import fit
from analysis.model import model_of
from analysis.power import Plan, Scenario, power
from analysis.results import FitSettings
from data.responses import QuestionScale, ResponseTable
from data.study_file import read_study

from .conftest import REFERENCE

STUDY = read_study("carmichael2017")
TWO_MODES = STUDY.model_copy(update={"modes": STUDY.modes[:2]})
PEOPLE = Scenario((1.0, 6.0), levels=2, cuts=(), subject_sd=0.7, side_effect=0.1)
N = 6
REPLICATES = 30


@cache
def concludes(wins_as_a: int, wins_as_b: int) -> bool:
    """Whether the fit finds the second mode best that won so often of N/2 as A, and so often of N/2 as B."""
    rows = []
    for person in range(N):
        is_a = person < N // 2
        wins = person % (N // 2) < (wins_as_a if is_a else wins_as_b)
        rows.append(
            (f"p{person}", *(("M2", "M1") if is_a else ("M1", "M2")), "A>B" if wins == is_a else "B>A")
        )
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response"])
    frame = frame.assign(question="q", count=1, comparison="", repetition=1, source="simulated", check=False)
    table = ResponseTable(frame, ("M1", "M2"), (QuestionScale("q", "q", "q", 2),), True, True, "", "t")
    return fit(table).questions[0].modes[1].p_best > 0.95


def chance_of_winning(side: float) -> float:
    """Of the second mode against the first, over people: an integral, no simulation."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(41)
    felt = np.log(6.0) + side + np.sqrt(2.0) * PEOPLE.subject_sd * nodes
    return float(expit(felt) @ weights / weights.sum())


def test_the_share_of_right_conclusions_is_the_exact_one_where_that_can_be_counted_out() -> None:
    """Two modes, one answer each by six people: every study that there can be is fitted once."""
    as_a, as_b = chance_of_winning(0.1), chance_of_winning(-0.1)
    half = N // 2
    exact = sum(
        binom.pmf(a, half, as_a) * binom.pmf(b, half, as_b)
        for a, b in product(range(half + 1), repeat=2)
        # Wins on the other side mirror the side effect and nothing else.
        if concludes(min(a, b), max(a, b))
    )
    (found,) = power(Plan(TWO_MODES, PEOPLE, (N,), (1,), replicates=REPLICATES, seed=3)).points
    assert 0.2 < exact < 0.8
    assert found.right_share == pytest.approx(exact, abs=3 * np.sqrt(exact * (1 - exact) / REPLICATES))


def test_studies_from_another_generator_come_to_the_same_share() -> None:
    """Answers drawn as for the calibration, on its schedule, against the recorded 500 replicates."""
    recorded = pd.read_csv(REFERENCE / "power_carmichael2017.csv").set_index("participants")["right_share"][7]
    model = model_of(FitSettings(), 3, has_participants=True)
    ability = np.log([1.0, 1.0, 2.0])
    truth = Truth(ability - ability.mean(), {"side_effect": 0.1, "cut_1": 0.5, "subject_sd": 0.7})
    rng = np.random.default_rng(11)
    tables = [answers_of_the_world(model, truth, Design(7, 2, 3), rng) for _ in range(REPLICATES)]
    share = np.mean(
        [fit(t, FitSettings(seed=k)).questions[0].modes[2].p_best > 0.95 for k, t in enumerate(tables)]
    )
    error = np.sqrt(recorded * (1 - recorded) * (1 / REPLICATES + 1 / 500))
    assert share == pytest.approx(recorded, abs=3 * error)
