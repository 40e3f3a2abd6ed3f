"""`elbowroom trial`: one simulated lap."""

import json as json_format
from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import SeedOption, StudyOption


def trial(
    mode: Annotated[str, typer.Option("--mode", metavar="NAME", help="A mode of the study.")],
    operator_seed: Annotated[
        int, typer.Option("--operator-seed", min=0, metavar="N", help="Which simulated person guides.")
    ] = 3,
    seed: SeedOption = 1,
    study: StudyOption = "carmichael2017",
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.parquet", help="Write the recording here.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Let a simulated person guide one lap under one mode.

    Example: elbowroom trial --mode M1 --operator-seed 3 --out lap.parquet
    """
    from app.studies import open_study, resolved_modes
    from sim_trials.operators import draw_operator
    from sim_trials.trial import run_trial

    opened = open_study(study)
    resolved_modes(opened.study, study)
    result = run_trial(opened.study, mode, draw_operator(operator_seed), seed=seed)
    sha256 = result.recording.write(out) if out is not None else None
    if json:
        content = {
            "study": opened.study.name,
            "mode": mode,
            "operator_seed": operator_seed,
            "seed": seed,
            "simulated": True,
            "outcome": result.outcome,
            "duration_s": result.duration_s,
            "metrics": result.metrics,
            "events": [vars(event) for event in result.events],
            "recording_sha256": sha256,
        }
        print(json_format.dumps(content, indent=2, allow_nan=False, default=str))
        return
    whose = f"{mode}, operator {operator_seed}, seed {seed} (simulated)"
    print(f"{whose}: {result.outcome} after {result.duration_s:.1f} s")
    for event in result.events:
        print(f"  {event.kind} at {event.time_s:.2f} s ({event.phase}, sigma_min {event.sigma_min:.4f})")
    for name, value in result.metrics.items():
        print(f"  {name:<28} {value:.4g}")
    if out is not None:
        print(f"recording: {out} (sha256 {sha256})")
