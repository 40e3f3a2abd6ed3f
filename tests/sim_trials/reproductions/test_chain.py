"""Forward kinematics and Jacobian of a Denavit-Hartenberg table."""

import numpy as np
import pytest

from sim_trials.reproductions.beaudoin2022.robot import ARM
from sim_trials.reproductions.chain import Chain, Convention, jacobian, posture
from sim_trials.reproductions.mulumbwa.arms import (
    PLANAR_LENGTHS_M,
    humanoid,
    planar_jacobian,
    planar_position,
)
from sim_trials.reproductions.mulumbwa.claims import is_three_one_three

ARMS = {"beaudoin": ARM, **{c.value: humanoid(c) for c in Convention}}


@pytest.mark.parametrize("name", ARMS)
def test_the_jacobian_agrees_with_finite_differences(name: str) -> None:
    chain = ARMS[name]
    n, h = len(chain.a), 1e-6
    q = np.random.default_rng(3).uniform(-2, 2, n)
    here = posture(chain, q)
    J = jacobian(here, here.end[:3, 3])
    for i in range(n):
        ahead, behind = (posture(chain, q + sign * h * np.eye(n)[i]).end for sign in (1, -1))
        np.testing.assert_allclose(J[:3, i], (ahead[:3, 3] - behind[:3, 3]) / (2 * h), atol=1e-8)
        W = (ahead[:3, :3] - behind[:3, :3]) / (2 * h) @ here.end[:3, :3].T
        np.testing.assert_allclose(J[3:, i], [W[2, 1], W[0, 2], W[1, 0]], atol=1e-8)


def test_one_standard_row_is_the_matrix_of_equation_1() -> None:
    a, d, alpha, theta = 0.4, 0.2, 0.7, -1.1
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    printed = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
    end = posture(Chain((a,), (d,), (alpha,), (0.0,)), np.array([theta])).end
    np.testing.assert_allclose(end, printed, atol=1e-15)


def test_the_planar_arm_is_the_chain_of_its_three_links() -> None:
    q = np.array([0.4, -1.2, 0.7])
    here = posture(Chain(PLANAR_LENGTHS_M, (0.0,) * 3, (0.0,) * 3, (0.0,) * 3), q)
    np.testing.assert_allclose(planar_position(q), here.end[:2, 3], atol=1e-14)
    np.testing.assert_allclose(planar_jacobian(q), jacobian(here, here.end[:3, 3])[:2], atol=1e-14)


def test_only_the_modified_convention_makes_table_1_the_arm_described() -> None:
    assert is_three_one_three(Convention.MODIFIED)
    assert not is_three_one_three(Convention.STANDARD)
