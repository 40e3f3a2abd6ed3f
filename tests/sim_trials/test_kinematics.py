"""The arm's kinematics against MuJoCo, finite differences, a plain DH chain and poses known by hand."""

import math

import mujoco
import numpy as np
import pytest

from sim_trials.kinematics import (
    DH_A_M,
    DH_ALPHA_RAD,
    DH_D_M,
    HANDLE_OFFSET_M,
    handle_jacobian,
    handle_pose,
    rotation_matrix,
    rotation_vector,
    tilt,
)
from sim_trials.model import new_robot
from sim_trials.singular_value import smallest_singular_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])
RANDOM_Q = np.random.default_rng(7).uniform(-2 * np.pi, 2 * np.pi, size=(60, 6))


def pose(q: np.ndarray) -> np.ndarray:
    T = np.full((4, 4), np.nan)
    handle_pose(np.asarray(q, dtype=float), T)
    return T


def jacobian(q: np.ndarray) -> np.ndarray:
    J = np.full((6, 6), np.nan)
    handle_jacobian(np.asarray(q, dtype=float), J)
    return J


def dh_chain(q: np.ndarray) -> np.ndarray:
    """The textbook product of six DH matrices, then the handle's offset."""
    T = np.eye(4)
    for theta, a, d, alpha in zip(q, DH_A_M, DH_D_M, DH_ALPHA_RAD, strict=True):
        c, s, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
        T = T @ np.array(
            [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        )
    return T @ np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, HANDLE_OFFSET_M], [0, 0, 0, 1]])


def test_flange_at_zero_is_where_the_published_numbers_put_it() -> None:
    T = pose(np.zeros(6))
    np.testing.assert_allclose(
        T[:3, 3] - HANDLE_OFFSET_M * T[:3, 2], (-1.1843, -0.256141, 0.0116), atol=1e-15
    )


def test_handle_pose_is_the_product_of_the_dh_matrices() -> None:
    for q in RANDOM_Q:
        np.testing.assert_allclose(pose(q), dh_chain(q), atol=1e-14)


def test_pose_and_jacobian_agree_with_mujoco() -> None:
    robot = new_robot(START)
    handle = robot.model.site("handle").id
    expected = np.zeros((6, 6))
    for q in RANDOM_Q:
        robot.place(q)
        mujoco.mj_jacSite(robot.model, robot.data, expected[:3], expected[3:], handle)
        T = pose(q)
        np.testing.assert_allclose(T[:3, 3], robot.data.site_xpos[handle], atol=1e-9)
        np.testing.assert_allclose(T[:3, :3].ravel(), robot.data.site_xmat[handle], atol=1e-9)
        np.testing.assert_allclose(jacobian(q), expected, atol=1e-9)


def test_jacobian_is_the_derivative_of_the_pose() -> None:
    h = 1e-6
    turn = np.empty(3)
    for q in RANDOM_Q[:15]:
        J = jacobian(q)
        for joint in range(6):
            step = h * np.eye(6)[joint]
            ahead, behind = pose(q + step), pose(q - step)
            np.testing.assert_allclose((ahead[:3, 3] - behind[:3, 3]) / (2 * h), J[:3, joint], atol=1e-8)
            rotation_vector(behind, ahead, turn)
            np.testing.assert_allclose(turn / (2 * h), J[3:, joint], atol=1e-8)


def test_start_pose_points_the_nozzle_straight_at_the_wall() -> None:
    T = pose(START)
    assert tilt(T) < 1e-3
    np.testing.assert_allclose(T[:3, 3], (0.8, 0.35, 0.45), atol=1e-3)
    assert smallest_singular_value(jacobian(START)) == pytest.approx(0.315, abs=5e-4)


@pytest.mark.parametrize("base", [0.0, 1.1])
def test_elbow_lock_is_singular(base: float) -> None:
    assert smallest_singular_value(jacobian([base, -1.2, 0.0, -0.4, 1.3, 0.2])) < 1e-15


@pytest.mark.parametrize("wrist2", [0.0, math.pi])
def test_wrist_lock_is_singular(wrist2: float) -> None:
    assert smallest_singular_value(jacobian([0.3, -1.2, 1.5, -0.4, wrist2, 0.2])) < 1e-15


def test_near_elbow_lock_sigma_grows_with_the_elbow_angle() -> None:
    for elbow in (0.001, 0.01, 0.02):
        q = START.copy()
        q[2] = elbow
        assert smallest_singular_value(jacobian(q)) == pytest.approx(0.2405 * elbow, rel=0.01)


def test_the_last_joint_does_not_change_the_jacobian() -> None:
    turned = START.copy()
    turned[5] = 1.234
    np.testing.assert_array_equal(jacobian(turned), jacobian(START))


def test_tilt_is_the_angle_between_nozzle_and_wall_normal() -> None:
    T, R = pose(START), np.empty((3, 3))
    for degrees in (0.0, 0.01, 8.0, 26.0, 90.0, 150.0):
        for axis in ((0.0, 1.0, 0.0), (0.0, 0.6, 0.8)):
            rotation_matrix(math.radians(degrees) * np.array(axis), R)
            turned = np.eye(4)
            turned[:3, 2] = R @ np.array([1.0, 0.0, 0.0])
            assert math.degrees(tilt(turned)) == pytest.approx(degrees, abs=1e-9)
    assert T[0, 2] == pytest.approx(1.0)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-5, 0.3, 2.0, math.pi - 1e-7, math.pi])
def test_rotation_vector_undoes_rotation_matrix(angle: float) -> None:
    rng = np.random.default_rng(3)
    axis = rng.normal(size=3)
    vector = angle * axis / np.linalg.norm(axis)
    turn, start, out = np.empty((3, 3)), np.empty((3, 3)), np.empty(3)
    rotation_matrix(vector, turn)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-14)
    rotation_matrix(rng.normal(size=3), start)
    rotation_vector(start, turn @ start, out)
    if angle == math.pi:  # both directions are right at half a turn
        out *= np.sign(out @ vector)
    np.testing.assert_allclose(out, vector, atol=1e-9)
