"""The control chain: what a push does, what the limits hold, and what happens without the trigger."""

import math

import numpy as np
import pytest

from data.study import Controller, Mode
from data.study_file import read_study
from sim_trials.admittance import (
    COMMAND,
    CONTROL_PERIOD_S,
    RAMP,
    REFERENCE,
    SIGMA,
    STATE_LENGTH,
    TWIST,
    VELOCITY,
    WRENCH,
    control_step,
    initial_state,
    limit_and_integrate,
    pack_controller,
    sensor_wrench,
    servo_target,
)
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S, handle_jacobian, handle_pose
from sim_trials.modes.method import ResolvedMode
from sim_trials.modes.registry import resolve
from sim_trials.singular_value import smallest_singular_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])
LIMITS = np.array(JOINT_SPEED_LIMITS_RAD_S)
DT = CONTROL_PERIOD_S
M1, M2, M3 = (resolve(mode) for mode in read_study("carmichael2017").modes)


class Chain:
    """The control step on a robot that follows its reference exactly."""

    def __init__(self, mode: ResolvedMode = M1, q: np.ndarray = START, controller: Controller | None = None):
        self.mode, self.parameters = mode, mode.packed()
        self.controller = pack_controller(controller or Controller())
        self.state = initial_state(q)
        self.T, self.J, self.measured = np.empty((4, 4)), np.empty((6, 6)), np.empty(6)
        handle_pose(q, self.T)

    def tick(self, wrench: np.ndarray, enabled: bool = True) -> np.ndarray:
        """A wrench at the handle, base frame; returns the state's copy after the step."""
        sensor_wrench(self.T, np.asarray(wrench, dtype=float), self.measured)
        control_step(
            self.mode.function, self.parameters, self.controller, self.state[REFERENCE].copy(),
            self.measured, enabled, DT, self.state, self.T, self.J,
        )  # fmt: skip
        return self.state.copy()


def wild_wrenches(n: int) -> np.ndarray:
    return np.random.default_rng(53).normal(size=(n, 6)) * np.array([200, 200, 200, 20, 20, 20])


def test_a_steady_push_moves_the_handle_along_it_at_gain_times_force() -> None:
    chain = Chain(controller=Controller(extra_damping_n_s_m=0.0, extra_damping_nm_s_rad=0.0))
    for _ in range(40):
        state = chain.tick(np.array([0.0, -10.0, 0.0, 0.0, 0.0, 0.0]))
    np.testing.assert_allclose(chain.J @ state[VELOCITY], [0.0, -0.1, 0.0, 0.0, 0.0, 0.0], atol=2e-3)
    np.testing.assert_allclose(state[TWIST], [0.0, -0.1, 0.0, 0.0, 0.0, 0.0], atol=1e-4)


def test_a_steady_moment_turns_the_handle_about_it() -> None:
    chain = Chain(controller=Controller(extra_damping_nm_s_rad=0.0))
    for _ in range(20):
        state = chain.tick(np.array([0.0, 0.0, 0.0, 0.0, 0.4, 0.0]))
    np.testing.assert_allclose(state[TWIST], [0.0, 0.0, 0.0, 0.0, 0.1, 0.0], atol=1e-4)


def test_a_force_at_the_handle_centre_commands_no_rotation_wherever_the_sensor_is() -> None:
    chain = Chain()
    sensor_wrench(chain.T, np.array([3.0, -4.0, 5.0, 0.0, 0.0, 0.0]), chain.measured)
    assert np.abs(chain.measured[3:]).max() > 0.2
    state = chain.tick(np.array([3.0, -4.0, 5.0, 0.0, 0.0, 0.0]))
    np.testing.assert_allclose(state[WRENCH][3:], 0.0, atol=1e-14)
    np.testing.assert_allclose(state[TWIST][3:], 0.0, atol=1e-14)


def test_extra_damping_takes_its_share_of_the_speed() -> None:
    """With f_D = D v at rest of the motion, v = K F / (1 + K D)."""
    chain = Chain(controller=Controller(extra_damping_n_s_m=20.0))
    for _ in range(40):
        state = chain.tick(np.array([0.0, -10.0, 0.0, 0.0, 0.0, 0.0]))
    assert state[TWIST][1] == pytest.approx(-0.1 / (1 + 0.01 * 20.0), rel=0.01)


