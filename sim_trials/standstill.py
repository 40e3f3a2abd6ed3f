"""Modes that can be led to where they stand still for good, and whether a study's lap leads there."""

from functools import lru_cache

import numpy as np

from data.errors import InputError
from data.study import Maze
from sim_trials.kinematics import handle_jacobian
from sim_trials.mode_atlas import COMMAND, answer, stretched
from sim_trials.modes.method import ResolvedMode
from sim_trials.singular_value import smallest_singular_value
from sim_trials.start import start_angles

_AXES = np.vstack([np.eye(6), -np.eye(6)])
"""What is asked for: each axis of the handle's motion, to and fro."""


def standstill_sigma(mode: ResolvedMode, maze: Maze) -> float:
    """The largest sigma on the way into the elbow-lock at which no command moves the robot; else zero.

    Parameters
    ----------
    mode : ResolvedMode
    maze : Maze
        From whose start the arm is stretched.
    """
    J = np.empty((6, 6))
    for q in stretched(maze):
        handle_jacobian(q, J)
        sigma = smallest_singular_value(J)
        if not any(answer(mode, q, J, sigma, COMMAND * axis).any() for axis in _AXES):
            return sigma
    return 0.0


def sigma_of_lap(maze: Maze) -> float:
    """Smallest singular value at the maze's corners, the nozzle perpendicular to the wall.

    Zero if a corner is out of reach like that: the arm is stretched before it gets there.
    """
    least, J = np.inf, np.empty((6, 6))
    for y in (maze.left_y_m, maze.right_y_m):
        for z in (maze.top_z_m, maze.bottom_z_m):
            try:
                q = start_angles(maze.model_copy(update={"left_y_m": y, "top_z_m": z}))
            except InputError:
                return 0.0
            handle_jacobian(np.array(q), J)
            least = min(least, smallest_singular_value(J))
    return least


@lru_cache(maxsize=256)
def caution(mode: ResolvedMode, maze: Maze) -> str:
    """What a researcher must know of a mode before a study has it, after its name; empty if nothing.

    Raises
    ------
    InputError
        If the robot doesn't reach the maze's start.
    """
    sigma = standstill_sigma(mode, maze)
    if sigma <= sigma_of_lap(maze):
        return ""
    return (
        f"stands still below sigma {sigma:.2g} whatever it is asked, and the lap leads there: a hand that"
        " gets so far cannot finish it"
    )
