"""Modes that stand still for good, told before anybody is invited."""

import math
from dataclasses import replace

import numpy as np
import pytest

from data.study import Maze, Mode
from sim_trials.kinematics import handle_jacobian
from sim_trials.loop import COMPLETED, TIMED_OUT
from sim_trials.mode_laps import LapOfMode, ModeLaps
from sim_trials.modes.method import ResolvedMode
from sim_trials.modes.registry import METHODS, resolve
from sim_trials.standstill import caution, sigma_of_lap, standstill_sigma

SHORT_OF_THE_LOCK = Maze(right_y_m=-0.5)


def mode(method: str, **parameters: float) -> ResolvedMode:
    return resolve(Mode(name="X", method=method, parameters=parameters))


@pytest.mark.parametrize("method", METHODS)
def test_condition_scaling_alone_stands_still_before_the_lock(method: str) -> None:
    assert bool(caution(mode(method), Maze())) == (method == "condition_scaling")


def test_it_stands_still_where_its_condition_number_is_reached() -> None:
    sigma = standstill_sigma(mode("condition_scaling"), Maze())
    assert sigma == pytest.approx(0.075, abs=0.005)
    assert standstill_sigma(mode("condition_scaling", stop_at=60.0), Maze()) < 0.6 * sigma


def test_a_lap_that_stays_away_from_there_is_no_reason_for_caution() -> None:
    assert caution(mode("condition_scaling"), SHORT_OF_THE_LOCK) == ""
    assert caution(mode("condition_scaling", stop_at=17.0, slow_from=5.0), SHORT_OF_THE_LOCK) == ""
    assert "stands still below sigma" in caution(
        mode("condition_scaling", stop_at=7.0, slow_from=5.0), SHORT_OF_THE_LOCK
    )


def test_sigma_of_the_lap_is_that_of_its_farthest_corner() -> None:
    assert sigma_of_lap(Maze()) == 0.0, "the arm does not reach the lower right corner without leaning"
    near, far = sigma_of_lap(SHORT_OF_THE_LOCK), sigma_of_lap(Maze(right_y_m=-0.8))
    assert 0.0 < far < near < 0.35


def test_a_method_without_any_answer_stands_still_from_the_start() -> None:
    frozen = mode("pseudo_inverse", zero_below=1.0)
    J = np.empty((6, 6))
    handle_jacobian(np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0]), J)
    assert np.linalg.svd(J, compute_uv=False)[0] > 1.0
    assert standstill_sigma(frozen, Maze()) == 0.0, "one direction is left to it"


def test_the_verdict_on_its_laps_begins_with_it() -> None:
    given_up = LapOfMode(TIMED_OUT, 180.0, 0.2, 0.0, 14.0, math.nan, 0.075)
    why = caution(mode("condition_scaling"), Maze())
    laps = ModeLaps("Servo", (given_up, replace(given_up, ending=COMPLETED)), "abandoned", 180.0, why)
    assert not laps.can_be_done
    assert laps.verdict == (
        f"{why}; 1 of 2 laps get no further and are given up (sigma 0.075);"
        " the live lap gets no further and is given up"
    )
