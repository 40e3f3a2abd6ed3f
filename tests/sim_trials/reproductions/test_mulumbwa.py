"""The thesis's planar arm, Euler angle sets, joint limits and potential field."""

import numpy as np
import pytest

from sim_trials.reproductions.mulumbwa import euler, humanoid, joint_limits, planar, potential_field
from sim_trials.reproductions.mulumbwa.arms import HUMANOID_START, PLANAR_TARGETS
from sim_trials.reproductions.mulumbwa.experiment import OBSTACLE, WAYS, angle_set_table


@pytest.mark.parametrize(
    ("method", "is_scheduled", "needed"),
    [
        (planar.SVF_SDLS, False, [9, 9, 10, 10]),
        (planar.JP, False, [8, 8, 9, 9]),
        (planar.DLS, False, [8, 8, 9, 9]),
        (planar.JP, True, [100, 100, None, None]),
        (planar.DLS, True, [100, 100, None, None]),
    ],
)
def test_iterations_from_the_stretched_start(
    method: str, is_scheduled: bool, needed: list[int | None]
) -> None:
    done = planar.solve(method, PLANAR_TARGETS["inside"], np.zeros(3), is_scheduled=is_scheduled)
    assert [done.needed(norm) for norm in planar.NORMS] == needed


def test_the_schedule_spreads_a_linear_error_evenly() -> None:
    near = planar.planar_position(np.array([0.5, 0.5, 0.5])) + 1e-4
    done = planar.solve(planar.JP, tuple(near), np.array([0.5, 0.5, 0.5]), is_scheduled=True)
    np.testing.assert_allclose(done.error, done.error[0] * (1 - np.arange(101) / 100), atol=1e-8)


def test_svf_sdls_ends_stretched_towards_a_target_out_of_reach() -> None:
    done = planar.solve(planar.SVF_SDLS, PLANAR_TARGETS["outside"], np.zeros(3), is_scheduled=False)
    np.testing.assert_allclose(done.q[-1], [np.pi / 4, 0, 0], atol=1e-3)
    assert done.error[-1] == pytest.approx(np.hypot(6, 6) - 7, abs=1e-6)


@pytest.mark.parametrize("order", euler.SETS)
def test_angles_of_a_rotation_rebuild_it(order: euler.AngleSet) -> None:
    angles = np.array([2.5, -1.2, -0.4])
    np.testing.assert_allclose(euler.angles_of(euler.rotation(angles, order), order), angles, atol=1e-12)


@pytest.mark.parametrize("order", euler.SETS)
def test_angle_rates_make_the_angular_velocity(order: euler.AngleSet) -> None:
    angles, rates, h = np.array([0.5, -1.2, -0.4]), np.array([0.3, 0.7, -0.9]), 1e-6
    change = (euler.rotation(angles + h * rates, order) - euler.rotation(angles - h * rates, order)) / (2 * h)
    W = change @ euler.rotation(angles, order).T
    np.testing.assert_allclose(
        euler.rate_matrix(angles, order) @ rates, [W[2, 1], W[0, 2], W[1, 0]], atol=1e-8
    )


def test_table_2_lists_exactly_the_sets_free_of_gimbal_lock() -> None:
    table = angle_set_table()
    assert (table["published_free"] == table["found_free"]).all()


def test_a_set_near_its_lock_is_switched_and_keeps_the_attitude() -> None:
    for middle, expected in ((1.5, (1, 2, 3)), (1.565, (1, 3, 2))):
        R = euler.rotation(np.array([0.3, middle, 0.8]), (1, 2, 3))
        now = euler.switched(R, (1, 2, 3))
        assert now.set == expected
        np.testing.assert_allclose(euler.rotation(now.angles, now.set), R, atol=1e-9)


@pytest.mark.parametrize("task", [joint_limits.gradient_projection, joint_limits.kinematic_optimisation])
def test_joint_limit_tasks_push_every_joint_to_the_middle(task: humanoid.Secondary) -> None:
    np.testing.assert_array_equal(task(joint_limits.CENTRE), 0.0)
    side = np.where(np.arange(7) % 2, 0.3, -0.2) * joint_limits.RANGE
    np.testing.assert_array_equal(np.sign(task(joint_limits.CENTRE + side)), -np.sign(side))


def test_kinematic_optimisation_is_minus_the_gradient_of_the_p_norm() -> None:
    q, h = joint_limits.CENTRE + 0.3 * np.arange(1, 8), 1e-6

    def cost(at: np.ndarray) -> float:
        return float(np.linalg.norm((at - joint_limits.CENTRE) / joint_limits.RANGE, ord=joint_limits.NORM))

    slope = [(cost(q + h * row) - cost(q - h * row)) / (2 * h) for row in np.eye(7)]
    np.testing.assert_allclose(joint_limits.kinematic_optimisation(q), -np.array(slope), atol=1e-8)


def test_the_start_of_the_thesis_breaks_its_own_limit_of_joint_3() -> None:
    assert joint_limits.violated(HUMANOID_START) == 1
    assert joint_limits.violated(joint_limits.CENTRE) == 0


def test_repulsion_is_minus_the_gradient_of_equation_43() -> None:
    x, h = OBSTACLE + np.array([0.15, 0.18]), 1e-7

    def potential(at: np.ndarray) -> float:
        D = float(np.linalg.norm(at - OBSTACLE)) - potential_field.OBSTACLE_RADIUS_M
        return 0.5 * potential_field.ETA * (1 / D - 1 / potential_field.REACH_M) ** 2

    slope = np.array([(potential(x + h * row) - potential(x - h * row)) / (2 * h) for row in np.eye(2)])
    np.testing.assert_allclose(potential_field.repulsion(x, OBSTACLE), -slope, rtol=1e-5)


def test_the_point_keeps_2_cm_off_the_obstacle_with_the_gradient_but_enters_it_as_printed() -> None:
    start, goal = (np.array(place) for place in WAYS[4])
    right = potential_field.descend(start, goal, OBSTACLE)
    printed = potential_field.descend(start, goal, OBSTACLE, as_printed=True)
    assert right.has_arrived
    assert right.clearance_m == pytest.approx(0.0201, abs=5e-4)
    assert printed.clearance_m < 0
