"""SVF+SDLS on the 7-DOF arm with Euler angles, with set switching, and with joint limits: section 4.2."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sim_trials.reproductions.chain import Chain, jacobian, posture
from sim_trials.reproductions.mulumbwa import euler
from sim_trials.reproductions.mulumbwa.arms import HUMANOID_START
from sim_trials.reproductions.mulumbwa.joint_limits import violated
from sim_trials.reproductions.solvers import selectively_damped, singular_value_filtering

MAIN_SET = (1, 2, 3)
"""The thesis names its angles roll, pitch and yaw but no set; Table 2's first."""
NULL_SPACE_GAIN = 0.2
JUMP = 0.5
"""A joint step of more than this [rad] after the first ten iterations counts as a jump."""
Secondary = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class HumanoidRun:
    """One solve, one row per iteration.

    Attributes
    ----------
    q : ndarray, shape (n + 1, 7)
        Joint angles [rad].
    position_error_m, attitude_error : ndarray, shape (n + 1,)
        Distance to the target [m], angle to the wanted orientation [rad].
    switches : int
        Iterations in the alternative set.
    """

    q: np.ndarray
    position_error_m: np.ndarray
    attitude_error: np.ndarray
    switches: int

    @property
    def jumps(self) -> int:
        """Joint steps above `JUMP` once the arm has had ten iterations to get there."""
        return int((np.abs(np.diff(self.q[10:], axis=0)) > JUMP).sum())

    @property
    def travel(self) -> float:
        """Sum of all joint turns [rad]."""
        return float(np.abs(np.diff(self.q, axis=0)).sum())

    @property
    def violated(self) -> int:
        """Joints outside table 1's range at the end."""
        return violated(self.q[-1])


def solve(
    chain: Chain,
    target: tuple[float, ...],
    *,
    order: euler.AngleSet = MAIN_SET,
    switches_sets: bool,
    secondary: Secondary | None = None,
    start: np.ndarray = HUMANOID_START,
    gamma_max: float = np.pi / 4,
    n: int = 100,
) -> HumanoidRun:
    """SVF+SDLS in Euler coordinates (section 3.2.2), the wanted orientation switched along (3.2.3)."""
    q = np.array(start, float)
    wanted = euler.rotation(np.array(target[3:]), order)
    qs, far, turned, switched = [q], [], [], 0
    for k in range(n + 1):
        arm = posture(chain, q)
        R, p = arm.end[:3, :3], arm.end[:3, 3]
        far.append(float(np.linalg.norm(np.array(target[:3]) - p)))
        turned.append(float(np.arccos(np.clip((np.trace(R.T @ wanted) - 1.0) / 2.0, -1.0, 1.0))))
        if k == n:
            break
        now = (
            euler.switched(R, MAIN_SET)
            if switches_sets
            else euler.Attitude(euler.angles_of(R, MAIN_SET), MAIN_SET)
        )
        switched += now.set != MAIN_SET
        difference = euler.angles_of(wanted, now.set) - now.angles
        J = jacobian(arm, p)
        J[3:] = np.linalg.pinv(euler.rate_matrix(now.angles, now.set)) @ J[3:]
        filtered = singular_value_filtering.filtered(J)
        e = np.concatenate([np.array(target[:3]) - p, difference])
        step = selectively_damped.step(filtered, e, gamma_max)
        if secondary is not None:
            projector = np.eye(7) - np.linalg.pinv(filtered) @ filtered
            step = step + NULL_SPACE_GAIN * (projector @ secondary(q))
        q = q + step
        qs.append(q)
    return HumanoidRun(np.array(qs), np.array(far), np.array(turned), switched)