def test_wrench_filter_is_a_first_order_low_pass() -> None:
    chain = Chain()
    for n in range(1, 30):
        state = chain.tick(np.array([0.0, 0.0, 10.0, 0.0, 0.0, 0.0]), enabled=False)
        expected = 10.0 * (1 - math.exp(-2 * math.pi * 10.0 * n * DT))
        assert np.linalg.norm(state[WRENCH][:3]) == pytest.approx(expected, rel=1e-9)


def test_lag_is_first_order() -> None:
    controller, state = pack_controller(Controller()), np.zeros(STATE_LENGTH)
    command = np.array([0.05, -0.03, 0.02, 0.0, 0.01, -0.04])
    for n in range(1, 20):
        limit_and_integrate(controller, command, DT, state)
        np.testing.assert_allclose(state[VELOCITY], command * (1 - math.exp(-n * DT / 0.02)), rtol=1e-12)


def test_speed_limits_hold_and_keep_the_direction() -> None:
    controller, state = pack_controller(Controller(joint_acceleration_rad_s2=100.0)), np.zeros(STATE_LENGTH)
    command = np.array([9.0, -1.0, 3.0, 20.0, 0.5, -2.0])
    for _ in range(100):
        limit_and_integrate(controller, command, DT, state)
        assert (np.abs(state[VELOCITY]) <= LIMITS * (1 + 1e-12)).all()
    np.testing.assert_allclose(state[RAMP] / np.linalg.norm(state[RAMP]), command / np.linalg.norm(command))
    assert np.max(np.abs(state[RAMP]) / LIMITS) == pytest.approx(1.0)


def test_speed_and_acceleration_limits_hold_under_a_wild_hand() -> None:
    for mode in (M1, M2, M3):
        chain = Chain(mode)
        before = chain.state.copy()
        for wrench in wild_wrenches(400):
            state = chain.tick(wrench)
            assert np.isfinite(state).all()
            assert (np.abs(state[RAMP]) <= LIMITS * (1 + 1e-12)).all()
            assert np.abs(state[RAMP] - before[RAMP]).max() <= 8.0 * DT * (1 + 1e-9)
            assert np.abs(state[VELOCITY] - before[VELOCITY]).max() <= 8.0 * DT * (1 + 1e-9)
            before = state


def test_without_the_enable_trigger_the_robot_does_not_move() -> None:
    chain = Chain()
    for wrench in wild_wrenches(200):
        state = chain.tick(wrench, enabled=False)
        np.testing.assert_array_equal(state[REFERENCE], START)
        np.testing.assert_array_equal(state[COMMAND], 0.0)


def test_releasing_the_trigger_ramps_to_a_halt() -> None:
    chain, push = Chain(), np.array([0.0, -30.0, 0.0, 0.0, 0.0, 0.0])
    for _ in range(50):
        moving = chain.tick(push)
    speeds = [np.abs(moving[VELOCITY]).max()]
    assert speeds[0] > 0.1
    for _ in range(60):
        speeds.append(np.abs(chain.tick(push, enabled=False)[VELOCITY]).max())
    assert speeds[-1] < 1e-6
    assert (np.diff(speeds) <= 0).all()
    assert speeds[1] > 0.5 * speeds[0], "the halt is a jerk, not a ramp"


def test_servo_target_runs_in_a_straight_line_to_the_next_reference() -> None:
    chain, ctrl = Chain(), np.empty(6)
    for wrench in wild_wrenches(20):
        state = chain.tick(wrench)
    servo_target(state, 0.0, ctrl)
    np.testing.assert_array_equal(ctrl, state[REFERENCE])
    servo_target(state, DT, ctrl)
    np.testing.assert_allclose(ctrl, chain.tick(np.zeros(6))[REFERENCE], rtol=1e-15)


def test_sigma_is_that_of_the_measured_pose() -> None:
    chain, J = Chain(), np.empty((6, 6))
    handle_jacobian(START, J)
    assert chain.tick(np.zeros(6))[SIGMA] == smallest_singular_value(J)


def test_m1_with_lambda0_of_m2_leaves_the_same_trace_bit_for_bit() -> None:
    changed = resolve(Mode(name="M1", method="dls", parameters={"lambda0": 0.6, "sigma_t": 0.25}))
    near_lock = START.copy()
    near_lock[2] = 0.4
    one, other, light = Chain(changed, near_lock), Chain(M2, near_lock), Chain(M1, near_lock)
    for wrench in 0.05 * wild_wrenches(300):
        assert one.tick(wrench).tobytes() == other.tick(wrench).tobytes()
        light.tick(wrench)
    assert not np.array_equal(light.state, other.state)
