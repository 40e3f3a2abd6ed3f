"""How far to the right the nozzle gets while it is held perpendicular to the wall."""

from data.errors import InputError
from data.study import Maze
from sim_trials.start import start_angles

_FARTHEST_M = 1.4
_EXACT_M = 1e-4


def perpendicular_reach_m(maze: Maze, z_m: float) -> float:
    """The least y [m] (the farthest right) that a perpendicular nozzle with level handles reaches."""
    right, left = -_FARTHEST_M, maze.left_y_m
    while left - right > _EXACT_M:
        middle = 0.5 * (left + right)
        if _is_reached(maze, middle, z_m):
            left = middle
        else:
            right = middle
    return left


def _is_reached(maze: Maze, y_m: float, z_m: float) -> bool:
    try:
        start_angles(maze.model_copy(update={"left_y_m": y_m, "top_z_m": z_m}))
    except InputError:
        return False
    return True
