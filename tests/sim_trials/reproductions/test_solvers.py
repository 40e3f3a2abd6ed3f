"""The inverse kinematics solvers of the source documents."""

import numpy as np
import pytest

from sim_trials.reproductions.solvers import (
    damped_least_squares,
    jacobian_transpose,
    pseudo_inverse,
    selectively_damped,
    singular_value_filtering,
    variable_damping,
)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(11)


def test_the_pseudo_inverse_reaches_what_can_be_reached_with_the_least_norm(rng: np.random.Generator) -> None:
    J, e = rng.standard_normal((2, 3)), rng.standard_normal(2)
    dq = pseudo_inverse.step(J, e)
    free = np.linalg.svd(J)[2][-1]
    np.testing.assert_allclose(J @ dq, e, atol=1e-12)
    assert abs(dq @ free) < 1e-12


def test_damped_steps_are_bounded_by_the_error_over_twice_the_damping(rng: np.random.Generator) -> None:
    for _ in range(50):
        J, e = rng.standard_normal((2, 3)) * rng.choice([1e-3, 1.0, 10.0]), rng.standard_normal(2)
        assert np.linalg.norm(damped_least_squares.step(J, e, 0.3)) <= np.linalg.norm(e) / 0.6 + 1e-12


def test_equations_9_and_19_give_the_same_step(rng: np.random.Generator) -> None:
    J, e = rng.standard_normal((2, 3)), rng.standard_normal(2)
    one = damped_least_squares.step(J, e, 0.3)
    np.testing.assert_allclose(one, damped_least_squares.spectral_step(J, e, 0.3), atol=1e-13)


def test_variable_damping_is_largest_at_zero_and_gone_at_one() -> None:
    sigma = np.array([0.0, 0.5, 1.0, 3.0])
    np.testing.assert_allclose(
        variable_damping.damping_squared(sigma, 0.2), [0.04, 0.02, 0.0, 0.0], atol=1e-16
    )
    assert (variable_damping.printed_damping_squared(sigma[:2], 0.2) < 0).all()


def test_the_transpose_leaves_an_error_orthogonal_to_the_motion(rng: np.random.Generator) -> None:
    J, e = rng.standard_normal((3, 4)), rng.standard_normal(3)
    moved = J @ jacobian_transpose.step(J, e)
    assert abs(moved @ (e - moved)) < 1e-12


def test_the_transpose_stands_still_where_the_error_cannot_be_reduced() -> None:
    J = np.array([[1.0, 1.0], [0.0, 0.0]])
    np.testing.assert_array_equal(jacobian_transpose.step(J, np.array([0.0, 1.0])), 0.0)


def test_filtering_lifts_zero_to_sigma_0_by_the_published_amount() -> None:
    sigma = np.array([0.0, 0.01, 0.3, 5.0])
    lifted = singular_value_filtering.lifted(sigma)
    assert lifted[0] == pytest.approx(0.005, abs=1e-15)
    np.testing.assert_allclose(lifted - sigma, 2 * 0.005 / (sigma**2 + 10 * sigma + 2), atol=1e-15)


def test_a_filtered_jacobian_has_full_rank_at_a_singularity() -> None:
    J = np.array([[0.0, 0.0, 0.0], [7.0, 5.0, 2.0]])
    sigma = np.linalg.svd(singular_value_filtering.filtered(J), compute_uv=False)
    assert sigma[-1] == pytest.approx(0.005, abs=1e-12)
    assert singular_value_filtering.condition_number(np.linalg.svd(J, compute_uv=False)) == pytest.approx(
        sigma[0] / sigma[-1]
    )


@pytest.mark.parametrize("rows", [2, 3, 6])
def test_selective_damping_never_turns_a_joint_by_more_than_allowed(
    rows: int, rng: np.random.Generator
) -> None:
    for _ in range(30):
        J, e = rng.standard_normal((rows, 7)), 100 * rng.standard_normal(rows)
        assert np.abs(selectively_damped.step(J, e, 0.4)).max() <= 0.4 + 1e-12


def test_selective_damping_takes_the_full_step_where_the_error_is_small(rng: np.random.Generator) -> None:
    J, e = rng.standard_normal((2, 3)), 1e-4 * rng.standard_normal(2)
    np.testing.assert_allclose(selectively_damped.step(J, e, np.pi / 4), np.linalg.pinv(J) @ e, atol=1e-15)
