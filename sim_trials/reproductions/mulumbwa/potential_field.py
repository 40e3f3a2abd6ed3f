"""A point between an attracting goal and a repelling obstacle: sections 2.6 and 3.2.5 of the thesis."""

from dataclasses import dataclass

import numpy as np

ZETA, ETA = 0.005, 4.9e-9
GOAL_RADIUS_M, REACH_M = 0.1, 0.1
"""d*_goal and Q*, section 3.2.5 (Q* is printed in square metres)."""
WORLD_RADIUS_M, OBSTACLE_RADIUS_M = 0.6, 0.2
STEP = 5.0
"""alpha of eqs. (45), (46) [m per unit of force]: not printed; 2.5 mm a step where the pull is full."""
ARRIVED_M = 5e-3


@dataclass(frozen=True)
class Path:
    """Where the point went.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        [m]
    clearance_m : float
        Smallest distance from the obstacle's edge; negative inside.
    has_arrived : bool
    """

    points: np.ndarray
    clearance_m: float
    has_arrived: bool


def attraction(x: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """Force towards the goal: minus the gradient of eq. (41), as eq. (40) has it; eq. (42) prints plus."""
    away = x - goal
    distance = float(np.linalg.norm(away))
    return -ZETA * away * min(1.0, GOAL_RADIUS_M / max(distance, 1e-12))


def repulsion(x: np.ndarray, centre: np.ndarray, *, as_printed: bool = False) -> np.ndarray:
    """Force off the obstacle: minus the gradient of eq. (43).

    ``as_printed``: the size of eq. (44), which lacks the factor 1/D^2 of the gradient.
    """
    away = x - centre
    distance = float(np.linalg.norm(away))
    D = max(distance - OBSTACLE_RADIUS_M, 1e-6)
    if D > REACH_M:
        return np.zeros(2)
    size = ETA * (1.0 / D - 1.0 / REACH_M) * (1.0 if as_printed else 1.0 / D**2)
    return size * away / distance


def descend(
    start: np.ndarray, goal: np.ndarray, centre: np.ndarray, *, as_printed: bool = False, n: int = 2000
) -> Path:
    """Eqs. (45), (46): steps along the force, none longer than 5 mm, until the goal is near."""
    x = np.array(start, float)
    points = [x]
    for _ in range(n):
        if np.linalg.norm(x - goal) < ARRIVED_M:
            break
        move = STEP * (attraction(x, goal) + repulsion(x, centre, as_printed=as_printed))
        x = x + move * min(1.0, 5e-3 / max(float(np.linalg.norm(move)), 1e-12))
        points.append(x)
    path = np.array(points)
    clearance = float(np.linalg.norm(path - centre, axis=1).min()) - OBSTACLE_RADIUS_M
    return Path(path, clearance, bool(np.linalg.norm(path[-1] - goal) < ARRIVED_M))
