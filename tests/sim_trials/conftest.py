"""Laps that several tests look at, each run once."""

from collections.abc import Callable
from functools import cache

import pytest

from data.study import Study
from data.study_file import read_study
from sim_trials.operators import draw_operator
from sim_trials.trial import TrialResult, run_trial

STUCK_OPERATOR = 6
"""An operator that gets stuck in its first lap under M1, and not under M2 or M3."""


@pytest.fixture(scope="session")
def study() -> Study:
    return read_study("carmichael2017")


@pytest.fixture(scope="session")
def first_lap(study: Study) -> Callable[[str], TrialResult]:
    """The first lap of `STUCK_OPERATOR` under a mode."""
    return cache(lambda mode: run_trial(study, mode, draw_operator(STUCK_OPERATOR), seed=STUCK_OPERATOR))
