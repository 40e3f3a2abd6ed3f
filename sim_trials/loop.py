"""One lap as one compiled loop: operator, control chain and physics, tick by tick.

The mode and MuJoCo's step come in as first-class functions, so the loop is compiled once for all modes,
its machine code can be cached on disk, and a new mode costs nothing here.

Whatever the hand does passes through the sensor, which counts in whole steps; what it counted is all that
the control chain and the physics ever get. Hence a lap can be run again, bit for bit, from the counts
and triggers alone: the loop, when ``replaying``, reads them instead of asking the operator.
"""

from collections.abc import Callable
from functools import cache
from typing import Protocol

import numba
import numpy as np
from numba.core import types

from sim_trials.admittance import (
    CONTROL_PERIOD_S,
    SIGMA,
    TWIST,
    control_step,
    sensor_wrench,
    servo_target,
)
from sim_trials.compiled import MATRIX, VECTOR, compiled
from sim_trials.kinematics import (
    HANDLE_OFFSET_M,
    JOINT_SPEED_LIMITS_RAD_S,
    SENSOR_OFFSET_M,
    handle_pose,
    tilt,
)
from sim_trials.maze import EDGES, Wall, cursor, progress, reaches_corner, tilt_direction
from sim_trials.model import PHYSICS_STEP_S, STEP_TYPE
from sim_trials.modes.method import MODE_TYPE, ModeFunction
from sim_trials.operators import Mind, Operator, hand_wrench
from sim_trials.record import dtype_of

SUBSTEPS = round(CONTROL_PERIOD_S / PHYSICS_STEP_S)
"""Physics steps in a control tick."""

FORCE_COUNT_N = 1.0 / 128.0
MOMENT_COUNT_NM = 1.0 / 1024.0
"""What one count of the sensor is worth. Finer than the 1/16 N and 1/376 N m of an ATI Mini45 (SI-290-10),
so that the steps change nothing; powers of two, so that counts become floats without rounding."""

ENABLE, BLAST = 1, 2
"""Bits of the triggers: motion enabled, blasting."""

JOINT_SPEED_SHARE = 0.98
"""A joint that moves at this share of its speed limit stops the robot. The chain cuts speeds off at the
limit itself, so a joint that gets there is asked for more than it can do."""

COMPLETED, STUCK, STOPPED, TIMED_OUT, DIVERGED = range(5)
"""How a lap ends. A lap that was given up has ended like one that took too long."""

GOES_ON = -1
"""What stands in place of an ending while there is none."""

TICK = np.dtype(
    [
        ("q", np.float64, (6,)),
        ("qdot", np.float64, (6,)),
        ("twist", np.float64, (6,)),
        ("handle", np.float64, (3,)),
        ("sigma", np.float64),
        ("cursor_y", np.float64),
        ("cursor_z", np.float64),
        ("tilt", np.float64),
        ("tilt_direction", np.float64),
        ("place", np.float64),
    ]
)
"""The state at the beginning of each control tick: joint angles [rad] and velocities [rad/s], commanded
handle velocity [m/s, rad/s], handle centre [m], smallest singular value, cursor [m], tilt and its
direction [rad], place on the lap by arc length [m]."""

_LEVER_M = HANDLE_OFFSET_M - SENSOR_OFFSET_M
_COUNT_LIMIT = 32767.0
_TWIST = TWIST.start
_SPEED_STOPS = tuple(JOINT_SPEED_SHARE * limit for limit in JOINT_SPEED_LIMITS_RAD_S)


class Tick(Protocol):
    """One element of `TICK`, as compiled code reads and writes it."""

    q: np.ndarray
    qdot: np.ndarray
    twist: np.ndarray
    handle: np.ndarray
    sigma: float
    cursor_y: float
    cursor_z: float
    tilt: float
    tilt_direction: float
    place: float


@compiled(None)
def count(measured: np.ndarray, counts: np.ndarray) -> None:
    """Write the whole counts (int16, shape (6,)) that the sensor makes of a wrench [N, N m]."""
    for i in range(6):
        steps = np.rint(measured[i] / (FORCE_COUNT_N if i < 3 else MOMENT_COUNT_NM))
        counts[i] = np.int16(min(max(steps, -_COUNT_LIMIT), _COUNT_LIMIT))


