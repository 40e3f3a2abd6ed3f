"""Prints what one control tick costs, part by part, beside four physics steps: run as a script.

``python tests/benchmarks/control_step_cost.py``. Times are the best of several runs; read them as ratios.
"""

import time
from collections.abc import Callable

import numpy as np
from numba.core import types

from data.study import Controller, Mode
from sim_trials.admittance import (
    COMMAND,
    CONTROL_PERIOD_S,
    TWIST,
    control_step,
    initial_state,
    pack_controller,
)
from sim_trials.compiled import MATRIX, VECTOR, compiled
from sim_trials.kinematics import handle_jacobian, handle_pose
from sim_trials.model import STEP_TYPE, new_robot, physics_step
from sim_trials.modes.method import MEMORY_LENGTH, MODE_TYPE
from sim_trials.modes.registry import METHODS, resolve
from sim_trials.singular_value import smallest_singular_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])
CALLS = 20_000


@compiled(types.void(VECTOR, MATRIX, types.int64), cache=False)
def poses(q: np.ndarray, T: np.ndarray, n: int) -> None:
    for _ in range(n):
        q[1] += 1e-12
        handle_pose(q, T)


@compiled(types.void(VECTOR, MATRIX, types.int64), cache=False)
def jacobians(q: np.ndarray, J: np.ndarray, n: int) -> None:
    for _ in range(n):
        q[1] += 1e-12
        handle_jacobian(q, J)


@compiled(types.float64(MATRIX, types.int64), cache=False)
def sigmas(J: np.ndarray, n: int) -> float:
    total = 0.0
    for _ in range(n):
        J[0, 0] += 1e-15
        total += smallest_singular_value(J)
    return total


@compiled(
    types.void(MODE_TYPE, VECTOR, MATRIX, types.float64, VECTOR, VECTOR, VECTOR, VECTOR, types.int64),
    cache=False,
)
def commands(mode, q, J, sigma, xdot, parameters, memory, qdot, n):  # type: ignore[no-untyped-def]
    for _ in range(n):
        xdot[0] += 1e-15
        mode(q, J, sigma, xdot, CONTROL_PERIOD_S, parameters, memory, qdot)


@compiled(
    types.void(MODE_TYPE, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, MATRIX, types.int64), cache=False
)
def ticks(mode, parameters, controller, q, measured, state, T, J, n):  # type: ignore[no-untyped-def]
    for _ in range(n):
        q[1] += 1e-12
        control_step(mode, parameters, controller, q, measured, True, CONTROL_PERIOD_S, state, T, J)


@compiled(types.void(STEP_TYPE, types.intp, types.intp, types.int64), cache=False)
def physics(step, model, data, n):  # type: ignore[no-untyped-def]
    for _ in range(n):
        step(model, data)


def nanoseconds(function: Callable[..., object], *arguments: object, n: int = CALLS) -> float:
    """Best of nine runs, per call."""
    function(*arguments, 10)
    best = np.inf
    for _ in range(9):
        begin = time.perf_counter()
        function(*arguments, n)
        best = min(best, time.perf_counter() - begin)
    return best / n * 1e9


def main() -> None:
    """Print one table for each distance from elbow-lock."""
    robot = new_robot(START)
    step = nanoseconds(physics, physics_step(), robot.model_address, robot.data_address, n=2000)
    print(f"four physics steps {4 * step:8.0f} ns")
    for elbow in (START[2], 0.3, 0.02):
        q, T, J = START.copy(), np.empty((4, 4)), np.empty((6, 6))
        q[2] = elbow
        print(f"pose               {nanoseconds(poses, q.copy(), T):8.0f} ns")
        print(f"Jacobian           {nanoseconds(jacobians, q.copy(), J):8.0f} ns")
        handle_jacobian(q, J)
        sigma = smallest_singular_value(J)
        print(f"sigma_min = {sigma:.3f}  {nanoseconds(sigmas, J.copy()):8.0f} ns")
        for name in METHODS:
            mode = resolve(Mode(name="X", method=name))
            state = initial_state(q)
            state[TWIST] = (0.0, -0.05, 0.0, 0.0, 0.1, 0.0)
            alone = nanoseconds(
                commands, mode.function, q, J, sigma, state[TWIST], mode.packed(), np.zeros(MEMORY_LENGTH),
                state[COMMAND],
            )  # fmt: skip
            measured = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])
            whole = nanoseconds(
                ticks,
                mode.function,
                mode.packed(),
                pack_controller(Controller()),
                q.copy(),
                measured,
                state,
                T,
                J,
            )
            print(f"{name:18} {alone:8.0f} ns, control step {whole:6.0f} ns")


if __name__ == "__main__":
    main()
