"""``summary.json``: how the report came about and whether it ranks, for programs."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from importlib import metadata
from pathlib import Path

import pandas as pd

from analysis.lag import LagExclusion
from analysis.report.cautions import unanswered
from analysis.report.tables import neutralised_names
from analysis.results import Fit
from data.responses import ResponseTable
from data.study import Study

Json = str | int | float | bool | None | Mapping[str, "Json"] | Sequence["Json"]
VERSIONED = ("elbowroom", "numpy", "nutpie", "pymc", "arviz", "numba", "matplotlib")


def versions(engine: str) -> dict[str, str]:
    """Versions of Elbowroom and of what its numbers and figures depend on."""
    used = [
        name
        for name in VERSIONED
        if name not in {"fast": ("pymc",), "gibbs": ("pymc", "nutpie")}.get(engine, ())
    ]
    found = {}
    for name in used:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def known_comparisons(rows: pd.DataFrame) -> int:
    """How many comparisons responses name; people's may be numbered alike."""
    named = rows.loc[rows["comparison"] != "", ["participant", "comparison", "repetition"]]
    return len(named.drop_duplicates())


def summarise(
    table: ResponseTable,
    fit: Fit,
    study: Study | None,
    cautions: Sequence[str],
    checks: int,
    excluded: LagExclusion | None = None,
) -> dict[str, Json]:
    """The summary as plain values; nan and infinity become null."""
    rows = table.rows[~table.rows["check"].astype(bool)]
    comparisons = known_comparisons(rows)
    people = rows.loc[rows["participant"] != "", "participant"].nunique()
    warnings = [*fit.warnings, *(f"{q.question.name}: {w}" for q in fit.questions for w in q.warnings)]
    if changed := neutralised_names(fit):
        warnings.append(
            "In the CSV files these names have a ' before them, so that no spreadsheet runs them: "
            + ", ".join(changed)
        )
    return {
        "elbowroom_version": metadata.version("elbowroom"),
        "title": table.title,
        "study": {"name": study.name, "version": study.version, "sha256": study.sha256} if study else None,
        "simulated": table.is_simulated,
        "engine": fit.settings.engine,
        "model": fit.model,
        "priors": dict(fit.priors),
        "settings": asdict(fit.settings),
        "seed": fit.settings.seed,
        "data_sha256": table.sha256,
        "counts": {
            "participants": int(people),
            "comparisons": comparisons or None,
            "responses": int(rows["count"].sum()),
            "attention_checks": checks,
            "modes": len(fit.modes),
            "questions": len(fit.questions),
        },
        "left_out_for_lag": None
        if excluded is None
        else {
            "max_latency_ms": excluded.limits.latency_ms,
            "max_skipped_percent": excluded.limits.skipped_percent,
            "comparisons": list(excluded.comparisons),
            "of": excluded.total,
        },
        "rhat_max": _finite(fit.rhat_max),
        "ess_min": _finite(fit.ess_min),
        "divergences": fit.divergences,
        "converged": fit.converged,
        "ranked": fit.ranked and not unanswered(fit, study),
        "questions": {
            q.question.name: {
                "ranked": q.ranked,
                "reason": q.reason,
                "levels": q.question.levels,
                "levels_inferred": q.question.levels_inferred,
                "polarity": q.question.polarity,
                "modes": len(q.mode_names),
                "responses": q.n,
                "rhat_max": _finite(q.rhat_max),
                "ess_min": _finite(q.ess_min),
                "divergences": q.divergences,
                "missing_pairs": [list(pair) for pair in q.missing_pairs],
            }
            for q in fit.questions
        }
        | {name: _never_answered(name, study) for name in unanswered(fit, study)},
        "warnings": warnings,
        "before_you_quote_this": list(cautions),
        "versions": versions(fit.settings.engine),
    }


def _never_answered(name: str, study: Study | None) -> dict[str, Json]:
    """A question of the study that no row of the data is about: the same keys as the others."""
    assert study is not None
    question = next(q for q in study.questions if q.name == name)
    return {
        "ranked": False,
        "reason": "Nobody answered this question.",
        "levels": question.levels,
        "levels_inferred": False,
        "polarity": question.polarity,
        "modes": len(study.mode_names),
        "responses": 0,
        "rhat_max": None,
        "ess_min": None,
        "divergences": 0,
        "missing_pairs": [list(pair) for pair in study.pairs],
    }


def write_summary(summary: Mapping[str, Json], path: Path) -> None:
    """Write it as indented UTF-8 JSON."""
    text = json.dumps(summary, indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
