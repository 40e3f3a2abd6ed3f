"""Many answers: python tests/benchmarks/scale.py [million] [schools] [cells] [hundred]

- ``million``: 1,000,000 pooled comparisons of 100 modes, from the CSV to draws, beside evalica from the same
  file to its point estimate (extra ``bench``). Whole processes, imports included.
- ``schools``: 303 people's preferences between six business schools, hierarchical.
- ``cells``: the same pairs of ten modes 1, 10 and 100 times: the cost follows the cells, not the rows.
- ``hundred``: 100,000 comparisons of 100 modes by 1000 people, hierarchical: 99,000 deviations. nutpie keeps
  every coordinate and gradient of two chains at a time: about 5 GB on two cores.

Prints wall and processor seconds, the peak of memory, R-hat and ESS. Without names, the first three are run.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd

SCHOOLS = Path(__file__).parents[1] / "reference" / "cems.csv"


def write_answers(path: Path, n: int, modes: int, people: int = 0, times: int = 1) -> Path:
    """Answers on three levels from planted abilities, each row ``times`` over."""
    rng = np.random.default_rng(1)
    ability = rng.normal(size=modes)
    a = rng.integers(modes, size=n)
    b = (a + rng.integers(1, modes, size=n)) % modes
    felt = ability[a] - ability[b] + rng.logistic(size=n)
    columns = {}
    if people:
        person = rng.integers(people, size=n)
        own = rng.normal(scale=0.5, size=(people, modes))
        felt += own[person, a] - own[person, b]
        columns["participant"] = np.array([f"p{k:05d}" for k in range(people)])[person]
    names = np.array([f"mode {k:03d}" for k in range(modes)])
    columns |= {"mode_a": names[a], "mode_b": names[b]}
    columns["response"] = np.select([felt > 0.4, felt < -0.4], ["A>B", "B>A"], "A=B")
    frame = pd.DataFrame(columns)
    frame.loc[frame.index.repeat(times)].to_csv(path, index=False)
    return path


def draw(path: str, *options: str) -> None:
    """From a CSV to posterior draws, in a process of its own."""
    from analysis.fit import fit
    from analysis.results import FitSettings
    from data.response_csv import read_response_csv

    table = read_response_csv(Path(path))
    read = time.process_time()
    found = fit(table, FitSettings(pooled="pooled" in options, side_effect="sides" in options))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"imports and reading {read:.1f} s, R-hat {found.rhat_max:.4f}, ESS {found.ess_min:.0f}, "
        f"{peak:.0f} MB{'' if found.converged else ', NOT converged'}"
    )


def estimate_with_evalica(path: str) -> None:
    """From the same CSV to evalica's maximum-likelihood scores."""
    import evalica

    rows = pd.read_csv(path)
    winner = {"A>B": evalica.Winner.X, "A=B": evalica.Winner.Draw, "B>A": evalica.Winner.Y}
    found = evalica.bradley_terry(rows["mode_a"], rows["mode_b"], rows["response"].map(winner))
    print(f"{len(found.scores)} scores")


def timed(name: str, *arguments: str) -> tuple[float, float]:
    """Wall and processor seconds of a whole process of this file; prints what it says."""
    start, before = time.perf_counter(), os.times()
    done = subprocess.run(
        [sys.executable, __file__, *arguments], stdout=subprocess.PIPE, text=True, check=True
    )
    wall, after = time.perf_counter() - start, os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    print(f"{name:<40} {wall:7.1f} s   processor {spent:7.1f} s   {done.stdout.strip()}", flush=True)
    return wall, spent


def main(cases: list[str]) -> None:
    """Run the named cases one after another."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if "million" in cases:
            path = str(write_answers(folder / "million.csv", 1_000_000, 100))
            timed("(evalica, caches)", "--evalica", path)
            estimate = timed("1,000,000 x 100 modes, evalica", "--evalica", path)
            draws = timed("1,000,000 x 100 modes, draws", "--draw", path, "pooled", "sides")
            print(f"{'ratio, draws over estimate':<40} {draws[0] / estimate[0]:7.1f}     "
                  f"processor {draws[1] / estimate[1]:7.1f}")  # fmt: skip
        if "schools" in cases:
            timed("303 people x 15 pairs, hierarchical", "--draw", str(SCHOOLS))
        if "cells" in cases:
            for times in (1, 10, 100):
                path = str(write_answers(folder / f"cells{times}.csv", 5_000, 10, people=50, times=times))
                timed(f"{5000 * times:,} rows, the same cells", "--draw", path, "sides")
        if "hundred" in cases:
            path = str(write_answers(folder / "hundred.csv", 100_000, 100, people=1000))
            timed("100,000 x 100 modes x 1000 people", "--draw", path)


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["--draw", place, *options]:
            draw(place, *options)
        case ["--evalica", place]:
            estimate_with_evalica(place)
        case cases:
            main(cases or ["million", "schools", "cells"])
