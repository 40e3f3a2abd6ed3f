"""How a hand holds the nozzle: a spring from the handle to where it is wanted, another against turning.

Simulated operators and people at a screen hold it in the same way; what they want, and how strong they
are, is theirs (``operators``, ``guidance``).

A lean is given by the components of the nozzle's unit vector along the wall (base y and z). Hands know
that a leaning nozzle points elsewhere: the handle is wanted so far to the side that the nozzle, leaning
as wanted, points at the aim.
"""

import math

import numpy as np

from sim_trials.compiled import compiled
from sim_trials.maze import Wall


@compiled(None)
def spring_force(
    stiffness: float, wall: Wall, aim_y: float, aim_z: float, lean_y: float, lean_z: float, T: np.ndarray
) -> tuple[float, float, float]:
    """Force on the handle [N], base frame, before any limit.

    Parameters
    ----------
    stiffness : float
        Of the hand [N/m].
    wall : record of Wall
    aim_y, aim_z : float
        Where on the wall the cursor is wanted [m].
    lean_y, lean_z : float
        Wanted lean.
    T : ndarray, shape (4, 4)
        Pose of the handle.
    """
    distance = wall.handle_distance_m
    lean_x = math.sqrt(1.0 - lean_y * lean_y - lean_z * lean_z)
    fx = stiffness * (wall.wall_x_m - distance * lean_x - T[0, 3])
    fy = stiffness * (aim_y - distance * lean_y - T[1, 3])
    fz = stiffness * (aim_z - distance * lean_z - T[2, 3])
    return fx, fy, fz


@compiled(None)
def spring_moment(
    stiffness: float, cap: float, lean_y: float, lean_z: float, T: np.ndarray
) -> tuple[float, float, float, float]:
    """Moment on the handle [N m], base frame, and its magnitude, at most `cap`.

    It turns the nozzle (tool z) towards the wanted lean and keeps the handles (tool x) level.

    Parameters
    ----------
    stiffness, cap : float
        Of the hand against rotation [N m/rad]; the most it twists [N m].
    lean_y, lean_z : float
        Wanted lean.
    T : ndarray, shape (4, 4)
        Pose of the handle.
    """
    lean_x = math.sqrt(1.0 - lean_y * lean_y - lean_z * lean_z)
    nx, ny, nz = T[0, 2], T[1, 2], T[2, 2]
    roll = -T[2, 0]
    mx = stiffness * (ny * lean_z - nz * lean_y + roll * nx)
    my = stiffness * (nz * lean_x - nx * lean_z + roll * ny)
    mz = stiffness * (nx * lean_y - ny * lean_x + roll * nz)
    moment = math.sqrt(mx * mx + my * my + mz * mz)
    if moment > cap:
        share = cap / moment
        mx, my, mz, moment = mx * share, my * share, mz * share, cap
    return mx, my, mz, moment
