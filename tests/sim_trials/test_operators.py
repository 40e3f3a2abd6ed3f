"""Simulated people: what they may know, who they are, how their hands behave."""

import inspect
import math
from dataclasses import fields, replace

import numpy as np
import pytest

from data.study import Feedback, Maze
from sim_trials.maze import wall_of
from sim_trials.operators import Mind, Operator, draw_operator, hand_noise, hand_wrench
from sim_trials.record import record_of

WALL = record_of(wall_of(Maze(), Feedback()))
NO_NOISE = np.zeros(6)


def level_pose(x: float, y: float, z: float) -> np.ndarray:
    """A hand that holds the nozzle perpendicular to the wall."""
    return np.array([[0.0, 0.0, 1.0, x], [1.0, 0.0, 0.0, y], [0.0, 1.0, 0.0, z], [0.0, 0.0, 0.0, 1.0]])


def pull(
    operator: Operator, mind: np.void, T: np.ndarray, y: float, z: float, tilt: float = 0.0
) -> np.ndarray:
    wrench = np.empty(6)
    hand_wrench(record_of(operator), mind, WALL, 0.0, y, z, tilt, T, NO_NOISE, 0.008, wrench)
    return wrench


def test_an_operator_is_told_nothing_of_mode_or_singularity() -> None:
    told = list(inspect.signature(hand_wrench.py_func).parameters)
    assert told == [
        "operator", "mind", "wall", "anticipated", "cursor_y", "cursor_z", "seen_tilt", "hand", "noise", "dt",
        "wrench",
    ]  # fmt: skip
    known = {field.name for cls in (Operator, Mind) for field in fields(cls)}
    assert not [
        n for n in known for word in ("mode", "sigma", "lambda", "damping", "q3", "joint") if word in n
    ]


def test_the_same_seed_gives_the_same_person_and_another_seed_another() -> None:
    assert draw_operator(5) == draw_operator(5)
    assert draw_operator(5) != draw_operator(6)


def test_people_have_the_strength_and_speed_of_people() -> None:
    people = [draw_operator(seed) for seed in range(400)]
    assert all(200 <= p.stiffness_n_m <= 400 and 10 <= p.rotation_stiffness_nm_rad <= 20 for p in people)
    assert all(20 <= p.force_cap_n <= 110 and 5 <= p.torque_cap_nm <= 10 for p in people)
    assert all(0.07 <= p.pace_m_s <= 0.12 and 0.15 <= p.visual_delay_s <= 0.20 for p in people)
    assert np.median([p.force_cap_n for p in people]) == pytest.approx(45.0, rel=0.08)
    assert np.median([p.patience_s for p in people]) == pytest.approx(1.2, rel=0.08)
    assert np.mean([p.goes_back for p in people]) == pytest.approx(0.5, abs=0.08)


def test_unsteadiness_depends_on_seed_and_lap_alone() -> None:
    noise = hand_noise(3, 2, 20_000, 0.008)
    np.testing.assert_array_equal(noise, hand_noise(3, 2, 20_000, 0.008))
    np.testing.assert_array_equal(noise[:500], hand_noise(3, 2, 500, 0.008))
    assert np.abs(noise - hand_noise(3, 1, 20_000, 0.008)).max() > 1.0


def test_unsteadiness_has_unit_variance_and_a_memory_of_50_ms() -> None:
    noise = hand_noise(1, 1, 100_000, 0.008)
    np.testing.assert_allclose(noise.std(axis=0), 1.0, rtol=0.03)
    lag = round(0.048 / 0.008)
    kept = [(noise[lag:, i] * noise[:-lag, i]).mean() for i in range(6)]
    np.testing.assert_allclose(kept, math.exp(-0.048 / 0.05), atol=0.04)


def test_learning_approaches_the_habit_from_nothing() -> None:
    operator = replace(draw_operator(0), habit_tilt_rad=0.05, learning=0.5)
    assert [operator.anticipated_tilt_rad(lap) for lap in (1, 2, 3)] == pytest.approx([0.0, 0.025, 0.0375])


