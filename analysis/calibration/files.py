"""A calibration as files: tables for programs, figures for people, a summary for both."""

import json
from dataclasses import asdict
from importlib import metadata
from pathlib import Path

import numpy as np
import pandas as pd

from analysis.calibration.outcome import Calibration
from analysis.calibration.uniformity import DRAWS_RANKED, FALSE_ALARM, Coverage
from analysis.calibration.verdict import notes, verdict
from analysis.model import describe, priors
from data.locations import writing_folder

SUMMARY = "summary.json"
"""The summary; it also tells an earlier result's folder, which may be replaced."""
RANKS, REPLICATES, COVERAGE, ECDF = "ranks.csv", "replicates.csv", "coverage.csv", "ecdf.csv"
FIGURES = ("rank_histograms", "ecdf_differences", "coverage")
CALIBRATION_FILES = (
    SUMMARY,
    RANKS,
    REPLICATES,
    COVERAGE,
    ECDF,
    *(f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg")),
)


def write_calibration(result: Calibration, out: Path) -> tuple[Path, ...]:
    """Write tables, figures and summary into a folder; the paths are returned.

    Raises
    ------
    InputError
        If the folder holds something else.
    """
    from analysis.figures.calibration import draw_calibration

    tables = {
        RANKS: result.table,
        REPLICATES: replicate_table(result),
        COVERAGE: coverage_table(result),
        ECDF: ecdf_table(result),
    }
    with writing_folder(out, marker=SUMMARY, owns=CALIBRATION_FILES) as folder:
        for name, table in tables.items():
            table.to_csv(folder / name, index=False, lineterminator="\n")
        for drawing in draw_calibration(result):
            drawing.write(folder)
        text = json.dumps(summarise(result), indent=2, ensure_ascii=False, allow_nan=False)
        (folder / SUMMARY).write_text(text + "\n", encoding="utf-8", newline="\n")
    return tuple(out / name for name in CALIBRATION_FILES)


def replicate_table(result: Calibration) -> pd.DataFrame:
    """One row a replicate: how its sampling went."""
    columns = ("number", "converged", "rhat_max", "ess_min", "divergences")
    rows = [{name: getattr(r, name) for name in columns} for r in result.replicates]
    return pd.DataFrame(rows).rename(columns={"number": "replicate"})


def coverage_table(result: Calibration) -> pd.DataFrame:
    """One row a quantity and level: parameter, level, coverage, band_low, band_high, inside."""
    return pd.DataFrame([{**vars(check), "inside": check.inside} for check in result.coverages])


def ecdf_table(result: Calibration) -> pd.DataFrame:
    """One row a quantity: how far its ECDF is from uniform, and whether that is chance."""
    return pd.DataFrame([{**vars(check), "inside": check.inside} for check in result.uniformities])


def summarise(result: Calibration) -> dict[str, object]:
    """The settings and what came of them, as plain values."""
    model, settings = result.model, result.settings
    sampler = {k: v for k, v in asdict(settings).items() if k != "seed"}
    ess = [r.ess_min for r in result.converged]
    return {
        "elbowroom_version": metadata.version("elbowroom"),
        "nutpie_version": metadata.version("nutpie"),
        "calibrated": result.is_calibrated,
        "verdict": verdict(result),
        "notes": list(notes(result)),
        "drawn_from": asdict(model),
        "fitted_with": {
            "model": describe(settings, not settings.pooled),
            "priors": priors(settings, {model.levels}, not settings.pooled),
            **sampler,
        },
        "design": {**asdict(result.design), "answers": result.design.answers},
        "seed": result.seed,
        "replicates": len(result.replicates),
        "not_converged": result.failures,
        "divergences": sum(r.divergences for r in result.replicates),
        "ess_min": {"least": min(ess), "median": float(np.median(ess))},
        "draws_ranked": DRAWS_RANKED,
        "false_alarm": FALSE_ALARM,
        "checks": {"coverage": len(result.coverages), "ecdf": len(result.uniformities)},
        "outside": [
            {
                "check": "coverage" if isinstance(check, Coverage) else "ecdf",
                **{k: v for k, v in vars(check).items() if k != "limit"},
            }
            for check in result.outside
        ],
        "outside_with_not_converged": result.outside_with_failures,
    }
