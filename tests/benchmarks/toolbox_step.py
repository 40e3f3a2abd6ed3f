"""A damped step of the Robotics Toolbox for the same arm, timed by an interpreter that has it.

``python tests/benchmarks/mode_cost.py --toolbox PYTHON`` runs this file with that interpreter, gives it the
arm as JSON on stdin and reads the times [us] from stdout. The same damped inverse in NumPy is timed beside
it, and by ``mode_cost.py`` too, so that a ratio comes out although the two environments differ.
"""

import json
import sys
import time
from collections.abc import Callable

import numpy as np


def microseconds(call: Callable[[], object], n: int = 300) -> float:
    """Processor time of a call: the best of seven runs."""
    call()
    best = float("inf")
    for _ in range(7):
        begin = time.thread_time()
        for _ in range(n):
            call()
        best = min(best, time.thread_time() - begin)
    return best / n * 1e6


def damped_step(J: np.ndarray, xdot: np.ndarray, damping: float) -> np.ndarray:
    """The damped inverse as one writes it in NumPy."""
    step: np.ndarray = J.T @ np.linalg.solve(J @ J.T + damping**2 * np.eye(6), xdot)
    return step


def main() -> None:
    """Time what the toolbox offers for a damped step, from nearest to the task to nearest to the equation."""
    import roboticstoolbox as rtb

    arm = json.load(sys.stdin)
    links = [
        rtb.RevoluteDH(d=d, a=a, alpha=alpha)
        for d, a, alpha in zip(arm["d"], arm["a"], arm["alpha"], strict=True)
    ]
    robot = rtb.DHRobot(links)
    ets, q = robot.ets(), np.array(arm["q"])
    target = ets.eval(q)
    target[0, 3] += 0.001
    solver = rtb.IK_LM(k=0.04, method="chan")
    xdot = np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
    J = ets.jacob0(q)
    times = {
        "IK_LM.step": microseconds(lambda: solver.step(ets, target, q.copy())),
        "jacob0 + NumPy": microseconds(lambda: damped_step(ets.jacob0(q), xdot, 0.2)),
        "NumPy alone": microseconds(lambda: damped_step(J, xdot, 0.2)),
    }
    json.dump({"version": rtb.__version__, "numpy": np.__version__, "J": J.tolist(), "us": times}, sys.stdout)


if __name__ == "__main__":
    main()
