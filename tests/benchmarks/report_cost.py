"""What a report costs beside PyMC: python tests/benchmarks/report_cost.py STORE

STORE is a demo's ``study.sqlite`` (42 comparisons, six questions). Whole processes are timed, imports and
compilation included: ``elbowroom report`` twice (the first may have to fill caches), and a script that does
six ``pm.sample`` fits with default settings of the same models. The smallest bulk or tail ESS over everything
that is reported stands beside both; then the stages of the report, in a process of their own.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path


def timed(command: list[str]) -> tuple[float, float, str]:
    """Wall seconds, processor seconds, and what a whole process prints."""
    start, before = time.perf_counter(), os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return time.perf_counter() - start, spent, done.stdout


def sample_with_pymc(store: str) -> None:
    """Six fits by PyMC's own sampler, each of one question's model; prints the smallest ESS."""
    import numpy as np
    import pymc as pm

    from analysis.counts import count_responses
    from analysis.diagnostics import convergence
    from analysis.engines.pymc_engine import joint_model
    from analysis.model import Problem, model_of
    from analysis.results import FitSettings
    from analysis.softmax import worth_of
    from data.store import Store

    with Store.open(store, create=False) as opened:
        table = opened.responses_table(opened.study(None), include_simulated=True)
    smallest = np.inf
    for question in table.questions:
        model = model_of(FitSettings(), question.levels, table.has_participants)
        joint = joint_model([Problem(count_responses(table, question), model)])
        with joint.model:
            posterior = pm.sample(progressbar=False, random_seed=1).posterior
        ability = posterior[f"{joint.blocks[0].prefix}ability"].to_numpy()[:, :, 0]
        drawn = [*np.moveaxis(ability, -1, 0), *np.moveaxis(worth_of(ability), -1, 0)]
        for name in ("side_effect", "subject_sd", "cuts"):
            values = posterior[joint.blocks[0].prefix + name].to_numpy()
            drawn += list(np.moveaxis(values.reshape(*values.shape[:2], -1), -1, 0))
        smallest = min(smallest, convergence(np.stack(drawn)).ess_min)
    print(float(smallest))


def profile_stages(store: str) -> None:
    """Seconds of each stage of one report."""
    marks = [("start", time.perf_counter())]

    def mark(stage: str) -> None:
        marks.append((stage, time.perf_counter()))

    from analysis.fit import fit
    from analysis.report import write_report
    from data.store import Store

    mark("imports")
    with Store.open(store, create=False) as opened:
        study = opened.study(None)
        table = opened.responses_table(study, include_simulated=True)
        stuck = opened.stuck_table(study, include_simulated=True)
    mark("reading the store")
    found = fit(table)
    mark("fitting")
    under_way = "checks and cautions"

    def stage_done(done: int, total: int, now: str) -> None:
        nonlocal under_way
        mark(under_way)
        under_way = now

    with tempfile.TemporaryDirectory() as folder:
        write_report(
            table, found, Path(folder) / "report", stuck=stuck, study=study.study, progress=stage_done
        )
    for (_, start), (stage, end) in pairwise(marks):
        print(f"  {stage:<24} {end - start:6.2f} s")


def compare(store: str) -> None:
    """Both ways, in one run."""
    spent: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "report"
        command = [sys.executable, "-m", "app.cli", "report", "--store", store, "--include-simulated"]
        for name in ("report, first", "report, again"):
            wall, processor, _ = timed([*command, "--out", str(out)])
            spent[name] = wall
            ess = json.loads((out / "summary.json").read_text())["ess_min"]
            print(f"{name:<26} {wall:7.2f} s   processor {processor:7.2f} s   ESS {ess:6.0f}", flush=True)
            spent[f"{name} processor"] = processor
    wall, processor, said = timed([sys.executable, __file__, "--pymc", store])
    print(f"{'six pm.sample fits':<26} {wall:7.2f} s   processor {processor:7.2f} s   ESS {float(said):6.0f}")
    ratio, of_processor = wall / spent["report, again"], processor / spent["report, again processor"]
    print(f"{'ratio, PyMC over report':<26} {ratio:7.2f}     processor {of_processor:7.2f}", flush=True)
    print("stages of a report")
    print(timed([sys.executable, __file__, "--stages", store])[2], end="")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["--pymc", place]:
            sample_with_pymc(place)
        case ["--stages", place]:
            profile_stages(place)
        case [place]:
            compare(place)
        case _:
            sys.exit(__doc__)
