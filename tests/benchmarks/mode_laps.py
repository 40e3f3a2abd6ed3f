"""What becomes of laps under every method at its defaults: ``python tests/benchmarks/mode_laps.py``.

First laps of a dozen simulated operators on the maze of the 2017 study, and a live lap of the scripted hand.
M1 and M2 of that study are `dls` with lambda0 = 0.2, its default, and 0.6.
"""

import argparse
import os

from data.study import Mode
from data.study_file import read_study
from sim_trials.mode_laps import ModeLaps, mode_laps
from sim_trials.modes.registry import METHODS

COLUMNS = (
    f"{'mode':32}{'done':>6}{'stuck':>6}{'stop':>6}{'peak':>6}{'edge':>7}{'exit':>6}{'chatter':>9}  live"
)
UNITS = f"{'':32}{'share':>6}{'share':>6}{'share':>6}{'share':>6}{'N':>7}{'gain':>6}{'1/s':>9}"


def row(laps: ModeLaps) -> str:
    """One line of the table."""
    return (
        f"{laps.name:32}{laps.share('completed'):6.2f}{laps.share('stuck'):6.2f}{laps.share('failed'):6.2f}"
        f"{laps.peak_joint_speed:6.2f}{laps.mean('force_edge_n'):7.1f}{laps.mean('gain_exit'):6.2f}"
        f"{laps.mean('chatter_hz'):9.2f}  {laps.live_outcome} {laps.live_duration_s:.1f} s: {laps.verdict}"
    )


def main() -> None:
    """Print a line a mode."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--operators", type=int, default=12)
    parser.add_argument("--method", action="append", help="only this one; may be given several times")
    options = parser.parse_args()
    study = read_study("carmichael2017")
    modes = [Mode(name=name, method=name) for name in METHODS if not options.method or name in options.method]
    if not options.method:
        modes.append(Mode(name="dls_heavy", method="dls", parameters={"lambda0": 0.6}))
    study = study.model_copy(update={"modes": tuple(modes)})
    print(COLUMNS, UNITS, sep="\n")
    for mode in modes:
        print(row(mode_laps(study, mode.name, range(options.operators), os.cpu_count() or 1)), flush=True)


if __name__ == "__main__":
    main()
