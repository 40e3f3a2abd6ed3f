"""The 5-DOF arm with its two link shells: Beaudoin, Laliberte, Gosselin (2022), tables I and II, section 5.

Joint axes run along their links. The shell of link i slides in the plane across the link and turns
about it, so the frame of a link used here has its z axis along the link.
"""

from dataclasses import dataclass

import numpy as np

from sim_trials.reproductions.chain import Chain, posture

B = (0.2905, 0.1885, 0.3835, 0.1745, 0.1900)
"""Link offsets b_i [m], table I; all lengths are 0 and all twists pi/2."""
ARM = Chain(a=(0.0,) * 5, d=B, alpha=(np.pi / 2,) * 5, offset=(0.0,) * 5)

SPEED_LIMIT = np.array([4 * np.pi / 3, 4 * np.pi / 3, 4 * np.pi / 3, 4 * np.pi / 3, 2 * np.pi])
ACCELERATION_LIMIT = np.array([22.0, 22.0, 54.0, 54.0, 60.0])
"""Of the joints [rad/s], [rad/s^2], table II."""

START = np.array([0.0, np.pi, 0.0, np.pi / 2, 0.0])
"""Link 3 stands on link 1, upright, and link 5 points along the shell's motion, as fig. 2 is described."""


@dataclass(frozen=True)
class LinkState:
    """A link and the point its shell sits on.

    Attributes
    ----------
    rotation : ndarray, shape (3, 3)
        Of the link's frame in the base frame; columns x, y across the link and z along it.
    point : ndarray, shape (3,)
        Where the shell's neutral position is, base frame [m].
    jacobian : ndarray, shape (6, 5)
        Twist of the link at that point in the link's own frame, rows angular then linear (eqs. (1)-(3)).
    """

    rotation: np.ndarray
    point: np.ndarray
    jacobian: np.ndarray


def link_state(q: np.ndarray, link: int, lever_m: float) -> LinkState:
    """Link ``link`` (1 to 5) and the point on its axis ``lever_m`` beyond the joint that turns it."""
    arm = posture(ARM, q)
    axis = arm.axes[link - 1]
    point = arm.centres[link - 1] + lever_m * axis
    # x lies across the link, along the axis of the joint before, turned with the link's own joint.
    before = arm.axes[link - 2] if link > 1 else np.array([1.0, 0.0, 0.0])
    rotation = _frame(axis, before, q[link - 1])
    J = np.zeros((6, 5))
    axes, centres = arm.axes[:link], arm.centres[:link]
    J[:3, :link] = rotation.T @ axes.T
    J[3:, :link] = rotation.T @ np.cross(axes, point - centres).T
    return LinkState(rotation, point, J)


def _frame(z: np.ndarray, across: np.ndarray, theta: float) -> np.ndarray:
    y = np.cross(z, across)
    x = np.cross(y, z)
    c, s = np.cos(theta), np.sin(theta)
    return np.column_stack([c * x + s * y, c * y - s * x, z])
