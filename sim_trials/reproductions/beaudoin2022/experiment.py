"""The paper's experiment: three trajectories, three strategies, several readings of what is left open."""

from dataclasses import dataclass
from itertools import product

import numpy as np
import pandas as pd

from sim_trials.reproductions.beaudoin2022.claims import verdicts_of
from sim_trials.reproductions.beaudoin2022.robot import B
from sim_trials.reproductions.beaudoin2022.strategies import STRATEGIES, inverse_of, transpose_angle
from sim_trials.reproductions.beaudoin2022.trajectory import HARMONICS, Course, Reading, run
from sim_trials.reproductions.verdict import Progress, Reproduction

MIDDLE_M, END_M = B[2] / 2, B[2]
READINGS = (
    Reading(MIDDLE_M, 0.01, "velocity", 0.0, has_limits=False),
    Reading(MIDDLE_M, 0.1, "velocity", 0.0, has_limits=False),
    Reading(MIDDLE_M, 0.1, "velocity", 0.0),
    Reading(MIDDLE_M, 0.01, "velocity", 0.0),
    Reading(MIDDLE_M, 0.1, "displacement", 10.0),
    Reading(MIDDLE_M, 0.1, "displacement", 25.0),
    Reading(END_M, 0.1, "velocity", 0.0),
    Reading(END_M, 0.1, "displacement", 25.0),
)
"""The first one fits the figures best, against the paper's lambda^2 and limits; the third is its letter."""


@dataclass(frozen=True)
class Run:
    """One course and what it was a course of."""

    reading: int
    trajectory: int
    strategy: str
    course: Course


def reproduce(progress: Progress | None = None) -> Reproduction:
    """Run everything and judge the paper's claims; ``progress(done, total, what)`` after each course."""
    combinations = list(product(enumerate(READINGS), HARMONICS, STRATEGIES))
    runs = []
    for (i, r), harmonic, strategy in combinations:
        course = run(harmonic, inverse_of(strategy, r.damping_squared), r)
        runs.append(Run(i, harmonic.number, strategy, course))
        if progress is not None:
            progress(len(runs), len(combinations), f"trajectory {harmonic.number}, {strategy}")
    angles = angle_table(runs)
    return Reproduction(
        "beaudoin2022",
        "Beaudoin, Laliberte, Gosselin (2022), Inverse kinematics strategies for physical human-robot "
        "interaction using low-impedance passive link shells, doi:10.1017/S0263574722001102",
        {
            "angles": angles,
            "courses": course_table([r for r in runs if r.reading in (0, 2)]),
            "closed_form": closed_form_table(),
        },
        verdicts_of(angles, [r.words for r in READINGS]),
    )


def angle_table(runs: list[Run]) -> pd.DataFrame:
    """Largest psi and what limits were met, one row per reading, trajectory and strategy."""
    return pd.DataFrame(
        {
            "reading": [r.reading for r in runs],
            "assumption": [READINGS[r.reading].words for r in runs],
            "trajectory": [r.trajectory for r in runs],
            "strategy": [r.strategy for r in runs],
            "psi_max_deg": [r.course.psi_max_deg for r in runs],
            "joint_2_largest_deg": [float(np.degrees(np.abs(r.course.q[:, 1] - np.pi).max())) for r in runs],
            "fall_share": [r.course.fall_share for r in runs],
            "reaches_speed_limit": [r.course.reaches_speed_limit for r in runs],
            "reaches_acceleration_limit": [r.course.reaches_acceleration_limit for r in runs],
            "reaches_shell_limit": [r.course.reaches_shell_limit for r in runs],
        }
    )


def course_table(runs: list[Run]) -> pd.DataFrame:
    """psi and joint 2 over time, the curves of figs. 5 to 7."""
    return pd.concat(
        [
            pd.DataFrame(
                {
                    "reading": r.reading,
                    "trajectory": r.trajectory,
                    "strategy": r.strategy,
                    "time_s": r.course.time_s,
                    "psi_deg": r.course.psi_deg,
                    "joint_2_deg": np.degrees(np.pi - r.course.q[:, 1]),
                }
            )
            for r in runs
        ],
        ignore_index=True,
    )


def closed_form_table() -> pd.DataFrame:
    """psi of the transpose over how far joint 2 has turned, for both places of the shell."""
    phi = np.arange(0.0, 91.0)
    return pd.DataFrame(
        {
            "joint_2_deg": phi,
            "psi_middle_deg": np.degrees(transpose_angle(np.radians(phi), B[1], MIDDLE_M)),
            "psi_end_deg": np.degrees(transpose_angle(np.radians(phi), B[1], END_M)),
        }
    )
