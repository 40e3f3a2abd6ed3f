"""What a tick of a live trial costs, called from Python: ``python tests/benchmarks/bench_live.py``.

Ten trials run in turns, as in one worker process, under the scripted hand; timed are `LiveTrial.advance` and
`LiveTrial.view`, and beside them the bare physics steps of a tick, from a compiled loop. Trust the ratio, not
the microseconds.
"""

import statistics
import time

from numba.core import types

from data.study_file import read_study
from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.compiled import compiled
from sim_trials.live import LiveTrial, warm_up
from sim_trials.loop import SUBSTEPS
from sim_trials.model import STEP_TYPE, new_robot, physics_step
from sim_trials.scripted_hand import ScriptedHand
from sim_trials.start import start_angles

TRIALS = 10
TICKS = 1500


@compiled(types.void(STEP_TYPE, types.intp, types.intp, types.int64), cache=False)
def bare_steps(step: object, model: int, data: int, n: int) -> None:
    """Call the physics step n times."""
    for _ in range(n):
        step(model, data)


def main() -> None:
    """Print how long tick, view and bare physics steps take."""
    study = read_study("carmichael2017")
    start = time.perf_counter()
    warm_up(study)
    print(f"warm-up {1e3 * (time.perf_counter() - start):.0f} ms")
    start = time.perf_counter()
    trials = [LiveTrial(study, study.mode_names[i % len(study.mode_names)]) for i in range(TRIALS)]
    print(f"a new trial {1e3 * (time.perf_counter() - start) / TRIALS:.2f} ms")
    hands = [ScriptedHand(study, 0.08 + 0.005 * i) for i in range(TRIALS)]
    robot = new_robot(start_angles(study.maze))
    bare_steps(physics_step(), robot.model_address, robot.data_address, SUBSTEPS)
    ticks, views, bare = [], [], []
    for _ in range(TICKS):
        inputs = [hand.aim(trial.view, CONTROL_PERIOD_S) for hand, trial in zip(hands, trials, strict=True)]
        start = time.perf_counter()
        for trial, hand in zip(trials, inputs, strict=True):
            trial.advance(hand)
        advanced = time.perf_counter()
        for trial in trials:
            _ = trial.view
        viewed = time.perf_counter()
        bare_steps(physics_step(), robot.model_address, robot.data_address, SUBSTEPS * TRIALS)
        stepped = time.perf_counter()
        ticks.append((advanced - start) / TRIALS)
        views.append((viewed - advanced) / TRIALS)
        bare.append((stepped - viewed) / TRIALS)
    print(f"{TICKS} ticks of {TRIALS} trials\n{'':26}{'min':>9}{'median':>9}{'99 %':>9}")
    for name, times in (("tick [us]", ticks), ("view [us]", views), ("bare physics steps [us]", bare)):
        ordered = sorted(times)
        figures = (ordered[0], statistics.median(ordered), ordered[int(0.99 * len(ordered))])
        print(f"{name:26}" + "".join(f"{1e6 * figure:9.1f}" for figure in figures))
    ratio = statistics.median(t / b for t, b in zip(ticks, bare, strict=True))
    print(f"{'tick / bare':26}{min(ticks) / min(bare):9.3f}{ratio:9.3f}")


if __name__ == "__main__":
    main()