@compiled(None)
def sense(T: np.ndarray, wrench: np.ndarray, measured: np.ndarray, counts: np.ndarray) -> None:
    """Write what the sensor measures, and counts, of a hand's wrench at the handle centre, base frame.

    Shapes (4, 4), (6,), (6,) and int16 (6,); the pose of the handle comes first.
    """
    sensor_wrench(T, wrench, measured)
    count(measured, counts)


@compiled(None)
def counted(counts: np.ndarray, measured: np.ndarray) -> None:
    """Write the wrench [N, N m] that counts stand for; the inverse of `count`."""
    for i in range(6):
        measured[i] = counts[i] * (FORCE_COUNT_N if i < 3 else MOMENT_COUNT_NM)


@compiled(None)
def handle_wrench(T: np.ndarray, measured: np.ndarray, wrench: np.ndarray) -> None:
    """Write the wrench at the handle centre in the base frame, from what the sensor measures.

    The inverse of ``admittance.sensor_wrench``; shapes (4, 4), (6,), (6,).
    """
    mx = measured[3] + _LEVER_M * measured[1]
    my = measured[4] - _LEVER_M * measured[0]
    for i in range(3):
        wrench[i] = T[i, 0] * measured[0] + T[i, 1] * measured[1] + T[i, 2] * measured[2]
        wrench[3 + i] = T[i, 0] * mx + T[i, 1] * my + T[i, 2] * measured[5]


@compiled(None)
def observe(q: np.ndarray, qdot: np.ndarray, T: np.ndarray, wall: Wall, edge: int, tick: Tick) -> int:
    """Write what is known at the beginning of a tick; the edge that the cursor is on is returned."""
    handle_pose(q, T)
    y, z = cursor(wall, T)
    if reaches_corner(wall, edge, y, z):
        edge += 1
    for i in range(6):
        tick.q[i] = q[i]
        tick.qdot[i] = qdot[i]
    for i in range(3):
        tick.handle[i] = T[i, 3]
    tick.cursor_y = y
    tick.cursor_z = z
    tick.tilt = tilt(T)
    tick.tilt_direction = tilt_direction(T)
    tick.place = progress(wall, edge, y, z)
    return edge


@compiled(None)
def respond(
    step: Callable[[int, int], None],
    model: int,
    data: int,
    q: np.ndarray,
    qdot: np.ndarray,
    target: np.ndarray,
    hand: np.ndarray,
    mode: ModeFunction,
    parameters: np.ndarray,
    controller: np.ndarray,
    state: np.ndarray,
    counts: np.ndarray,
    trigger: int,
    edge: int,
    low: int,
    sigma_below: float,
    dwell: int,
    tick: Tick,
    T: np.ndarray,
    J: np.ndarray,
    measured: np.ndarray,
) -> tuple[int, int]:
    """What robot and controller make of the counts and the trigger of a tick, after `observe`.

    Parameters are those of `_lap`, and `edge` from `observe`; `low` is in how many ticks on end sigma has
    been small; T, J and measured are scratch, T with the pose that `observe` wrote.

    Returns
    -------
    tuple of int
        The new `low`, and how the lap ends in this tick, or `GOES_ON`. The physics has taken its steps only
        if it goes on.
    """
    counted(counts, measured)
    handle_wrench(T, measured, hand)
    control_step(
        mode, parameters, controller, q, measured, trigger & ENABLE != 0, CONTROL_PERIOD_S, state, T, J
    )
    tick.sigma = state[SIGMA]
    for i in range(6):
        tick.twist[i] = state[_TWIST + i]

    low = low + 1 if tick.sigma < sigma_below else 0
    if edge == EDGES:
        return low, COMPLETED
    if low > dwell:
        return low, STUCK
    for i in range(6):
        if abs(qdot[i]) >= _SPEED_STOPS[i]:
            return low, STOPPED
    if not np.isfinite(tick.cursor_y):
        return low, DIVERGED
    for sub in range(SUBSTEPS):
        servo_target(state, (sub + 1) * PHYSICS_STEP_S, target)
        step(model, data)
    return low, GOES_ON


