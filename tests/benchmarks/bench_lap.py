"""What a lap costs beside the bare physics steps in it: ``python tests/benchmarks/bench_lap.py``.

Both are timed in turns in one process: a lap of a simulated operator (from its noise to its trace), and as
many calls of ``mj_step``, from a compiled loop, on the same model, at rest where the lap was half way. Trust
the ratio, not the milliseconds.
"""

import statistics
import time

from numba.core import types

from data.study_file import read_study
from sim_trials.compiled import compiled
from sim_trials.loop import SUBSTEPS
from sim_trials.model import STEP_TYPE, new_robot, physics_step
from sim_trials.operators import draw_operator
from sim_trials.trial import run_trial, simulate

REPETITIONS = 15


@compiled(types.void(STEP_TYPE, types.intp, types.intp, types.int64), cache=False)
def bare_steps(step: object, model: int, data: int, n: int) -> None:
    """Call the physics step n times."""
    for _ in range(n):
        step(model, data)


def main() -> None:
    """Print minimum and median of the lap, the bare steps, and their ratio."""
    study = read_study("carmichael2017")
    operator, step = draw_operator(3), physics_step()
    trace = simulate(study, "M2", operator, seed=1)
    # A lap ends in the tick that brings the cursor home, without physics of its own.
    ticks = trace.ticks.size - 1
    robot = new_robot(trace.ticks["q"][ticks // 2])
    run_trial(study, "M2", operator, seed=1)
    laps, bare, whole = [], [], []
    for _ in range(REPETITIONS):
        start = time.perf_counter()
        simulate(study, "M2", operator, seed=1)
        laps.append(time.perf_counter() - start)
        start = time.perf_counter()
        bare_steps(step, robot.model_address, robot.data_address, SUBSTEPS * ticks)
        bare.append(time.perf_counter() - start)
        start = time.perf_counter()
        run_trial(study, "M2", operator, seed=1)
        whole.append(time.perf_counter() - start)
    print(f"{ticks} control ticks, {SUBSTEPS * ticks} physics steps, {REPETITIONS} repetitions")
    print(f"{'':34}{'min':>9}{'median':>9}")
    for name, times in (
        ("bare mj_step [ms]", bare),
        ("lap [ms]", laps),
        ("lap with metrics and events [ms]", whole),
    ):
        print(f"{name:34}{1e3 * min(times):9.1f}{1e3 * statistics.median(times):9.1f}")
    for name, times in (("lap / bare", laps), ("lap with metrics and events / bare", whole)):
        ratio = statistics.median(t / b for t, b in zip(times, bare, strict=True))
        print(f"{name:34}{min(times) / min(bare):9.3f}{ratio:9.3f}")


if __name__ == "__main__":
    main()
