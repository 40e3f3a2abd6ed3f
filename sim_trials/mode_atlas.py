"""What a mode does on the way into the elbow-lock and out of it: gain and damping against sigma.

One pose after another, from the maze's start to the stretched arm, the mode is asked for a motion along
u_6, the one direction of the task that the singularity takes away: once so that sigma falls (towards), once
so that it grows (away). What it answers along that direction over what it was asked for is its gain g. Since
damped least squares gives g = sigma^2 / (sigma^2 + lambda^2), every gain can be said as a damping, lambda =
sigma sqrt(1 / g - 1), whether the mode damps or limits, filters or scales: one scale for all.
"""

import time
from dataclasses import dataclass

import numpy as np
from numba.core import types

from data.study import Maze
from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.compiled import MATRIX, VECTOR, compiled
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S, handle_jacobian
from sim_trials.modes.decomposition import decompose
from sim_trials.modes.displacement import displaced_sigma
from sim_trials.modes.method import MEMORY_LENGTH, MODE_TYPE, ModeFunction, ResolvedMode
from sim_trials.singular_value import smallest_singular_value
from sim_trials.start import start_angles

COMMAND = 0.1
"""Length of the command [m/s and rad/s, as a norm]: an ordinary pace on the maze."""
SETTLING_TICKS = 125
"""Modes with a memory are asked for so long at each pose: 1 s."""
POSES = 80
NEAREST_ELBOW_RAD = 0.004
"""The elbow's angle at the pose nearest to the lock; sigma is about 0.24 times that."""
_ELBOW = 2
_COST_CALLS, _COST_RUNS = 2000, 7
_COST_SIGMA = 0.1


@dataclass(frozen=True, eq=False)
class Curve:
    """A mode in one direction, over the poses of an atlas; all of shape (n,).

    Attributes
    ----------
    gain : ndarray
        Velocity along the command over the command.
    damping : ndarray
        The lambda of damped least squares with the same gain; inf where there is no motion.
    joint_speed : ndarray
        Of the fastest joint, as a share of its speed limit.
    """

    gain: np.ndarray
    damping: np.ndarray
    joint_speed: np.ndarray


@dataclass(frozen=True, eq=False)
class ModeCurves:
    """A mode on the way into the lock and out of it.

    Attributes
    ----------
    sigma : ndarray, shape (n,)
        Smallest singular value at the poses, falling.
    cost_ns : float
        Processor time of one call at sigma = 0.1, the best of several runs on this machine.
    """

    mode: ResolvedMode
    sigma: np.ndarray
    towards: Curve
    away: Curve
    cost_ns: float


@compiled(types.void(MODE_TYPE, VECTOR, MATRIX, types.float64, VECTOR, VECTOR, VECTOR, VECTOR, types.int64))
def repeat(
    mode: ModeFunction,
    q: np.ndarray,
    J: np.ndarray,
    sigma: float,
    xdot: np.ndarray,
    parameters: np.ndarray,
    memory: np.ndarray,
    qdot: np.ndarray,
    times: int,
) -> None:
    """Call a mode's function so many times with the same arguments but its memory."""
    for _ in range(times):
        mode(q, J, sigma, xdot, CONTROL_PERIOD_S, parameters, memory, qdot)


def mode_curves(mode: ResolvedMode, maze: Maze | None = None) -> ModeCurves:
    """Gain, damping and joint speed of a mode against sigma, and what it costs.

    Parameters
    ----------
    mode : ResolvedMode
    maze : Maze, optional
        From whose start the arm is stretched; the default maze if left out.
    """
    poses = stretched(maze or Maze())
    sigma = np.empty(POSES)
    answers = np.empty((2, 3, POSES))
    limits = np.array(JOINT_SPEED_LIMITS_RAD_S)
    for place, q in enumerate(poses):
        J, direction, sigma[place] = _lost_direction(q)
        for way, xdot in enumerate((-direction, direction)):
            qdot = answer(mode, q, J, sigma[place], COMMAND * xdot)
            gain = float(xdot @ J @ qdot) / COMMAND
            answers[way, 0, place] = gain
            answers[way, 1, place] = _damping(sigma[place], gain)
            answers[way, 2, place] = np.abs(qdot / limits).max()
    return ModeCurves(mode, sigma, Curve(*answers[0]), Curve(*answers[1]), _cost_ns(mode, poses[0]))


def stretched(maze: Maze) -> list[np.ndarray]:
    """The start of the lap with its elbow stretched step by step, evenly in its angle to the power 1/2."""
    start = np.array(start_angles(maze))
    elbows = np.linspace(np.sqrt(start[_ELBOW]), np.sqrt(NEAREST_ELBOW_RAD), POSES) ** 2
    poses = np.tile(start, (POSES, 1))
    poses[:, _ELBOW] = elbows
    return list(poses)


def _lost_direction(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """The Jacobian, the unit twist along u_6 that makes sigma grow, and sigma."""
    J, U, singular, V = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty((6, 6))
    handle_jacobian(q, J)
    decompose(J, U, singular, V)
    sigma = smallest_singular_value(J)
    # A step short enough never to cross the lock.
    step = 0.1 * NEAREST_ELBOW_RAD
    sign = 1.0 if displaced_sigma(q, V[5], step) > displaced_sigma(q, V[5], -step) else -1.0
    return J, sign * U[5], sigma


def answer(mode: ResolvedMode, q: np.ndarray, J: np.ndarray, sigma: float, xdot: np.ndarray) -> np.ndarray:
    """Joint velocities [rad/s] once a mode has been asked for the same for a second; shape (6,)."""
    memory, qdot = np.zeros(MEMORY_LENGTH), np.empty(6)
    repeat(mode.function, q, J, sigma, xdot, mode.packed(), memory, qdot, SETTLING_TICKS)
    return qdot


def _damping(sigma: float, gain: float) -> float:
    if gain <= 0.0:
        return float("inf")
    return float(sigma * np.sqrt(max(1.0 / gain - 1.0, 0.0)))


def _cost_ns(mode: ResolvedMode, start: np.ndarray) -> float:
    q = start.copy()
    q[_ELBOW] = _COST_SIGMA / 0.24
    J, direction, sigma = _lost_direction(q)
    memory, qdot = np.zeros(MEMORY_LENGTH), np.empty(6)
    xdot, parameters = -COMMAND * direction, mode.packed()
    best = np.inf
    for _ in range(_COST_RUNS):
        begin = time.thread_time()
        repeat(mode.function, q, J, sigma, xdot, parameters, memory, qdot, _COST_CALLS)
        best = min(best, time.thread_time() - begin)
    return best / _COST_CALLS * 1e9
