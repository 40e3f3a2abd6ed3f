"""Every method of the source documents against its equation, written once more with NumPy's decomposition."""

from collections.abc import Callable

import numpy as np
import pytest

from data.study import Mode
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S, handle_jacobian
from sim_trials.modes.method import MEMORY_LENGTH
from sim_trials.modes.registry import METHODS, resolve
from sim_trials.modes.singular_slope import singular_slope
from sim_trials.singular_value import smallest_singular_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])
Equation = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def answer(method: str, q: np.ndarray, xdot: np.ndarray, **parameters: float) -> np.ndarray:
    mode, J, qdot = (
        resolve(Mode(name="X", method=method, parameters=parameters)),
        np.empty((6, 6)),
        np.empty(6),
    )
    handle_jacobian(q, J)
    mode.function(q, J, smallest_singular_value(J), xdot, 0.008, mode.packed(), np.zeros(MEMORY_LENGTH), qdot)
    return qdot


def samples(
    n: int, elbow: tuple[float, float] = (0.05, 1.7)
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    rng = np.random.default_rng(41)
    found = []
    for _ in range(n):
        q, J = START + rng.normal(scale=0.3, size=6), np.empty((6, 6))
        q[2] = rng.uniform(*elbow)
        handle_jacobian(q, J)
        found.append((q, J, rng.normal(scale=0.03, size=6)))
    return found


def limited(qdot: np.ndarray, share: float = 0.5) -> np.ndarray:
    return qdot / max(1.0, np.max(np.abs(qdot) / (share * np.array(JOINT_SPEED_LIMITS_RAD_S))))


def by_direction(J: np.ndarray, xdot: np.ndarray, gain: Callable[[float], float]) -> np.ndarray:
    U, sigma, Vt = np.linalg.svd(J)
    return sum(gain(s) * Vt[i] * (U[:, i] @ xdot) for i, s in enumerate(sigma))


def pseudo_inverse(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    return limited(np.linalg.pinv(J) @ xdot)


def transpose(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    moved = J @ J.T @ xdot
    return limited((xdot @ moved) / (moved @ moved) * (J.T @ xdot))


def constant_dls(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    return np.linalg.solve(J.T @ J + 0.15**2 * np.eye(6), J.T @ xdot)


def variable_damping_svd(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    def gain(s: float) -> float:
        return s / (s**2 + (0.2**2 * (1 - (3 * s**2 - 2 * s**3)) if s < 1 else 0.0))

    return by_direction(J, xdot, gain)


def h(s: float, sigma0: float) -> float:
    return (s**3 + 10 * s**2 + 2 * s + 2 * sigma0) / (s**2 + 10 * s + 2)


def singular_value_filtering(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    return limited(by_direction(J, xdot, lambda s: 1 / h(s, 0.1)))


def clamp(vector: np.ndarray, most: float) -> np.ndarray:
    return vector * min(1.0, most / np.abs(vector).max())


def sdls(J: np.ndarray, xdot: np.ndarray, gamma_max: float = 1.5) -> np.ndarray:
    U, sigma, Vt = np.linalg.svd(J)
    norms = np.linalg.norm(J[:3], axis=0) + np.linalg.norm(J[3:], axis=0)
    total = np.zeros(6)
    for i in range(6):
        n = np.linalg.norm(U[:3, i]) + np.linalg.norm(U[3:, i])
        m = np.abs(Vt[i]) @ norms / sigma[i]
        total += clamp(Vt[i] * (U[:, i] @ xdot) / sigma[i], min(1.0, n / m) * gamma_max)
    return clamp(total, gamma_max)


def selectively_damped_dls(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    return sdls(J, xdot)


def filtered_selectively_damped_dls(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    U, sigma, Vt = np.linalg.svd(J)
    return sdls(U @ np.diag([h(s, 0.05) for s in sigma]) @ Vt, xdot)


def joint_limit_damping(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    D = np.diag(0.15 + 0.5 * np.abs(q / (2 * np.pi)) ** 4)
    return np.linalg.solve(J.T @ J + D @ D, J.T @ xdot)


def damped(J: np.ndarray, xdot: np.ndarray, damping: np.ndarray) -> np.ndarray:
    return J.T @ np.linalg.solve(J @ J.T + damping, xdot)


def smallest(J: np.ndarray) -> float:
    return float(np.linalg.svd(J, compute_uv=False)[-1])


def chiaverini_dls(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    squared = 0.2**2 * max(0.0, 1 - (smallest(J) / 0.25) ** 2)
    return damped(J, xdot, squared * np.eye(6))


def numerical_filtering(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    lost = np.linalg.svd(J)[0][:, -1]
    squared = 0.2**2 * max(0.0, 1 - (smallest(J) / 0.25) ** 2)
    return damped(J, xdot, 0.02**2 * np.eye(6) + squared * np.outer(lost, lost))


def manipulability_dls(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    squared = 0.2**2 * max(0.0, 1 - abs(np.linalg.det(J)) / 0.15) ** 2
    return damped(J, xdot, squared * np.eye(6))


def dls_then_transpose(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    if smallest(J) < 0.05:
        return transpose(q, J, xdot)
    damping = 0.2 * max(0.0, 1 - smallest(J) / 0.25) ** 2
    return limited(damped(J, xdot, damping**2 * np.eye(6)))


def jparse(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    """By its matrices: safety Jacobian, projection, scaled singular directions."""
    U, sigma, Vt = np.linalg.svd(J)
    is_singular = sigma <= 0.1 * sigma[0]
    safety = U @ np.diag(np.where(is_singular, 0.1 * sigma[0], sigma)) @ Vt
    kept = U[:, ~is_singular] @ U[:, ~is_singular].T
    lost = U[:, is_singular] @ np.diag(sigma[is_singular] / (0.1 * sigma[0])) @ U[:, is_singular].T
    return limited(np.linalg.inv(safety) @ (kept + lost) @ xdot)


def singularity_barrier(q: np.ndarray, J: np.ndarray, xdot: np.ndarray) -> np.ndarray:
    """The quadratic programme by its conditions of optimality, the slope of sigma by finite differences."""
    slope, step = np.empty(6), 1e-6
    for i in range(6):
        sigmas = []
        for way in (step, -step):
            moved, J_moved = q.copy(), np.empty((6, 6))
            moved[i] += way
            handle_jacobian(moved, J_moved)
            sigmas.append(smallest(J_moved))
        slope[i] = (sigmas[0] - sigmas[1]) / (2 * step)
    H, c = J.T @ J + 0.01**2 * np.eye(6), J.T @ xdot
    qdot = np.linalg.solve(H, c)
    least = min(0.0, -5.0 * (smallest(J) - 0.03))
    if slope @ qdot < least:
        bordered = np.block([[H, -slope[:, None]], [slope[None, :], np.zeros((1, 1))]])
        qdot = np.linalg.solve(bordered, np.append(c, least))[:6]
    return limited(qdot)


EQUATIONS: tuple[Equation, ...] = (
    chiaverini_dls,
    numerical_filtering,
    manipulability_dls,
    dls_then_transpose,
    jparse,
    pseudo_inverse,
    transpose,
    constant_dls,
    variable_damping_svd,
    singular_value_filtering,
    selectively_damped_dls,
    filtered_selectively_damped_dls,
    joint_limit_damping,
)


@pytest.mark.parametrize("equation", EQUATIONS, ids=lambda equation: equation.__name__)
def test_method_is_its_equation(equation: Equation) -> None:
    for q, J, xdot in samples(100):
        np.testing.assert_allclose(
            answer(equation.__name__, q, xdot), equation(q, J, xdot), rtol=1e-7, atol=1e-10
        )


def test_the_barrier_is_its_quadratic_programme_and_binds_in_many_poses() -> None:
    bound = 0
    for q, J, xdot in samples(200, elbow=(0.02, 0.8)):
        expected = singularity_barrier(q, J, xdot)
        np.testing.assert_allclose(answer("singularity_barrier", q, xdot), expected, rtol=1e-5, atol=1e-8)
        bound += not np.allclose(expected, limited(np.linalg.solve(J.T @ J + 1e-4 * np.eye(6), J.T @ xdot)))
    assert 30 < bound < 170


def test_the_slope_of_sigma_is_that_of_finite_differences() -> None:
    for q, J, _ in samples(100, elbow=(0.02, 1.7)):
        U, _, Vt = np.linalg.svd(J)
        slope = np.empty(6)
        singular_slope(J, U[:, 5].copy(), Vt[5].copy(), slope)
        for i in range(6):
            sigmas = []
            for way in (1e-5, -1e-5):
                moved, J_moved = q.copy(), np.empty((6, 6))
                moved[i] += way
                handle_jacobian(moved, J_moved)
                sigmas.append(np.linalg.svd(J_moved, compute_uv=False)[-1])
            assert slope[i] == pytest.approx((sigmas[0] - sigmas[1]) / 2e-5, rel=1e-5, abs=1e-8)


def test_jparse_scales_commands_along_the_lost_direction_down_to_nothing() -> None:
    for q, J, _ in samples(20, elbow=(0.001, 0.05)):
        U, sigma, _ = np.linalg.svd(J)
        done = J @ answer("jparse", q, 0.01 * U[:, 5].copy())
        assert U[:, 5] @ done == pytest.approx(0.01 * (sigma[5] / (0.1 * sigma[0])) ** 2, rel=1e-6)


@pytest.mark.parametrize("sigma", [0.0, 0.3, 0.9])
def test_equation_29_of_beaudoin_is_a_damping_once_its_last_sign_is_changed(sigma: float) -> None:
    """As printed it is negative; with its first sign changed it is -lambda^2 at a singular value of 0."""
    J, xdot, qdot = np.diag([sigma, 1, 1, 1, 1, 1.0]), np.eye(6)[0].copy(), np.empty(6)
    mode = resolve(Mode(name="X", method="variable_damping_svd", parameters={"lambda": 0.2, "sigma_t": 1.0}))
    mode.function(np.zeros(6), J, sigma, xdot, 0.008, mode.packed(), np.zeros(MEMORY_LENGTH), qdot)
    shape = 3 * sigma**2 - 2 * sigma**3
    assert -(0.2**2) * shape - 0.2**2 < 0.0
    last_changed = -(0.2**2) * shape + 0.2**2
    assert qdot[0] == pytest.approx(sigma / (sigma**2 + last_changed))
    assert "whose last minus sign is a misprint" in METHODS["variable_damping_svd"].source


def test_selective_damping_holds_back_some_directions_and_lets_others_go() -> None:
    held = sum(
        not np.allclose(answer("selectively_damped_dls", q, 5 * x), np.linalg.solve(J, 5 * x), rtol=1e-6)
        for q, J, x in samples(100)
    )
    free = sum(
        np.allclose(answer("selectively_damped_dls", q, x / 5), np.linalg.solve(J, x / 5), rtol=1e-6)
        for q, J, x in samples(100, elbow=(1.2, 1.7))
    )
    assert held > 60
    assert free > 60


def test_a_direction_below_zero_below_gets_no_motion() -> None:
    for q, J, xdot in samples(20, elbow=(0.01, 0.1)):
        lost = np.linalg.svd(J)[0][:, 5]
        qdot = answer("pseudo_inverse", q, xdot, zero_below=0.1)
        assert abs(lost @ J @ qdot) < 1e-12


def test_the_transpose_of_a_lost_direction_is_no_motion_and_not_a_quotient_of_zeros() -> None:
    q = START.copy()
    q[2] = 0.0
    J = np.empty((6, 6))
    handle_jacobian(q, J)
    xdot = np.linalg.svd(J)[0][:, 5].copy()
    qdot = answer("transpose", q, xdot)
    assert np.isfinite(qdot).all()
    assert np.abs(J @ qdot).max() < 1e-6


def test_joints_near_the_end_of_their_range_move_less() -> None:
    q = START.copy()
    near = answer("joint_limit_damping", q, 0.1 * np.eye(6)[1], range_rad=3.5, c=5.0)
    far = answer("joint_limit_damping", q, 0.1 * np.eye(6)[1])
    assert abs(near[0]) < 0.5 * abs(far[0])


class TestConditionScaling:
    """Slow from 17, stop from 30, twice as wide when leaving."""

    def scale_and_condition(self, elbow: float, way: float) -> tuple[float, float]:
        q, J = START.copy(), np.empty((6, 6))
        q[2] = elbow
        handle_jacobian(q, J)
        bend = J @ np.array([0.0, 0.0, way * 0.01, 0.0, 0.0, 0.0])
        qdot, plain = answer("condition_scaling", q, bend), np.linalg.solve(J, bend)
        return float(qdot @ plain / (plain @ plain)), float(np.linalg.cond(J))

    def test_it_slows_down_linearly_towards_and_half_as_much_leaving(self) -> None:
        slowed = 0
        for elbow in np.linspace(0.2, 1.2, 60):
            towards, condition = self.scale_and_condition(elbow, -1.0)
            leaving, _ = self.scale_and_condition(elbow, 1.0)
            if condition >= 30.0:
                assert towards == leaving == 0.0
                continue
            over = max(condition - 17.0, 0.0) / 13.0
            slowed += over > 0.0
            assert towards == pytest.approx(1.0 - over, abs=1e-9)
            assert leaving == pytest.approx(1.0 - over / 2.0, abs=1e-9)
        assert slowed > 5
