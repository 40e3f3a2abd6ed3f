"""Where a lap begins: the joint angles that hold the nozzle at the maze's top left corner."""

from functools import lru_cache

import numpy as np

from data.errors import InputError
from data.study import Maze
from sim_trials.kinematics import (
    HANDLE_OFFSET_M,
    NOZZLE_LENGTH_M,
    handle_jacobian,
    handle_pose,
    rotation_vector,
)

_NEAR_Q = (3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0)
"""The same for the default maze, to four digits [rad]: elbow up, arm bent away from the wall."""
_ITERATIONS = 100
_LONGEST_STEP_RAD = 0.2
_EXACT = 1e-12


@lru_cache(maxsize=256)
def start_angles(maze: Maze) -> tuple[float, ...]:
    """Joint angles [rad] with the nozzle perpendicular to the wall, in the corner, handles level.

    Newton's method from a nearby posture, so that the elbow's side is always the same.

    Raises
    ------
    InputError
        If the robot doesn't reach the corner.
    """
    target = np.array(
        [[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    )
    distance = maze.standoff_m + NOZZLE_LENGTH_M - HANDLE_OFFSET_M
    target[:3, 3] = maze.wall_x_m - distance, maze.left_y_m, maze.top_z_m
    q, T, J, error = np.array(_NEAR_Q), np.empty((4, 4)), np.empty((6, 6)), np.empty(6)
    for _ in range(_ITERATIONS):
        handle_pose(q, T)
        error[:3] = target[:3, 3] - T[:3, 3]
        rotation_vector(T, target, error[3:])
        if np.abs(error).max() < _EXACT:
            return tuple(q.tolist())
        handle_jacobian(q, J)
        step = J.T @ np.linalg.solve(J @ J.T + 1e-10 * np.eye(6), error)
        q += step * min(1.0, _LONGEST_STEP_RAD / np.abs(step).max())
    raise InputError(
        f"maze: the robot does not reach the top left corner (left_y_m = {maze.left_y_m:g},"
        f" top_z_m = {maze.top_z_m:g}) at wall_x_m = {maze.wall_x_m:g} and standoff_m = {maze.standoff_m:g}"
    )