def test_hand_pulls_like_a_spring_towards_its_place_before_the_wall() -> None:
    operator = replace(draw_operator(0), stiffness_n_m=300.0, escalation_n_m_s=0.0, force_cap_n=1000.0)
    mind = record_of(Mind())
    wrench = pull(operator, mind, level_pose(0.78, 0.35, 0.44), 0.35, 0.44)
    np.testing.assert_allclose(wrench, (6.0, 0.0, 3.0, 0.0, 0.0, 0.0), atol=0.02)


def test_hand_turns_a_leaning_nozzle_and_tipped_handles_back() -> None:
    operator, angle = draw_operator(0), 0.1
    c, s = math.cos(angle), math.sin(angle)
    right = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])
    roll = np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])
    for turn in (right, roll, right.T, roll.T):
        T = level_pose(0.8, 0.35, 0.45)
        T[:3, :3] = turn[:3, :3] @ T[:3, :3]
        moment = pull(operator, record_of(Mind()), T, 0.35, 0.45)[3:]
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / (2 * s)
        expected = -operator.rotation_stiffness_nm_rad * s * axis
        np.testing.assert_allclose(moment, expected, atol=1e-9)


def test_force_and_moment_never_exceed_the_caps() -> None:
    operator = draw_operator(1)
    wrench = pull(operator, record_of(Mind()), level_pose(0.2, -0.9, 0.9), -0.9, 0.9)
    assert np.linalg.norm(wrench[:3]) == pytest.approx(operator.force_cap_n)
    T = level_pose(0.8, 0.35, 0.45)
    T[:3, :3] = T[:3, :3] @ np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    weak = replace(operator, torque_cap_nm=2.0)
    assert np.linalg.norm(pull(weak, record_of(Mind()), T, 0.35, 0.45)[3:]) == pytest.approx(2.0)


def hold_still(operator: Operator, seconds: float, tilt: float = 0.0) -> np.void:
    """An operator whose cursor stays in the middle of the top edge, whatever it does."""
    mind = record_of(Mind(edge=0, along_m=0.7, seen_m=0.7, time_s=5.0, rate_m_s=0.1))
    for _ in range(round(seconds / 0.008)):
        pull(operator, mind, level_pose(0.8, -0.35, 0.45), -0.35, 0.45, tilt)
    return mind


def test_an_operator_that_gets_nowhere_leans_the_nozzle_the_way_it_pulls() -> None:
    patient = replace(draw_operator(0), goes_back=False, patience_s=1.2)
    assert hold_still(patient, 1.2)["lean_y"] == 0.0
    mind = hold_still(patient, 4.0)
    # The lap goes to the right here, which is -y.
    assert mind["lean_y"] < -math.radians(4.0)
    assert abs(mind["lean_z"]) < 1e-3


def test_an_operator_stops_leaning_at_the_tilt_it_allows_itself() -> None:
    operator = replace(draw_operator(0), goes_back=False, patience_s=0.5, tilt_limit_rad=0.2)
    assert math.hypot(*hold_still(operator, 30.0)[["lean_y", "lean_z"]]) == pytest.approx(0.2, rel=1e-6)
    assert hold_still(operator, 30.0, tilt=0.21)["lean_y"] == 0.0


def test_half_of_the_people_go_back_once_before_they_lean() -> None:
    operator = replace(draw_operator(0), goes_back=True, patience_s=1.0)
    mind = hold_still(operator, 2.4)
    assert mind["has_gone_back"]
    assert mind["lean_y"] == 0.0
    assert hold_still(operator, 6.0)["lean_y"] < 0.0


def test_the_aim_waits_at_a_corner_until_the_cursor_is_seen_there() -> None:
    operator = draw_operator(0)
    mind = record_of(Mind(edge=0, along_m=1.39, seen_m=1.36, time_s=5.0, rate_m_s=0.1))
    for _ in range(200):
        pull(operator, mind, level_pose(0.8, -1.01, 0.45), -1.01, 0.45)
    assert (mind["edge"], mind["along_m"]) == (0, pytest.approx(1.395))
    pull(operator, mind, level_pose(0.8, -1.02, 0.45), -1.02, 0.45)
    assert mind["edge"] == 1
