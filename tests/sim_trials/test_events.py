"""The definitions of stuck, elbow inversion and protective stop, on series made by hand."""

import numpy as np
import pytest

from data.study import Stuck
from sim_trials.events import dwell_ticks, events, inversion_tick, stop_tick, stuck_tick, ticks_below
from sim_trials.loop import STUCK, TICK
from sim_trials.trace import Trace

ONE_SECOND = Stuck(sigma_below=0.005, dwell_s=1.0)


def dip(n: int, first: int, length: int) -> np.ndarray:
    sigma = np.full(n, 0.2)
    sigma[first : first + length] = 0.004
    return sigma


def test_stuck_needs_more_than_the_dwell_time_without_a_break() -> None:
    assert stuck_tick(dip(500, 100, 125), ONE_SECOND) is None
    assert stuck_tick(dip(500, 100, 126), ONE_SECOND) == 225
    interrupted = dip(500, 100, 300)
    interrupted[200] = 0.005
    assert stuck_tick(interrupted, ONE_SECOND) == 201 + 125
    interrupted[300] = 0.005
    assert stuck_tick(interrupted, ONE_SECOND) is None


def test_a_singular_value_at_the_threshold_is_not_below_it() -> None:
    assert stuck_tick(np.full(1000, 0.005), ONE_SECOND) is None
    assert stuck_tick(np.full(1000, 0.00499), ONE_SECOND) == 125


def test_dwell_ticks_count_whole_control_periods() -> None:
    assert [dwell_ticks(s) for s in (0.008, 0.0079, 0.0081, 5.0, 3.0, 7.0)] == [1, 0, 1, 625, 375, 875]


def test_ticks_below_counts_each_stretch_from_its_own_beginning() -> None:
    sigma = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(ticks_below(sigma, 0.5), [0, 1, 2, 0, 1, 2, 3])
    np.testing.assert_array_equal(ticks_below(sigma[1:3], 0.5), [1, 2])


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_elbow_inversion_is_a_degree_beyond_straight_on_either_side(side: float) -> None:
    elbow = side * np.radians([90.0, 10.0, 0.0, -0.9, -1.1, -5.0])
    assert inversion_tick(elbow) == 4
    assert inversion_tick(elbow[:4]) is None


def test_protective_stop_is_a_joint_at_98_percent_of_its_limit() -> None:
    qdot = np.zeros((10, 6))
    qdot[3, 0] = np.radians(0.979 * 120.0)
    qdot[4, 5] = np.radians(-0.979 * 180.0)
    assert stop_tick(qdot) is None
    qdot[6, 1] = np.radians(-0.981 * 120.0)
    assert stop_tick(qdot) == 6


def test_events_come_in_order_of_time_with_phase_and_definition() -> None:
    ticks = np.zeros(500, TICK)
    ticks["sigma"] = dip(500, 100, 400)
    ticks["q"][:, 2] = 1.0
    ticks["q"][150:, 2] = -1.0
    phase = np.full(500, 2, np.uint8)
    phase[:200] = 1
    trace = Trace(ticks, np.zeros((500, 6), np.int16), np.zeros(500, np.uint8), STUCK)
    inversion, stuck = events(trace, phase, ONE_SECOND)
    assert (inversion.kind, inversion.time_s, inversion.phase) == (
        "elbow_inversion",
        pytest.approx(1.2),
        "approach",
    )
    assert inversion.definition == "elbow-sign/1"
    assert (stuck.kind, stuck.time_s, stuck.phase) == ("stuck", pytest.approx(1.8), "edge")
    assert (stuck.sigma_min, stuck.definition) == (0.004, "sigma-dwell/1")
