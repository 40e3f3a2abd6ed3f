"""What each method costs a control step, and what a lap costs under the costliest: run as a script.

``python tests/benchmarks/mode_cost.py``. Beside them, where installed (extra ``bench``), the damped
inverse kinematics step of mink and of the Robotics Toolbox for the same arm at the same pose: what
a researcher would otherwise call. Both are general, and called from Python; trust orders of magnitude.
Then a lap under each of the three costliest, beside as many bare ``mj_step`` calls as it contains, in turns.
"""

import statistics
import time
from collections.abc import Callable
from importlib.util import find_spec

import numpy as np
from numba.core import types

from data.study import Maze, Mode
from data.study_file import read_study
from sim_trials.compiled import compiled
from sim_trials.kinematics import DH_A_M, DH_ALPHA_RAD, DH_D_M, HANDLE_OFFSET_M
from sim_trials.loop import SUBSTEPS, lap_loop
from sim_trials.mode_atlas import mode_curves
from sim_trials.model import STEP_TYPE, new_robot, physics_step
from sim_trials.modes.registry import METHODS, resolve
from sim_trials.operators import draw_operator
from sim_trials.start import start_angles
from sim_trials.trial import simulate

NEAR_LOCK_RAD = 0.4
REPETITIONS = 7
SLOWEST = 3


@compiled(types.void(STEP_TYPE, types.intp, types.intp, types.int64), cache=False)
def bare_steps(step: object, model: int, data: int, n: int) -> None:
    """Call the physics step n times."""
    for _ in range(n):
        step(model, data)


def microseconds(call: Callable[[], object], n: int = 300) -> float:
    """Best of seven runs, per call."""
    call()
    best = np.inf
    for _ in range(7):
        begin = time.perf_counter()
        for _ in range(n):
            call()
        best = min(best, time.perf_counter() - begin)
    return best / n * 1e6


def mink_step(q: np.ndarray) -> Callable[[], object] | None:
    """A damped step of mink towards a target 1 mm away; None if it is not installed."""
    if not (find_spec("mink") and find_spec("daqp")):
        return None
    import mink

    robot = new_robot(q)
    configuration = mink.Configuration(robot.model, q)
    task = mink.FrameTask("handle", "site", position_cost=1.0, orientation_cost=1.0)
    pose = configuration.get_transform_frame_to_world("handle", "site")
    task.set_target(mink.SE3.from_translation(np.array([0.001, 0.0, 0.0])) @ pose)
    return lambda: mink.solve_ik(configuration, [task], 0.008, solver="daqp", damping=0.04)


def toolbox_step(q: np.ndarray) -> Callable[[], object] | None:
    """A damped step of the Robotics Toolbox (Levenberg-Marquardt); None if it is not installed."""
    try:
        import roboticstoolbox as rtb
    except ImportError:
        return None

    links = [
        rtb.RevoluteDH(d=d, a=a, alpha=alpha)
        for d, a, alpha in zip(DH_D_M, DH_A_M, DH_ALPHA_RAD, strict=True)
    ]
    links[-1] = rtb.RevoluteDH(d=DH_D_M[5] + HANDLE_OFFSET_M)
    ets = rtb.DHRobot(links).ets()
    target = ets.eval(q)
    target[0, 3] += 0.001
    solver = rtb.IK_LM(k=0.04, method="chan")
    return lambda: solver.step(ets, target, q.copy())


def lap_ratio(method: str) -> float:
    """A lap under a method over the bare physics steps in it: the median of several, in turns."""
    study = read_study("carmichael2017")
    study = study.model_copy(update={"modes": (Mode(name="X", method=method), study.modes[1])})
    operator, step = draw_operator(3), physics_step()
    trace = simulate(study, "X", operator, seed=1)
    robot = new_robot(trace.ticks["q"][trace.ticks.size // 2])
    ratios = []
    for _ in range(REPETITIONS):
        begin = time.perf_counter()
        simulate(study, "X", operator, seed=1)
        lap = time.perf_counter() - begin
        begin = time.perf_counter()
        bare_steps(step, robot.model_address, robot.data_address, SUBSTEPS * (trace.ticks.size - 1))
        ratios.append(lap / (time.perf_counter() - begin))
    return statistics.median(ratios)


def main() -> None:
    """Print both tables."""
    costs = {name: mode_curves(resolve(Mode(name="X", method=name))).cost_ns / 1000.0 for name in METHODS}
    for name, cost in sorted(costs.items(), key=lambda item: item[1]):
        print(f"{name:34}{cost:10.2f} us")
    q = np.array(start_angles(Maze()))
    q[2] = NEAR_LOCK_RAD
    for name, step in (
        ("mink.solve_ik (daqp)", mink_step(q)),
        ("roboticstoolbox IK_LM.step", toolbox_step(q)),
    ):
        print(f"{name:34}" + (f"{microseconds(step):10.2f} us" if step else "   not installed"))
    loops = len(lap_loop().signatures)  # type: ignore[attr-defined]
    for name in sorted(costs, key=lambda name: -costs[name])[:SLOWEST]:
        print(f"lap / bare mj_step, {name:34}{lap_ratio(name):6.2f}")
    print(f"compiled loops before and after: {loops}, {len(lap_loop().signatures)}")  # type: ignore[attr-defined]


if __name__ == "__main__":
    main()
