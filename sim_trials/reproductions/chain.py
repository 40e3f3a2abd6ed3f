"""Serial chains of revolute joints from a Denavit-Hartenberg table, standard or modified."""

from dataclasses import dataclass
from enum import Enum

import numpy as np


class Convention(Enum):
    """Where a row's length and twist act: after its joint (standard) or before it (modified, Craig)."""

    STANDARD = "standard"
    MODIFIED = "modified"


@dataclass(frozen=True)
class Chain:
    """A serial arm of n revolute joints.

    Attributes
    ----------
    a, d, alpha, offset : tuple of float, length n
        Link length [m], joint distance [m], link twist [rad], and what is added to the joint angle [rad].
    convention : Convention
    """

    a: tuple[float, ...]
    d: tuple[float, ...]
    alpha: tuple[float, ...]
    offset: tuple[float, ...]
    convention: Convention = Convention.STANDARD


@dataclass(frozen=True)
class Posture:
    """Where the joints of a chain are, in the base frame.

    Attributes
    ----------
    axes : ndarray, shape (n, 3)
        Unit vectors of the joint axes.
    centres : ndarray, shape (n, 3)
        A point on each axis: the origin of the frame the joint turns [m].
    end : ndarray, shape (4, 4)
        Pose of the last frame.
    """

    axes: np.ndarray
    centres: np.ndarray
    end: np.ndarray


def posture(chain: Chain, q: np.ndarray) -> Posture:
    """Forward kinematics at joint angles ``q`` [rad], shape (n,)."""
    n = len(chain.a)
    T = np.eye(4)
    axes, centres = np.empty((n, 3)), np.empty((n, 3))
    for i in range(n):
        twist = _twist(chain.a[i], chain.alpha[i])
        turn = _turn(q[i] + chain.offset[i], chain.d[i])
        if chain.convention is Convention.MODIFIED:
            T = T @ twist
        axes[i], centres[i] = T[:3, 2], T[:3, 3]
        T = T @ turn
        if chain.convention is Convention.STANDARD:
            T = T @ twist
    return Posture(axes, centres, T)


def jacobian(arm: Posture, point: np.ndarray) -> np.ndarray:
    """Geometric Jacobian of a point [m] on the last link, base frame, rows linear then angular, (6, n)."""
    linear = np.cross(arm.axes, point - arm.centres)
    return np.vstack([linear.T, arm.axes.T])


def _turn(theta: float, d: float) -> np.ndarray:
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])


def _twist(a: float, alpha: float) -> np.ndarray:
    c, s = np.cos(alpha), np.sin(alpha)
    return np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
