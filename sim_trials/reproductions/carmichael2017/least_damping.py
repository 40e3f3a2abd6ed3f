"""How little damping the robot bears: what led to M1's lambda_0 (section 2 of the 2017 paper)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from data.study import Mode, Study
from sim_trials.batch import Progress, map_jobs
from sim_trials.events import events
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S
from sim_trials.metrics import phases
from sim_trials.operators import draw_operator
from sim_trials.reproductions.carmichael2017.damping import SIGMA_T
from sim_trials.trial import OUTCOMES, simulate

DAMPINGS = (0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
"""lambda_0 that are tried, up to M1's."""
_LIMITS = np.array(JOINT_SPEED_LIMITS_RAD_S)


@dataclass(frozen=True)
class _Job:
    study: Study
    damping: float
    seed: int


@dataclass(frozen=True)
class _Lap:
    outcome: str
    is_stopped: bool
    is_inverted: bool
    peak_joint_speed: float


def least_damping_table(
    study: Study, people: Sequence[int], n_jobs: int = 1, progress: Progress | None = None
) -> pd.DataFrame:
    """First laps of some simulated operators with less and less damping.

    Returns
    -------
    DataFrame
        One row per ``lambda0``: ``laps``, how many of them had a protective stop (a joint at 98 % of its
        speed limit), an elbow that went over to its other side, or were ``stuck`` or ``completed``, and the
        fastest joint of all laps as a share of its limit.
    """
    jobs = [_Job(_with_damping(study, d), d, seed) for d in DAMPINGS for seed in people]
    laps = []
    for job, lap in zip(jobs, map_jobs(_run, jobs, n_jobs), strict=True):
        laps.append(lap)
        if progress is not None:
            progress(len(laps), len(jobs), f"lambda0 = {job.damping:g}")
    rows = []
    for k, damping in enumerate(DAMPINGS):
        part = laps[k * len(people) : (k + 1) * len(people)]
        rows.append(
            (
                damping,
                len(part),
                sum(lap.is_stopped for lap in part),
                sum(lap.is_inverted for lap in part),
                sum(lap.outcome == "stuck" for lap in part),
                sum(lap.outcome == "completed" for lap in part),
                max(lap.peak_joint_speed for lap in part),
            )
        )
    columns = ["lambda0", "laps", "protective_stops", "elbow_inversions", "stuck", "completed"]
    return pd.DataFrame(rows, columns=[*columns, "peak_joint_speed_share"])


def _with_damping(study: Study, damping: float) -> Study:
    mode = Mode(name="M1", method="dls", parameters={"lambda0": damping, "sigma_t": SIGMA_T})
    others = tuple(m for m in study.modes if m.name != mode.name)
    return study.model_copy(update={"modes": (mode, *others)})


def _run(job: _Job) -> _Lap:
    trace = simulate(job.study, "M1", draw_operator(job.seed), seed=job.seed)
    kinds = {event.kind for event in events(trace, phases(trace, job.study), job.study.stuck)}
    return _Lap(
        OUTCOMES[trace.ending],
        "protective_stop" in kinds,
        "elbow_inversion" in kinds,
        float(np.abs(trace.ticks["qdot"] / _LIMITS).max()),
    )
