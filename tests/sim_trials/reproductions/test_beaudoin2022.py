"""The 5-DOF arm with link shells: geometry, selection and reduction, and the paper's angles."""

import numpy as np
import pytest

from sim_trials.reproductions.beaudoin2022.claims import angle_deg, turned
from sim_trials.reproductions.beaudoin2022.experiment import MIDDLE_M, READINGS
from sim_trials.reproductions.beaudoin2022.robot import (
    ACCELERATION_LIMIT,
    ARM,
    SPEED_LIMIT,
    START,
    B,
    link_state,
)
from sim_trials.reproductions.beaudoin2022.shell import (
    SHELLS,
    Shell,
    direct_rates,
    rotation_matrix,
    split_rates,
    translation_matrix,
)
from sim_trials.reproductions.beaudoin2022.strategies import (
    STRATEGIES,
    TRANSPOSE,
    inverse_of,
    transpose_angle,
)
from sim_trials.reproductions.beaudoin2022.trajectory import HARMONICS, PERIOD_S, run
from sim_trials.reproductions.chain import posture


def test_the_start_has_link_3_along_link_1_and_link_5_along_the_shells_motion() -> None:
    axes = posture(ARM, START).axes
    np.testing.assert_allclose(axes[2], axes[0], atol=1e-15)
    assert abs(axes[4] @ link_state(START, 3, MIDDLE_M).rotation[:, 1]) == pytest.approx(1.0)


@pytest.mark.parametrize("link", [3, 5])
def test_a_links_jacobian_agrees_with_finite_differences(link: int) -> None:
    q, h, lever = START + np.array([0.3, -0.4, 0.5, 0.2, -0.6]), 1e-6, 0.1
    here = link_state(q, link, lever)
    for i in range(5):
        ahead, behind = (link_state(q + sign * h * np.eye(5)[i], link, lever) for sign in (1, -1))
        np.testing.assert_allclose(
            here.jacobian[3:, i], here.rotation.T @ (ahead.point - behind.point) / (2 * h), atol=1e-8
        )
        W = here.rotation.T @ (ahead.rotation - behind.rotation) / (2 * h)
        np.testing.assert_allclose(here.jacobian[:3, i], [W[2, 1], W[0, 2], W[1, 0]], atol=1e-8)


@pytest.mark.parametrize("shell", SHELLS, ids=lambda shell: f"link {shell.link}")
def test_a_shell_selects_three_rows_and_reduces_to_the_joints_before_its_link(shell: Shell) -> None:
    J = link_state(START, shell.link, 0.1).jacobian
    before = [joint - 1 for joint in shell.moved_by]
    np.testing.assert_array_equal(translation_matrix(shell, J), J[3:5][:, before])
    np.testing.assert_array_equal(rotation_matrix(shell, J), J[2:3, : shell.link])


def test_direct_rotation_turns_the_links_own_joint_alone() -> None:
    J = link_state(START, 3, MIDDLE_M).jacobian
    rates = direct_rates(SHELLS[0], J, np.array([0.7, 0.0, 0.0]), inverse_of(TRANSPOSE, 0.1))
    np.testing.assert_allclose(rates, [0, 0, 0.7, 0, 0], atol=1e-15)


def test_split_rates_add_what_turns_and_what_moves() -> None:
    J = link_state(turned(0.4), 3, MIDDLE_M).jacobian
    inverse = inverse_of(STRATEGIES[0], 0.1)
    both = split_rates(SHELLS[0], J, np.array([0.3, 0.1, -0.2]), inverse)
    turn = split_rates(SHELLS[0], J, np.array([0.3, 0.0, 0.0]), inverse)
    move = split_rates(SHELLS[0], J, np.array([0.0, 0.1, -0.2]), inverse)
    np.testing.assert_allclose(both, turn + move, atol=1e-15)
    assert np.abs(turn[:3]).max() > 0.01
    np.testing.assert_array_equal(move[2:], 0.0)


def test_the_closed_form_of_the_transpose_agrees_with_the_arm() -> None:
    for phi in np.linspace(0.05, 1.5, 12):
        closed = np.degrees(transpose_angle(phi, B[1], MIDDLE_M))
        assert angle_deg(TRANSPOSE, phi) == pytest.approx(closed, abs=1e-10)


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_link_and_shell_move_alike_at_the_start_and_a_quarter_turn_on(strategy: str) -> None:
    assert angle_deg(strategy, 0.0) < 1e-9
    assert angle_deg(strategy, np.pi / 2) < 1e-9


def test_without_limits_and_a_tenth_of_the_damping_the_published_angles_come_out() -> None:
    largest = [
        [run(h, inverse_of(s, 0.01), READINGS[0]).psi_max_deg for s in STRATEGIES] for h in HARMONICS[:2]
    ]
    np.testing.assert_allclose(largest, [[8.543, 8.713, 10.407], [12.805, 12.914, 26.175]], atol=2e-3)


def test_with_limits_joints_keep_their_speed_and_acceleration() -> None:
    course = run(HARMONICS[1], inverse_of(TRANSPOSE, 0.1), READINGS[2])
    rates = np.diff(course.q, axis=0) / PERIOD_S
    assert (np.abs(rates) <= SPEED_LIMIT + 1e-9).all()
    assert (np.abs(np.diff(rates, axis=0)) <= ACCELERATION_LIMIT * PERIOD_S + 1e-9).all()
    assert course.reaches_acceleration_limit
    assert course.reaches_shell_limit
