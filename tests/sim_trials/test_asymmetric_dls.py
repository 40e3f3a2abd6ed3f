"""Mode M3 against an independent implementation on MuJoCo's Jacobian and NumPy's decomposition."""

import mujoco
import numpy as np
import pytest

from data.study import Mode
from data.study_file import read_study
from sim_trials.kinematics import handle_jacobian
from sim_trials.model import Robot, new_robot
from sim_trials.modes.method import MEMORY_LENGTH, ResolvedMode
from sim_trials.modes.registry import resolve
from sim_trials.singular_value import smallest_singular_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])
M3 = resolve(next(mode for mode in read_study("carmichael2017").modes if mode.name == "M3"))


def qdot_of(mode: ResolvedMode, q: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    J, out = np.empty((6, 6)), np.empty(6)
    handle_jacobian(q, J)
    sigma = smallest_singular_value(J)
    mode.function(q, J, sigma, xdot, 0.008, mode.packed(), np.zeros(MEMORY_LENGTH), out)
    return out


def mujoco_jacobian(robot: Robot, q: np.ndarray) -> np.ndarray:
    J = np.zeros((6, 6))
    robot.place(q)
    mujoco.mj_jacSite(robot.model, robot.data, J[:3], J[3:], robot.model.site("handle").id)
    return J


def damped(J: np.ndarray, xdot: np.ndarray, lambda0: float) -> np.ndarray:
    sigma = np.linalg.svd(J, compute_uv=False)[-1]
    damping = lambda0 * (1 - sigma / 0.25) ** 2 if sigma < 0.25 else 0.0
    return J.T @ np.linalg.solve(J @ J.T + damping**2 * np.eye(6), xdot)


def approaching(robot: Robot, q: np.ndarray, xdot: np.ndarray) -> bool:
    J = mujoco_jacobian(robot, q)
    ahead = mujoco_jacobian(robot, q + 0.01 * damped(J, xdot, 0.6))
    return bool(np.linalg.svd(ahead, compute_uv=False)[-1] < np.linalg.svd(J, compute_uv=False)[-1])


def near_lock_samples(n: int) -> list[tuple[np.ndarray, np.ndarray]]:
    rng = np.random.default_rng(43)
    samples = []
    for _ in range(n):
        q = START + rng.normal(scale=0.4, size=6)
        q[2] = rng.uniform(0.05, 0.9)
        samples.append((q, rng.normal(scale=0.1, size=6)))
    return samples


def test_damps_heavily_towards_the_singularity_and_lightly_away() -> None:
    robot = new_robot(START)
    seen = {True: 0, False: 0}
    for q, xdot in near_lock_samples(200):
        towards = approaching(robot, q, xdot)
        expected = damped(mujoco_jacobian(robot, q), xdot, 0.6 if towards else 0.2)
        np.testing.assert_allclose(qdot_of(M3, q, xdot), expected, rtol=1e-8, atol=1e-10)
        seen[towards] += 1
    assert min(seen.values()) > 40


def test_stretching_the_arm_feels_like_m2_and_bending_it_like_m1() -> None:
    q = START.copy()
    q[2] = 0.3
    J = np.empty((6, 6))
    handle_jacobian(q, J)
    bend = J @ np.array([0.0, 0.0, 0.05, 0.0, 0.0, 0.0])
    m1, m2 = (resolve(Mode(name="X", method="dls", parameters={"lambda0": v})) for v in (0.2, 0.6))
    np.testing.assert_array_equal(qdot_of(M3, q, -bend), qdot_of(m2, q, -bend))
    np.testing.assert_array_equal(qdot_of(M3, q, bend), qdot_of(m1, q, bend))


@pytest.mark.parametrize("lambda0", [0.2, 0.6])
def test_with_equal_dampings_it_is_plain_dls_bit_for_bit(lambda0: float) -> None:
    equal = resolve(
        Mode(
            name="X",
            method="asymmetric_dls",
            parameters={"lambda0_towards": lambda0, "lambda0_away": lambda0},
        )
    )
    plain = resolve(Mode(name="Y", method="dls", parameters={"lambda0": lambda0}))
    for q, xdot in near_lock_samples(100):
        assert qdot_of(equal, q, xdot).tobytes() == qdot_of(plain, q, xdot).tobytes()


def test_length_of_the_displacement_hardly_matters() -> None:
    short, long = (
        resolve(Mode(name="X", method="asymmetric_dls", parameters={"displacement_s": v}))
        for v in (0.001, 0.05)
    )
    samples = near_lock_samples(300)
    same = sum(np.array_equal(qdot_of(short, q, xdot), qdot_of(long, q, xdot)) for q, xdot in samples)
    assert same >= 0.97 * len(samples)
