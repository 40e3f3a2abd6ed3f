"""The MuJoCo model: its physics step in compiled loops, its state as shared arrays, its servos."""

import mujoco
import numpy as np
from numba.core import types

from sim_trials.compiled import compiled
from sim_trials.kinematics import (
    HANDLE_OFFSET_M,
    NOZZLE_LENGTH_M,
    SENSOR_OFFSET_M,
    handle_jacobian,
    handle_pose,
)
from sim_trials.model import PHYSICS_STEP_S, STEP_TYPE, new_robot, physics_step

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])


@compiled(types.void(STEP_TYPE, types.intp, types.intp, types.int64), cache=False)
def advance(step: object, model: int, data: int, n: int) -> None:
    for _ in range(n):
        step(model, data)  # type: ignore[operator]


def test_compiled_loop_steps_the_physics_bit_for_bit_like_mujoco() -> None:
    compiled_robot, plain_robot = new_robot(START), new_robot(START)
    for robot in (compiled_robot, plain_robot):
        robot.target[:] += 0.01
        robot.hand[:] = (3.0, -20.0, 5.0, 0.1, 0.2, -0.3)
    advance(physics_step(), compiled_robot.model_address, compiled_robot.data_address, 250)
    for _ in range(250):
        plain_robot.step()
    np.testing.assert_array_equal(compiled_robot.q, plain_robot.q)
    np.testing.assert_array_equal(compiled_robot.qdot, plain_robot.qdot)
    assert np.abs(compiled_robot.q - START).max() > 0.005


def test_two_robots_do_not_share_state() -> None:
    one, other = new_robot(START), new_robot(START)
    one.q[0] += 1.0
    assert other.q[0] == START[0]


def test_robot_stays_where_it_is_placed() -> None:
    robot = new_robot(START)
    for _ in range(1000):
        robot.step()
    np.testing.assert_allclose(robot.q, START, atol=1e-12)


def test_push_of_45_newtons_bends_the_arm_by_less_than_2_mm() -> None:
    robot = new_robot(START)
    robot.hand[:3] = (0.0, 45.0, 0.0)
    for _ in range(500):
        robot.step()
    before, after = np.empty((4, 4)), np.empty((4, 4))
    handle_pose(START, before)
    handle_pose(robot.q.copy(), after)
    moved = np.linalg.norm(after[:3, 3] - before[:3, 3])
    assert 1e-4 < moved < 2e-3


def test_placing_a_pushed_robot_makes_it_new() -> None:
    robot, fresh = new_robot(START), new_robot(START)
    robot.hand[:] = 30.0
    robot.target[:] += 0.3
    for _ in range(50):
        robot.step()
    robot.place(START)
    for view, expected in ((robot.q, fresh.q), (robot.qdot, fresh.qdot), (robot.hand, fresh.hand)):
        np.testing.assert_array_equal(view, expected)
    np.testing.assert_array_equal(robot.target, START)
    assert robot.data.time == 0.0


def test_sites_stand_where_the_kinematics_say() -> None:
    robot = new_robot(START)
    flange = robot.data.site("flange").xpos
    for name, offset in (
        ("sensor", SENSOR_OFFSET_M),
        ("handle", HANDLE_OFFSET_M),
        ("nozzle", NOZZLE_LENGTH_M),
    ):
        np.testing.assert_allclose(np.linalg.norm(robot.data.site(name).xpos - flange), offset, atol=1e-12)
    assert robot.model.opt.timestep == PHYSICS_STEP_S


def test_hand_acts_at_the_handle_centre() -> None:
    """Its joint torques are J' times the wrench, J being the handle's Jacobian in the base frame."""
    robot, J = new_robot(START), np.empty((6, 6))
    before = robot.data.qfrc_smooth.copy()
    robot.hand[:] = (3.0, -20.0, 5.0, 0.1, 0.2, -0.3)
    handle_jacobian(START, J)
    mujoco.mj_forward(robot.model, robot.data)
    np.testing.assert_allclose(robot.data.qfrc_smooth - before, J.T @ robot.hand, atol=1e-11)


def test_masses_are_the_published_ones() -> None:
    masses = new_robot(START).model.body_mass
    np.testing.assert_allclose(masses[1:7], (7.1, 12.7, 4.27, 2.0, 2.0, 0.365))


def test_a_diverged_simulation_is_not_silently_reset() -> None:
    assert new_robot(START).model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_AUTORESET