def _lap(
    step: Callable[[int, int], None],
    model: int,
    data: int,
    q: np.ndarray,
    qdot: np.ndarray,
    target: np.ndarray,
    hand: np.ndarray,
    mode: ModeFunction,
    parameters: np.ndarray,
    controller: np.ndarray,
    state: np.ndarray,
    wall: Wall,
    operator: Operator,
    mind: Mind,
    anticipated: float,
    delay: int,
    noise: np.ndarray,
    sigma_below: float,
    dwell: int,
    replaying: bool,
    counts: np.ndarray,
    triggers: np.ndarray,
    ticks: np.ndarray,
) -> tuple[int, int]:
    """Run a lap from the robot's present state.

    Parameters
    ----------
    step, model, data : first-class function, int, int
        ``model.physics_step()`` and the addresses it takes.
    q, qdot, target, hand : ndarray, shape (6,)
        The arrays of ``model.Robot``.
    mode, parameters, controller, state :
        What ``admittance.control_step`` takes.
    wall, operator, mind, anticipated :
        What ``operators.hand_wrench`` takes.
    delay : int
        The operator's visual delay [ticks].
    noise : ndarray, shape (n, 6)
        From ``operators.hand_noise``; not read when replaying.
    sigma_below, dwell : float, int
        The lap halts as stuck once sigma is smaller in more than `dwell` ticks on end.
    replaying : bool
        Read `counts` and `triggers` instead of writing them.
    counts, triggers, ticks : ndarray, int16 (n, 6), uint8 (n,) and TICK (n,)
        The recording; n is the most ticks the lap may take.

    Returns
    -------
    tuple of int
        How many ticks were taken, and how the lap ended (`COMPLETED` ...).
    """
    T, J = np.empty((4, 4)), np.empty((6, 6))
    wrench, measured = np.empty(6), np.empty(6)
    edge, low = 0, 0
    for k in range(ticks.shape[0]):
        tick = ticks[k]
        edge = observe(q, qdot, T, wall, edge, tick)
        if not replaying:
            seen = ticks[max(k - delay, 0)]
            blasting = hand_wrench(
                operator, mind, wall, anticipated, seen.cursor_y, seen.cursor_z, seen.tilt, T, noise[k],
                CONTROL_PERIOD_S, wrench,
            )  # fmt: skip
            sense(T, wrench, measured, counts[k])
            triggers[k] = ENABLE | BLAST if blasting else ENABLE
        low, ending = respond(
            step, model, data, q, qdot, target, hand, mode, parameters, controller, state, counts[k],
            triggers[k], edge, low, sigma_below, dwell, tick, T, J, measured,
        )  # fmt: skip
        if ending != GOES_ON:
            return k + 1, ending
    return ticks.shape[0], TIMED_OUT


@cache
def lap_loop() -> Callable[..., tuple[int, int]]:
    """The compiled `_lap`, for one signature: whatever the mode, there is one loop.

    It is compiled, or loaded from the cache, at the first lap and not at import.
    """
    wall, operator, mind, tick = (
        numba.from_dtype(dtype) for dtype in (dtype_of(Wall), dtype_of(Operator), dtype_of(Mind), TICK)
    )
    robot = (STEP_TYPE, types.intp, types.intp, VECTOR, VECTOR, VECTOR, VECTOR)
    control = (MODE_TYPE, VECTOR, VECTOR, VECTOR)
    hand = (wall, operator, mind, types.float64, types.int64, MATRIX)
    halt = (types.float64, types.int64, types.boolean)
    tape = (
        types.Array(types.int16, 2, "C"),
        types.Array(types.uint8, 1, "C"),
        types.Array(tick, 1, "C"),
    )
    ends = types.UniTuple(types.int64, 2)
    return compiled(ends(*robot, *control, *hand, *halt, *tape))(_lap)
