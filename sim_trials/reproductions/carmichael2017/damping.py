"""Equations (1) and (2) of the 2017 paper, and what its three modes make of them on the UR10."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from data.study import Maze
from sim_trials.mode_atlas import mode_curves
from sim_trials.modes.damped_inverse import scheduled_damping
from sim_trials.modes.method import ResolvedMode

TABLE_1 = {"M1": (0.2, 0.2), "M2": (0.6, 0.6), "M3": (0.6, 0.2)}
"""lambda_0 of each mode towards the singularity and away from it (table 1)."""
SIGMA_T = 0.25
"""Section 2."""
WAYS = ("towards", "away")


def damping_table(modes: Sequence[ResolvedMode], maze: Maze) -> pd.DataFrame:
    """What each mode answers along the direction that the lock takes away, beside eqs. (1) and (2).

    Returns
    -------
    DataFrame
        One row per ``mode``, ``way`` and pose of the arm, falling in ``sigma``. ``damping`` and ``gain``
        (velocity along the command over the command) are those of the compiled mode; ``damping_eq2`` and
        ``gain_eq1`` those of the equations; ``amplification`` is the norm of the joint velocities over
        that of the command, sigma / (sigma^2 + lambda^2); ``inverse`` is 1 / sigma, without damping.
    """
    parts = []
    for mode in modes:
        curves = mode_curves(mode, maze)
        for k, (way, curve) in enumerate(zip(WAYS, (curves.towards, curves.away), strict=True)):
            damping = np.array([scheduled_damping(s, TABLE_1[mode.name][k], SIGMA_T) for s in curves.sigma])
            below = curves.sigma**2 + damping**2
            parts.append(
                pd.DataFrame(
                    {
                        "mode": mode.name,
                        "way": way,
                        "sigma": curves.sigma,
                        "damping": curve.damping,
                        "gain": curve.gain,
                        "damping_eq2": damping,
                        "gain_eq1": curves.sigma**2 / below,
                        "amplification": curves.sigma / below,
                        "inverse": 1.0 / curves.sigma,
                    }
                )
            )
    return pd.concat(parts, ignore_index=True)
