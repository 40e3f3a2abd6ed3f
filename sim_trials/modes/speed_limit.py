"""Joint speeds kept below a share of what the robot can do, the direction of motion unchanged."""

import numpy as np

from sim_trials.compiled import compiled
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S

_SPEED_LIMITS = JOINT_SPEED_LIMITS_RAD_S


@compiled("void(float64[::1], float64)")
def limit_speed(qdot: np.ndarray, speed_share: float) -> None:
    """Scale all joint velocities together, so that none passes ``speed_share`` of its joint's limit.

    The robot stops itself at 0.98 of a limit (``loop.JOINT_SPEED_SHARE``): a method that stays below never
    makes it do so.

    Parameters
    ----------
    qdot : ndarray, shape (6,), changed
        Joint velocities [rad/s].
    speed_share : float
        Share of the limits in ``kinematics.JOINT_SPEED_LIMITS_RAD_S``.
    """
    excess = 1.0
    for i in range(6):
        excess = max(excess, abs(qdot[i]) / (speed_share * _SPEED_LIMITS[i]))
    for i in range(6):
        qdot[i] /= excess
