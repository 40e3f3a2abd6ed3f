"""One control tick of a live trial as one compiled call: a person's hand, control chain, physics, view.

The parts are those of a simulated lap (``loop.observe``, ``sense``, ``respond``), in the same order. Called
from Python every 8 ms for each trial, it has few arguments: what can be is in one record.
"""

from collections.abc import Callable
from functools import cache
from typing import Protocol

import numba
import numpy as np
from numba.core import types

from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.compiled import VECTOR, compiled
from sim_trials.first_class import mode_at, step_at
from sim_trials.guidance import Grip, Hand, guided_wrench, lean_of
from sim_trials.kinematics import handle_pose
from sim_trials.loop import BLAST, ENABLE, TICK, Tick, observe, respond, sense
from sim_trials.maze import EDGES, Wall, cursor, edge_start, progress
from sim_trials.record import dtype_of

REST_S = 1.0
"""A robot that nobody holds and that has stood still for so long is at rest [s]."""
STILL_RAD_S = 1e-3
"""A robot stands still when no joint moves faster [rad/s]: at most 1.5 mm/s at the nozzle."""
SPEED_SENSE_S = 0.08
"""Time constant of the speed shown [s]: as steady, and as late, as a mean over 160 ms."""
REST_TICKS = round(REST_S / CONTROL_PERIOD_S)

LIVE = np.dtype(
    [
        ("step", np.int64),
        ("model", np.int64),
        ("data", np.int64),
        ("mode", np.int64),
        ("sigma_below", np.float64),
        ("dwell", np.int64),
        ("edge", np.int64),
        ("low", np.int64),
        ("still", np.int64),
        ("wall", dtype_of(Wall)),
        ("hand", dtype_of(Hand)),
        ("grip", dtype_of(Grip)),
        ("tick", TICK),
        ("cursor_y", np.float64),
        ("cursor_z", np.float64),
        ("velocity_y", np.float64),
        ("velocity_z", np.float64),
        ("shown", np.float64, (16,)),
    ]
)
"""All that a live tick needs beside arrays: one record, since each argument costs time on its way in."""


class Live(Protocol):
    """One element of `LIVE`, as compiled code reads and writes it."""

    step: int
    model: int
    data: int
    mode: int
    sigma_below: float
    dwell: int
    edge: int
    low: int
    still: int
    wall: Wall
    hand: Hand
    grip: Grip
    tick: Tick
    cursor_y: float
    cursor_z: float
    velocity_y: float
    velocity_z: float
    shown: np.ndarray


@compiled(None)
def _show(
    live: Live, q: np.ndarray, T: np.ndarray, k: int, is_held: bool, aim_y: float, aim_z: float
) -> None:
    """Write what is drawn after a tick."""
    handle_pose(q, T)
    y, z = cursor(live.wall, T)
    share = 1.0 - np.exp(-CONTROL_PERIOD_S / SPEED_SENSE_S)
    live.velocity_y += share * ((y - live.cursor_y) / CONTROL_PERIOD_S - live.velocity_y)
    live.velocity_z += share * ((z - live.cursor_z) / CONTROL_PERIOD_S - live.velocity_z)
    live.cursor_y, live.cursor_z = y, z
    lean_y, lean_z = lean_of(T)
    shown = live.shown
    shown[0] = (k + 1) * CONTROL_PERIOD_S
    shown[1], shown[2] = y, z
    shown[3], shown[4] = np.degrees(lean_y), np.degrees(lean_z)
    shown[5], shown[6] = (aim_y, aim_z) if is_held else (y, z)
    shown[7] = live.grip.pull
    shown[8] = np.hypot(live.velocity_y, live.velocity_z)
    shown[9] = min(progress(live.wall, live.edge, y, z) / edge_start(live.wall, EDGES), 1.0)
    for i in range(6):
        shown[10 + i] = q[i]


def _live_tick(
    live: Live,
    q: np.ndarray,
    qdot: np.ndarray,
    target: np.ndarray,
    hand: np.ndarray,
    parameters: np.ndarray,
    controller: np.ndarray,
    state: np.ndarray,
    counts: np.ndarray,
    triggers: np.ndarray,
    k: int,
    aim_y: float,
    aim_z: float,
    tilt_y: float,
    tilt_z: float,
    is_held: bool,
    is_blasting: bool,
) -> tuple[int, bool]:
    """Run tick `k`: `HandInput` in, the records and ``live.shown`` written.

    Returns
    -------
    int
        The ending, or ``loop.GOES_ON``.
    bool
        Whether the robot now rests.
    """
    T, J = np.empty((4, 4)), np.empty((6, 6))
    wrench, measured = np.empty(6), np.empty(6)
    is_held = is_held and np.isfinite(aim_y + aim_z + tilt_y + tilt_z)
    live.edge = observe(q, qdot, T, live.wall, live.edge, live.tick)
    guided_wrench(
        live.hand, live.grip, live.wall, is_held, aim_y, aim_z, np.radians(tilt_y), np.radians(tilt_z), T,
        CONTROL_PERIOD_S, wrench,
    )  # fmt: skip
    sense(T, wrench, measured, counts[k])
    triggers[k] = (ENABLE | BLAST if is_blasting else ENABLE) if is_held else 0
    live.low, ending = respond(
        step_at(live.step), live.model, live.data, q, qdot, target, hand, mode_at(live.mode), parameters,
        controller, state, counts[k], triggers[k], live.edge, live.low, live.sigma_below, live.dwell,
        live.tick, T, J, measured,
    )  # fmt: skip
    fastest = 0.0
    for i in range(6):
        fastest = max(fastest, abs(qdot[i]))
    live.still = 0 if is_held or fastest > STILL_RAD_S else live.still + 1
    _show(live, q, T, k, is_held, aim_y, aim_z)
    return ending, live.still >= REST_TICKS


@cache
def live_tick() -> Callable[..., tuple[int, bool]]:
    """The compiled `_live_tick`: one for all modes, compiled or loaded from the cache at the first trial."""
    arrays = (
        *[VECTOR] * 7,
        types.Array(types.int16, 2, "C"),
        types.Array(types.uint8, 1, "C"),
    )
    hand = (*[types.float64] * 4, types.boolean, types.boolean)
    result = types.Tuple((types.int64, types.boolean))
    return compiled(result(numba.from_dtype(LIVE), *arrays, types.int64, *hand))(_live_tick)
