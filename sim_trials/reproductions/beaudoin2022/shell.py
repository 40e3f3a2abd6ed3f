"""From a shell's motion to joint velocities: selection, reduction, split, and direct rotations.

Beaudoin, Laliberte, Gosselin (2022), section 5, eqs. (20)-(28).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Inverse = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Joint velocities for a Jacobian and a task velocity: one of the strategies."""

ROTATION, TRANSLATION = (2,), (3, 4)
"""Rows of a link's Jacobian that a shell's three degrees of freedom select: about z; along x and y."""


@dataclass(frozen=True)
class Shell:
    """A shell on a link, and the joints that answer to it.

    Attributes
    ----------
    link : int
        1 to 5.
    turned_by : int
        The joint whose axis the shell turns about; it takes the rotation directly (eq. (28)).
    moved_by : tuple of int
        The joints that answer to the translations: the two before the link's own.
    """

    link: int
    turned_by: int
    moved_by: tuple[int, ...]


SHELLS = (Shell(link=3, turned_by=3, moved_by=(1, 2)), Shell(link=5, turned_by=5, moved_by=(3, 4)))


def selection(rows: Sequence[int]) -> np.ndarray:
    """S_i of eq. (21), shape (len(rows), 6)."""
    return np.eye(6)[list(rows)]


def reduction(joints: Sequence[int], n: int = 5) -> np.ndarray:
    """R_i of eq. (22), shape (n, len(joints)); joints are counted from 1."""
    return np.eye(n)[:, [joint - 1 for joint in joints]]


def translation_matrix(shell: Shell, J: np.ndarray) -> np.ndarray:
    """W_it = S_i J_i R_i of eqs. (23), (24) for the shell's translations, shape (2, k)."""
    return selection(TRANSLATION) @ J @ reduction(shell.moved_by)


def rotation_matrix(shell: Shell, J: np.ndarray) -> np.ndarray:
    """W_ir for the shell's rotation about the link, all joints up to the link's, shape (1, link)."""
    return selection(ROTATION) @ J @ reduction(range(1, shell.link + 1))


def split_rates(shell: Shell, J: np.ndarray, motion: np.ndarray, inverse: Inverse) -> np.ndarray:
    """Joint velocities with rotation and translation solved apart and added: eqs. (25)-(27), shape (5,).

    ``motion``: the shell's turn about its link and its velocity along x and y, shape (3,).
    """
    turned = reduction(range(1, shell.link + 1)) @ inverse(rotation_matrix(shell, J), motion[:1])
    return turned + reduction(shell.moved_by) @ inverse(translation_matrix(shell, J), motion[1:])


def direct_rates(
    shell: Shell, J: np.ndarray, motion: np.ndarray, inverse: Inverse, eta: float = 1.0
) -> np.ndarray:
    """Joint velocities with the rotation given straight to the link's own joint: eq. (28), shape (5,)."""
    moved = reduction(shell.moved_by) @ inverse(translation_matrix(shell, J), motion[1:])
    return moved + eta * motion[0] * reduction((shell.turned_by,))[:, 0]
