"""The maze on the wall: how far along the lap the cursor is, and what the wall shows of the motion.

The lap runs clockwise, as somebody facing the wall sees it, from the top left corner along four edges:
0 top, 1 right, 2 bottom, 3 left. In the base frame y grows to the left and z upwards, so "right" is -y.

Phases: ``edge`` is the right edge with its two corners, where the arm has to stretch: from where the top
right corner counts as reached (the corner tolerance before it) to as much past the bottom right one.
``approach`` and ``exit`` are the `NEIGHBOUR_M` of the lap just before and just after, where the damping
begins and ends; the rest, where no mode of the 2017 study damps, is ``free``. Phases go by the cursor's
place on the lap, not by the robot.

References
----------
Carmichael, Aldini, Liu (2017), section 2.2 and Figure 4: the maze, the cursor, the blasting path. The
paper gives no dimensions; those of the study file are this project's.
"""

import math
from dataclasses import dataclass

import numpy as np

from data.metric_meanings import LAP_PHASES
from data.study import Feedback, Maze
from sim_trials.compiled import compiled
from sim_trials.kinematics import HANDLE_OFFSET_M, NOZZLE_LENGTH_M
from sim_trials.record import record_of

EDGES = 4
"""Edges of the maze; the lap is done when edge 4 would begin."""

PHASES = ("free", *LAP_PHASES)
"""The phases of a lap, in the order of their codes."""

NEIGHBOUR_M = 0.30
"""Length of the approach and of the exit [m]: on the default maze the damping sets in about there."""

FAINT_OPACITY = 0.20
SOLID_OPACITY = 1.0
_STEEPEST_NORMAL = 0.1
"""The nozzle's axis is taken to hit the wall at no more than about 84 deg from its normal."""


@dataclass(frozen=True)
class Wall:
    """The wall as compiled code sees it (as a record): the numbers of a study's maze and feedback.

    Attributes
    ----------
    handle_distance_m : float
        From the handle centre to the wall along a perpendicular nozzle at the right stand-off.
    """

    wall_x_m: float
    left_y_m: float
    right_y_m: float
    top_z_m: float
    bottom_z_m: float
    corner_tolerance_m: float
    handle_distance_m: float
    path_solid_up_to_m_s: float
    path_faint_from_m_s: float


def wall_of(maze: Maze, feedback: Feedback) -> Wall:
    """The wall of a study."""
    return Wall(
        wall_x_m=maze.wall_x_m,
        left_y_m=maze.left_y_m,
        right_y_m=maze.right_y_m,
        top_z_m=maze.top_z_m,
        bottom_z_m=maze.bottom_z_m,
        corner_tolerance_m=maze.corner_tolerance_m,
        handle_distance_m=maze.standoff_m + NOZZLE_LENGTH_M - HANDLE_OFFSET_M,
        path_solid_up_to_m_s=feedback.path_solid_up_to_m_s,
        path_faint_from_m_s=feedback.path_faint_from_m_s,
    )


@compiled(None)
def corner(wall: Wall, edge: int) -> tuple[float, float]:
    """Where an edge begins: (y, z) in the base frame [m]. Edge 4 begins where edge 0 does."""
    y = wall.left_y_m if edge % EDGES == 0 or edge % EDGES == 3 else wall.right_y_m
    z = wall.top_z_m if edge % EDGES < 2 else wall.bottom_z_m
    return y, z


@compiled(None)
def edge_length(wall: Wall, edge: int) -> float:
    """Length of an edge [m]."""
    return wall.left_y_m - wall.right_y_m if edge % 2 == 0 else wall.top_z_m - wall.bottom_z_m


@compiled(None)
def edge_start(wall: Wall, edge: int) -> float:
    """Arc length of the lap at which an edge begins [m]; of edge 4: the length of the lap."""
    length = 0.0
    for before in range(edge):
        length += edge_length(wall, before)
    return length


@compiled(None)
def edge_direction(edge: int) -> tuple[float, float]:
    """Unit vector (y, z) in which an edge runs."""
    if edge % 2 == 0:
        return (-1.0 if edge % EDGES == 0 else 1.0), 0.0
    return 0.0, (-1.0 if edge % EDGES == 1 else 1.0)


