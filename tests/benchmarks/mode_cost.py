"""What each method costs a control step, and what a lap costs under the costliest: run as a script.

``python tests/benchmarks/mode_cost.py [--toolbox PYTHON]``. Beside them, where installed (extra ``bench``),
the damped inverse kinematics step of mink for the same arm at the same pose, and that of the Robotics Toolbox
if an interpreter is named that has it, in a virtual environment of its own: what a researcher would otherwise
call. Both are general, and called from Python; trust orders of magnitude. All times are processor time.
Then a lap under each of the three costliest, beside as many bare ``mj_step`` calls as it contains, in turns.
"""

import argparse
import json
import statistics
import subprocess
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numba.core import types
from toolbox_step import damped_step, microseconds

from data.study import Maze, Mode
from data.study_file import read_study
from sim_trials.compiled import compiled
from sim_trials.kinematics import DH_A_M, DH_ALPHA_RAD, DH_D_M, HANDLE_OFFSET_M, handle_jacobian
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


def toolbox_times(python: str, q: np.ndarray) -> dict[str, float]:
    """Times [us] of the Robotics Toolbox by an interpreter that has it; see ``toolbox_step.py``."""
    lengths = [*DH_D_M[:5], DH_D_M[5] + HANDLE_OFFSET_M]
    arm = {"d": lengths, "a": list(DH_A_M), "alpha": list(DH_ALPHA_RAD), "q": q.tolist()}
    said = subprocess.run(
        [python, Path(__file__).with_name("toolbox_step.py")],
        input=json.dumps(arm),
        capture_output=True,
        text=True,
        check=True,
    )
    found = json.loads(said.stdout)
    J = np.empty((6, 6))
    handle_jacobian(q, J)
    np.testing.assert_allclose(found["J"], J, atol=1e-9)
    print(f"roboticstoolbox {found['version']} with NumPy {found['numpy']}: the same Jacobian")
    times: dict[str, float] = found["us"]
    return times


def lap_ratio(method: str) -> float:
    """A lap under a method over the bare physics steps in it: the median of several, in turns."""
    study = read_study("carmichael2017")
    study = study.model_copy(update={"modes": (Mode(name="X", method=method), study.modes[1])})
    operator, step = draw_operator(3), physics_step()
    trace = simulate(study, "X", operator, seed=1)
    robot = new_robot(trace.ticks["q"][trace.ticks.size // 2])
    ratios = []
    for _ in range(REPETITIONS):
        begin = time.thread_time()
        simulate(study, "X", operator, seed=1)
        lap = time.thread_time() - begin
        begin = time.thread_time()
        bare_steps(step, robot.model_address, robot.data_address, SUBSTEPS * (trace.ticks.size - 1))
        ratios.append(lap / (time.thread_time() - begin))
    return statistics.median(ratios)


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--toolbox", metavar="PYTHON", help="an interpreter that has roboticstoolbox-python")
    options = parser.parse_args()
    costs = {name: mode_curves(resolve(Mode(name="X", method=name))).cost_ns / 1000.0 for name in METHODS}
    for name, cost in sorted(costs.items(), key=lambda item: item[1]):
        print(f"{name:34}{cost:10.2f} us")
    q = np.array(start_angles(Maze()))
    q[2] = NEAR_LOCK_RAD
    step = mink_step(q)
    print(f"{'mink.solve_ik (daqp)':34}" + (f"{microseconds(step):10.2f} us" if step else "   not installed"))
    J, xdot = np.empty((6, 6)), np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
    handle_jacobian(q, J)
    ours = microseconds(lambda: damped_step(J, xdot, 0.2))
    print(f"{'damped inverse in NumPy':34}{ours:10.2f} us")
    if options.toolbox:
        times = toolbox_times(options.toolbox, q)
        # Both environments time the same NumPy step: through it their times are compared.
        scale = ours / times["NumPy alone"]
        for name, time_us in times.items():
            print(f"{'toolbox: ' + name:34}{time_us:10.2f} us{scale * time_us / costs['dls']:12.0f} x dls")
    loops = len(lap_loop().signatures)  # type: ignore[attr-defined]
    for name in sorted(costs, key=lambda name: -costs[name])[:SLOWEST]:
        print(f"lap / bare mj_step, {name:34}{lap_ratio(name):6.2f}")
    print(f"compiled loops before and after: {loops}, {len(lap_loop().signatures)}")  # type: ignore[attr-defined]


if __name__ == "__main__":
    main()
