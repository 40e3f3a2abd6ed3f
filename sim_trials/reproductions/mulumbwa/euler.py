"""The six asymmetric Euler angle sets, their gimbal lock, and switching between them: sections 2.4.6, 3.2.3.

A set l m n stands for R = R_l(a) R_m(b) R_n(c), the axes counted from 1. It locks where the middle angle is
+-90 deg.
"""

from dataclasses import dataclass

import numpy as np

AngleSet = tuple[int, int, int]
SETS: tuple[AngleSet, ...] = ((1, 2, 3), (1, 3, 2), (2, 1, 3), (2, 3, 1), (3, 1, 2), (3, 2, 1))
PUBLISHED_ALTERNATIVES: dict[AngleSet, tuple[AngleSet, AngleSet]] = {
    (1, 2, 3): ((1, 3, 2), (2, 1, 3)),
    (1, 3, 2): ((1, 2, 3), (3, 1, 2)),
    (2, 1, 3): ((2, 3, 1), (1, 2, 3)),
    (2, 3, 1): ((2, 1, 3), (3, 2, 1)),
    (3, 1, 2): ((3, 2, 1), (1, 3, 2)),
    (3, 2, 1): ((3, 1, 2), (2, 3, 1)),
}
"""Table 2."""
SWITCH_AT = 1.562
"""Middle angle from which on the set is switched [rad], section 3.2.3."""


@dataclass(frozen=True)
class Attitude:
    """An orientation in one set: three angles [rad]."""

    angles: np.ndarray
    set: AngleSet


def rotation(angles: np.ndarray, order: AngleSet) -> np.ndarray:
    """Rotation matrix of three angles [rad] of a set."""
    R = np.eye(3)
    for angle, axis in zip(angles, order, strict=True):
        R = R @ _about(axis, angle)
    return R


def angles_of(R: np.ndarray, order: AngleSet) -> np.ndarray:
    """The three angles [rad] of a rotation in a set, the middle one within +-90 deg."""
    i, j, k = (axis - 1 for axis in order)
    sign = 1.0 if order in ((1, 2, 3), (2, 3, 1), (3, 1, 2)) else -1.0
    return np.array(
        [
            np.arctan2(-sign * R[j, k], R[k, k]),
            np.arcsin(np.clip(sign * R[i, k], -1.0, 1.0)),
            np.arctan2(-sign * R[i, j], R[i, i]),
        ]
    )


def rate_matrix(angles: np.ndarray, order: AngleSet) -> np.ndarray:
    """E with angular velocity = E @ rates of the angles, base frame, shape (3, 3); singular at the lock."""
    E, R = np.empty((3, 3)), np.eye(3)
    for column, (angle, axis) in enumerate(zip(angles, order, strict=True)):
        E[:, column] = R[:, axis - 1]
        R = R @ _about(axis, angle)
    return E


def switched(R: np.ndarray, order: AngleSet, choice: int = 0) -> Attitude:
    """The orientation in the set in use, or in its alternative if that one is near its lock."""
    angles = angles_of(R, order)
    if abs(angles[1]) < SWITCH_AT:
        return Attitude(angles, order)
    other = PUBLISHED_ALTERNATIVES[order][choice]
    return Attitude(angles_of(R, other), other)


def never_locks_with(order: AngleSet, other: AngleSet, samples: int = 72) -> bool:
    """Whether a set is at least 1 deg from its lock in every attitude in which ``order`` is locked."""
    turns = np.linspace(-np.pi, np.pi, samples, endpoint=False)
    for middle in (-np.pi / 2, np.pi / 2):
        for turn in turns:
            R = rotation(np.array([turn, middle, 0.0]), order)
            if abs(angles_of(R, other)[1]) > np.radians(89.0):
                return False
    return True


def _about(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    j, k = axis % 3, (axis + 1) % 3
    R = np.eye(3)
    R[j, j], R[j, k], R[k, j], R[k, k] = c, -s, s, c
    return R