@compiled(None)
def along_edge(wall: Wall, edge: int, y: float, z: float) -> tuple[float, float]:
    """How far along an edge's line a point is, and how far to the side of it, both signed [m]."""
    corner_y, corner_z = corner(wall, edge)
    direction_y, direction_z = edge_direction(edge)
    dy, dz = y - corner_y, z - corner_z
    return dy * direction_y + dz * direction_z, dz * direction_y - dy * direction_z


@compiled(None)
def reaches_corner(wall: Wall, edge: int, y: float, z: float) -> bool:
    """Whether a point is within the corner tolerance of the corner in which an edge ends."""
    corner_y, corner_z = corner(wall, edge + 1)
    return math.hypot(y - corner_y, z - corner_z) <= wall.corner_tolerance_m


@compiled(None)
def progress(wall: Wall, edge: int, y: float, z: float) -> float:
    """Place on the lap by arc length [m], 0 to the lap's length, for a cursor that is on the given edge."""
    along, _ = along_edge(wall, edge, y, z)
    return edge_start(wall, edge) + min(max(along, 0.0), edge_length(wall, edge))


@compiled(None)
def point_at(wall: Wall, edge: int, along: float) -> tuple[float, float]:
    """The point (y, z) of an edge [m], `along` metres after its beginning."""
    corner_y, corner_z = corner(wall, edge)
    direction_y, direction_z = edge_direction(edge)
    return corner_y + along * direction_y, corner_z + along * direction_z


@compiled(None)
def phase(wall: Wall, place: float) -> int:
    """Code of the phase (an index into `PHASES`) at an arc length of the lap [m]."""
    first = edge_start(wall, 1) - wall.corner_tolerance_m
    last = edge_start(wall, 2) + wall.corner_tolerance_m
    if first <= place < last:
        return 2
    if first - NEIGHBOUR_M <= place < first:
        return 1
    return 3 if last <= place < last + NEIGHBOUR_M else 0


@compiled(None)
def cursor(wall: Wall, T: np.ndarray) -> tuple[float, float]:
    """Where the nozzle's axis hits the wall: (y, z) in the base frame [m], by the handle's pose T (4, 4)."""
    reach = (wall.wall_x_m - T[0, 3]) / max(T[0, 2], _STEEPEST_NORMAL)
    return T[1, 3] + reach * T[1, 2], T[2, 3] + reach * T[2, 2]


@compiled(None)
def tilt_direction(T: np.ndarray) -> float:
    """Which way the nozzle leans on the wall [rad], as somebody facing it sees it.

    0 points right (-y), pi/2 up (+z); 0 for a nozzle without tilt.
    """
    return math.atan2(T[2, 2], -T[1, 2])


@compiled(None)
def paint_opacity(wall: Wall, speed: float) -> float:
    """Opacity of the path painted at a cursor speed [m/s].

    Solid up to the study's limit, faint (`FAINT_OPACITY`) from its second limit on, smoothstep between.
    """
    solid, faint = wall.path_solid_up_to_m_s, wall.path_faint_from_m_s
    t = min(max((speed - solid) / (faint - solid), 0.0), 1.0)
    return SOLID_OPACITY + (FAINT_OPACITY - SOLID_OPACITY) * t * t * (3.0 - 2.0 * t)


@compiled(None)
def _opacities(wall: Wall, speeds: np.ndarray, out: np.ndarray) -> None:
    for i in range(speeds.size):
        out[i] = paint_opacity(wall, speeds[i])


def paint_opacities(maze: Maze, feedback: Feedback, speeds: np.ndarray) -> np.ndarray:
    """`paint_opacity` of many cursor speeds [m/s], same shape as `speeds`."""
    speeds = np.ascontiguousarray(speeds, np.float64)
    out = np.empty_like(speeds)
    _opacities(record_of(wall_of(maze, feedback)), speeds.ravel(), out.reshape(-1))
    return out


def lap_length_m(maze: Maze) -> float:
    """Length of one lap [m]."""
    return 2.0 * (maze.left_y_m - maze.right_y_m + maze.top_z_m - maze.bottom_z_m)


def corners(maze: Maze) -> np.ndarray:
    """The maze's corners in the order of the lap, shape (4, 2): y, z in the base frame [m]."""
    left, right, top, bottom = maze.left_y_m, maze.right_y_m, maze.top_z_m, maze.bottom_z_m
    return np.array([[left, top], [right, top], [right, bottom], [left, bottom]])
