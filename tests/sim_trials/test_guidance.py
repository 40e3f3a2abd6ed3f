"""A person's hand: a spring with limits, which takes hold gently and lets go at once."""

import math

import numpy as np
import pytest

from data.study import Feedback, Maze
from sim_trials.guidance import HAND, Grip, guided_wrench, lean_of
from sim_trials.kinematics import rotation_matrix
from sim_trials.maze import cursor, wall_of
from sim_trials.record import record_of

DT = 0.008
WALL = record_of(wall_of(Maze(), Feedback()))
DISTANCE_M = WALL["handle_distance_m"]
AIM = (-0.3, 0.25)


def nozzle(y: float, z: float, lean_y: float = 0.0, lean_z: float = 0.0) -> np.ndarray:
    """Pose of a handle whose nozzle, leaning by the given angles [rad], points at (y, z) on the wall."""
    level = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    turn, T = np.empty((3, 3)), np.eye(4)
    rotation_matrix(np.array([0.0, -lean_z, lean_y]), turn)
    T[:3, :3] = turn @ level
    T[:3, 3] = np.array([WALL["wall_x_m"], y, z]) - DISTANCE_M * T[:3, 2]
    return T


def wrench_of(
    grip: np.void, T: np.ndarray, aim: tuple[float, float] = AIM, lean: tuple[float, float] = (0.0, 0.0),
    *, is_held: bool = True, ticks: int = 1,
) -> np.ndarray:  # fmt: skip
    wrench = np.empty(6)
    for _ in range(ticks):
        guided_wrench(record_of(HAND), grip, WALL, is_held, *aim, *lean, T, DT, wrench)
    return wrench


def firm_grip() -> np.void:
    return record_of(Grip(strength=1.0))


def test_a_hand_with_its_pointer_on_the_cursor_of_a_level_nozzle_does_nothing() -> None:
    np.testing.assert_allclose(wrench_of(firm_grip(), nozzle(*AIM)), 0.0, atol=1e-9)


def test_the_force_is_a_spring_towards_the_pointer() -> None:
    wrench = wrench_of(firm_grip(), nozzle(AIM[0] + 0.05, AIM[1] - 0.02))
    np.testing.assert_allclose(wrench, [0.0, -15.0, 6.0, 0.0, 0.0, 0.0], atol=1e-9)


def test_no_pull_exceeds_the_strength_and_its_direction_stays() -> None:
    grip = firm_grip()
    wrench = wrench_of(grip, nozzle(AIM[0] + 4.0, AIM[1] - 3.0))
    np.testing.assert_allclose(wrench[1:3], [-0.8 * HAND.force_cap_n, 0.6 * HAND.force_cap_n])
    assert grip["pull"] == pytest.approx(1.0)


def test_the_stand_off_is_kept_while_the_hand_pulls_with_all_strength() -> None:
    T = nozzle(AIM[0] + 4.0, AIM[1])
    T[0, 3] -= 0.1
    np.testing.assert_allclose(wrench_of(firm_grip(), T)[:2], [30.0, -HAND.force_cap_n])
    T[0, 3] -= 10.0
    assert wrench_of(firm_grip(), T)[0] == HAND.standoff_cap_n


@pytest.mark.parametrize("lean_deg", [(-20.0, 0.0), (0.0, 10.0), (12.0, -9.0)])
def test_leaning_does_not_move_the_aim(lean_deg: tuple[float, float]) -> None:
    lean = (math.radians(lean_deg[0]), math.radians(lean_deg[1]))
    T = nozzle(*AIM, *lean)
    assert cursor(WALL, T) == pytest.approx(AIM)
    assert lean_of(T) == pytest.approx(lean)
    grip = record_of(Grip(strength=1.0, lean_y_rad=lean[0], lean_z_rad=lean[1]))
    wrench = wrench_of(grip, T, lean=lean)
    np.testing.assert_allclose(wrench[:3], 0.0, atol=1e-9)
    # Handles that are not level are turned about the nozzle, which leaves the aim where it is.
    np.testing.assert_allclose(np.cross(wrench[3:], T[:3, 2]), 0.0, atol=1e-9)


def test_without_a_wanted_lean_the_hand_turns_the_nozzle_back_with_limited_strength() -> None:
    few, many = math.radians(2.0), math.radians(80.0)
    moment = wrench_of(firm_grip(), nozzle(*AIM, few, 0.0))[3:]
    np.testing.assert_allclose(moment, [0.0, 0.0, -HAND.rotation_stiffness_nm_rad * math.sin(few)], atol=1e-9)
    moment = wrench_of(firm_grip(), nozzle(*AIM, 0.0, many))[3:]
    np.testing.assert_allclose(moment, [0.0, HAND.torque_cap_nm, 0.0], atol=1e-9)


def test_the_lean_grows_at_its_rate_up_to_its_limit() -> None:
    grip, wanted = firm_grip(), (math.radians(-60.0), math.radians(80.0))
    wrench_of(grip, nozzle(*AIM), lean=wanted, ticks=25)
    assert math.hypot(grip["lean_y_rad"], grip["lean_z_rad"]) == pytest.approx(25 * DT * HAND.lean_rate_rad_s)
    wrench_of(grip, nozzle(*AIM), lean=wanted, ticks=200)
    assert grip["lean_y_rad"] == pytest.approx(-0.6 * HAND.lean_limit_rad)
    assert grip["lean_z_rad"] == pytest.approx(0.8 * HAND.lean_limit_rad)


def test_a_hand_takes_hold_without_a_jerk_however_far_its_pointer_is() -> None:
    grip, forces = record_of(Grip()), [0.0]
    for _ in range(40):
        forces.append(float(np.hypot(*wrench_of(grip, nozzle(AIM[0] + 1.0, AIM[1]))[1:3])))
    assert np.diff(forces).max() == pytest.approx(HAND.force_cap_n * DT / HAND.grip_s)
    assert forces[round(HAND.grip_s / DT) + 1] == pytest.approx(HAND.force_cap_n)


def test_a_hand_takes_hold_of_a_leaning_nozzle_with_the_lean_it_finds() -> None:
    grip, T = firm_grip(), nozzle(*AIM, math.radians(10.0), 0.0)
    wrench_of(grip, T, is_held=False)
    assert grip["lean_y_rad"] == pytest.approx(math.radians(10.0))
    first = wrench_of(grip, T)
    assert np.abs(first[3:]).max() < 0.02 * HAND.torque_cap_nm


def test_a_released_hand_pulls_with_nothing_at_once() -> None:
    grip = firm_grip()
    assert np.abs(wrench_of(grip, nozzle(0.3, 0.4, 0.2, 0.1))).max() > 10.0
    np.testing.assert_array_equal(wrench_of(grip, nozzle(0.3, 0.4, 0.2, 0.1), is_held=False), np.zeros(6))
    assert grip["strength"] == 0.0
    assert grip["pull"] == 0.0
