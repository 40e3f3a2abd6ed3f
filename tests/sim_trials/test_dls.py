"""Modes M1 and M2 against eqs. (1) and (2) written independently, and against what is known of them."""

import numpy as np
import pytest

from data.study import Mode
from data.study_file import read_study
from sim_trials.kinematics import handle_jacobian
from sim_trials.modes.method import MEMORY_LENGTH, ResolvedMode
from sim_trials.modes.registry import resolve
from sim_trials.singular_value import smallest_singular_value

STUDY_MODES = {mode.name: mode for mode in read_study("carmichael2017").modes}


def qdot_of(mode: ResolvedMode, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    out = np.empty(6)
    J = np.ascontiguousarray(J)
    sigma = smallest_singular_value(J)
    mode.function(np.zeros(6), J, sigma, xdot, 0.008, mode.packed(), np.zeros(MEMORY_LENGTH), out)
    return out


def equations_1_and_2(J: np.ndarray, xdot: np.ndarray, lambda0: float, sigma_t: float) -> np.ndarray:
    """By the singular value decomposition: J* = sum of v s / (s^2 + lambda^2) u'."""
    u, s, vt = np.linalg.svd(J)
    damping = lambda0 * (1 - s[-1] / sigma_t) ** 2 if s[-1] < sigma_t else 0.0
    return vt.T @ (s / (s**2 + damping**2) * (u.T @ xdot))


@pytest.mark.parametrize("name", ["M1", "M2"])
def test_follows_equations_1_and_2(name: str) -> None:
    mode = resolve(STUDY_MODES[name])
    lambda0 = {"M1": 0.2, "M2": 0.6}[name]
    rng = np.random.default_rng(31)
    J = np.empty((6, 6))
    for k in range(400):
        q = rng.uniform(-np.pi, np.pi, 6)
        if k % 2:
            q[2] = rng.normal(scale=0.05)
        handle_jacobian(q, J)
        xdot = rng.normal(size=6)
        expected = equations_1_and_2(J, xdot, lambda0, 0.25)
        np.testing.assert_allclose(qdot_of(mode, J, xdot), expected, rtol=1e-9, atol=1e-9)


def test_m1_with_lambda0_of_m2_is_m2_bit_for_bit() -> None:
    m1, m2 = STUDY_MODES["M1"], resolve(STUDY_MODES["M2"])
    changed = resolve(m1.model_copy(update={"parameters": {**m1.parameters, "lambda0": 0.6}}))
    rng = np.random.default_rng(37)
    J = np.empty((6, 6))
    for _ in range(100):
        handle_jacobian(rng.uniform(-np.pi, np.pi, 6), J)
        xdot = rng.normal(size=6)
        assert qdot_of(changed, J, xdot).tobytes() == qdot_of(m2, J, xdot).tobytes()


@pytest.mark.parametrize(("lambda0", "peak", "at_sigma"), [(0.2, 6.93, 0.119), (0.6, 5.22, 0.175)])
def test_gain_peaks_where_the_schedule_says(lambda0: float, peak: float, at_sigma: float) -> None:
    mode = resolve(Mode(name="X", method="dls", parameters={"lambda0": lambda0, "sigma_t": 0.25}))
    sigmas = np.arange(0.001, 0.25, 0.001)
    gains = [np.linalg.norm(qdot_of(mode, np.diag([sigma, 1, 1, 1, 1, 1]), np.eye(6)[0])) for sigma in sigmas]
    assert max(gains) == pytest.approx(peak, abs=0.01)
    assert sigmas[np.argmax(gains)] == pytest.approx(at_sigma, abs=0.0011)


def test_joint_speed_is_bounded_by_half_the_command_over_lambda() -> None:
    """|qdot| <= |xdot| / (2 lambda), with lambda as it is at the present sigma."""
    rng = np.random.default_rng(41)
    J = np.empty((6, 6))
    for name, lambda0 in (("M1", 0.2), ("M2", 0.6)):
        mode = resolve(STUDY_MODES[name])
        for _ in range(200):
            q = rng.uniform(-np.pi, np.pi, 6)
            q[2] = rng.normal(scale=0.2)
            handle_jacobian(q, J)
            sigma = smallest_singular_value(J)
            damping = lambda0 * (1 - sigma / 0.25) ** 2 if sigma < 0.25 else 0.0
            xdot = rng.normal(size=6)
            speed = np.linalg.norm(qdot_of(mode, J, xdot))
            assert 2 * damping * speed <= np.linalg.norm(xdot) * (1 + 1e-9)


def test_heavier_damping_moves_less_near_the_lock() -> None:
    J = np.empty((6, 6))
    handle_jacobian(np.array([3.45, -1.42, 0.05, -0.3, 1.88, 0.0]), J)
    xdot = np.array([0.0, -0.1, 0.0, 0.0, 0.0, 0.0])
    light, heavy = (np.linalg.norm(qdot_of(resolve(STUDY_MODES[name]), J, xdot)) for name in ("M1", "M2"))
    assert heavy < light
