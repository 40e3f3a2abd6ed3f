"""The decomposition against NumPy's, at ordinary poses and in exact and nearly exact locks."""

import itertools

import numpy as np
import pytest

from sim_trials.kinematics import handle_jacobian
from sim_trials.modes.decomposition import decompose, recompose
from sim_trials.modes.filtered_value import filtered_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])


def jacobians() -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    poses = [np.zeros(6), *rng.uniform(-np.pi, np.pi, (60, 6))]
    for elbow, wrist in itertools.product((0.0, 1e-15, 1e-9, 1e-3, 1.7), repeat=2):
        q = START + rng.normal(scale=0.3, size=6)
        q[2], q[4] = elbow, wrist
        poses.append(q)
    found = []
    for q in poses:
        J = np.empty((6, 6))
        handle_jacobian(q, J)
        found.append(J)
    return found


SPECIAL = [
    np.zeros((6, 6)),
    np.eye(6),
    np.diag([3.0, 2.0, 1.0, 0.0, 0.0, 0.0]),
    np.ones((6, 6)),
    1e-60 * np.eye(6),
]


def decomposed(J: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    U, sigma, V = np.empty((6, 6)), np.empty(6), np.empty((6, 6))
    decompose(J, U, sigma, V)
    return U, sigma, V


@pytest.mark.parametrize("J", [*jacobians(), *SPECIAL])
def test_it_is_a_singular_value_decomposition(J: np.ndarray) -> None:
    U, sigma, V = decomposed(J.copy())
    largest = max(np.abs(J).max(), 1e-300)
    np.testing.assert_allclose(sigma, np.linalg.svd(J, compute_uv=False), atol=1e-14 * 6 * largest)
    assert (np.diff(sigma) <= 0.0).all()
    np.testing.assert_allclose(U @ U.T, np.eye(6), atol=1e-13)
    np.testing.assert_allclose(V @ V.T, np.eye(6), atol=1e-13)
    np.testing.assert_allclose(U.T @ np.diag(sigma) @ V, J, atol=1e-14 * 6 * largest)


def test_gains_of_one_over_sigma_give_the_inverse() -> None:
    rng = np.random.default_rng(4)
    for J in jacobians()[1:40]:
        U, sigma, V = decomposed(J)
        xdot, qdot = rng.normal(size=6), np.empty(6)
        recompose(U, 1.0 / sigma, V, xdot, qdot)
        np.testing.assert_allclose(J @ qdot, xdot, atol=1e-9)


@pytest.mark.parametrize("nu", [0.1, 10.0, 100.0])
def test_the_filter_is_sigma0_at_zero_and_never_below_sigma(nu: float) -> None:
    assert filtered_value(0.0, 0.05, nu) == pytest.approx(0.05)
    for s in np.linspace(0.0, 5.0, 40):
        value = filtered_value(s, 0.05, nu)
        printed = (s**3 + nu * s**2 + 2 * s + 2 * 0.05) / (s**2 + nu * s + 2)
        assert value == pytest.approx(printed, rel=1e-13)
        assert value > s
