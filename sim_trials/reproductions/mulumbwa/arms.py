"""The two arms of the thesis: a planar one of three joints, and the 7-DOF humanoid arm of its table 1."""

import numpy as np

from sim_trials.reproductions.chain import Chain, Convention

PLANAR_LENGTHS_M = (2.0, 3.0, 2.0)
UPPER_ARM_M, FOREARM_M = 0.3, 0.25
PLANAR_TARGETS = {"inside": (4.0, 4.0), "outside": (6.0, 6.0)}
HUMANOID_TARGETS = {
    "inside": (0.1, 0.2, 0.23, 1.0, 0.9, 2.0),
    "outside": (0.0, 0.0, 0.9, 1.0, 0.9, 2.0),
}
"""Sections 3.1 and 3.2.4: positions [m], and three Euler angles [rad] of a set the thesis does not name."""

HUMANOID_START = np.array([0.0, 0.0, np.pi, 0.0, 0.0, 0.0, 0.0])
"""Section 3.2."""
LOWER_LIMIT = np.radians([-30.0, -50.0, -110.0, 0.0, -85.0, -45.0, -85.0])
UPPER_LIMIT = np.radians([180.0, 180.0, 80.0, 145.0, 90.0, 15.0, 85.0])


def humanoid(convention: Convention) -> Chain:
    """Table 1 read by one of the two conventions; eq. (1) is the standard one."""
    half = np.pi / 2
    return Chain(
        a=(0.0, 0.0, 0.0, UPPER_ARM_M, FOREARM_M, 0.0, 0.0),
        d=(0.0,) * 7,
        alpha=(half, half, -half, half, -half, -half, -half),
        offset=(0.0, half, 0.0, 0.0, 0.0, half, 0.0),
        convention=convention,
    )


def planar_position(q: np.ndarray) -> np.ndarray:
    """Tip of the planar arm [m], shape (2,)."""
    total = np.cumsum(q)
    lengths = np.array(PLANAR_LENGTHS_M)
    return np.array([lengths @ np.cos(total), lengths @ np.sin(total)])


def planar_jacobian(q: np.ndarray) -> np.ndarray:
    """Its Jacobian [m/rad], shape (2, 3)."""
    total = np.cumsum(q)
    lengths = np.array(PLANAR_LENGTHS_M)
    x, y = lengths * np.cos(total), lengths * np.sin(total)
    return np.array([-np.cumsum(y[::-1])[::-1], np.cumsum(x[::-1])[::-1]])
