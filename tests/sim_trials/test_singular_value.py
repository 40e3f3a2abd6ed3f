"""The smallest singular value against NumPy's full decomposition, down to exact singularity."""

import numpy as np
import pytest

from sim_trials.kinematics import handle_jacobian
from sim_trials.singular_value import smallest_singular_value


def jacobians(n: int, elbow: np.ndarray | None = None) -> np.ndarray:
    rng = np.random.default_rng(11)
    J = np.empty((n, 6, 6))
    for k in range(n):
        q = rng.uniform(-np.pi, np.pi, 6)
        if elbow is not None:
            q[2] = elbow[k]
        handle_jacobian(q, J[k])
    return J


def with_singular_values(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    left, right = (np.linalg.qr(rng.normal(size=(6, 6)))[0] for _ in range(2))
    return np.ascontiguousarray(left @ np.diag(values) @ right)


def test_agrees_with_numpy_over_the_whole_workspace() -> None:
    for J in jacobians(2000):
        values = np.linalg.svd(J, compute_uv=False)
        assert abs(smallest_singular_value(J) - values[-1]) <= 2e-15 * values[0]


def test_keeps_its_digits_near_elbow_lock() -> None:
    elbow = 10.0 ** np.random.default_rng(5).uniform(-9, -1, 500)
    for J in jacobians(500, elbow):
        values = np.linalg.svd(J, compute_uv=False)
        assert abs(smallest_singular_value(J) - values[-1]) <= 2e-15 * values[0]


def test_agrees_where_singular_values_coincide() -> None:
    rng = np.random.default_rng(6)
    for k in range(300):
        values = 10.0 ** rng.uniform(-5, 0, 6)
        values[: 1 + k % 5] = values.min()
        expected = np.sort(values)[0]
        assert smallest_singular_value(with_singular_values(values, rng)) == pytest.approx(
            expected, abs=1e-13 * values.max()
        )


@pytest.mark.parametrize(
    ("matrix", "expected"),
    [
        (np.zeros((6, 6)), 0.0),
        (np.ones((6, 6)), 0.0),
        (np.eye(6), 1.0),
        (np.diag([0.0, 1, 2, 3, 4, 5]), 0.0),
        (np.diag([5.0, 4, 0, 3, 2, 1]), 0.0),
        (np.diag([3.0, 3, 3, 3, 3, 1e-9]), 1e-9),
        (np.diag([1e-300, 1, 1, 1, 1, 1]), 0.0),
    ],
)
def test_known_matrices(matrix: np.ndarray, expected: float) -> None:
    assert smallest_singular_value(np.ascontiguousarray(matrix)) == pytest.approx(
        expected, rel=1e-12, abs=1e-15
    )


def test_leaves_the_matrix_as_it_was() -> None:
    J = jacobians(1)[0]
    before = J.copy()
    smallest_singular_value(J)
    np.testing.assert_array_equal(J, before)
