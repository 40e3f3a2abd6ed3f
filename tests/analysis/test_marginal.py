"""Points of one person's deviations: those to choose from have the tails of what they stand for."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.answer_shares import ThinnedDraws
from analysis.counts import count_responses
from analysis.marginal import deviations, spread_normal
from analysis.model import model_of
from analysis.results import FitSettings

DRAWS = 4000


def test_own_deviations_of_somebody_who_said_little_reach_as_far_as_the_prior(table_of):
    rows = pd.DataFrame([("p0", "M1", "M2", "A=B")], columns=["participant", "mode_a", "mode_b", "response"])
    table = table_of(rows, levels=3)
    model = model_of(FitSettings(), 3, has_participants=True)
    parameters = {"side_effect": 0.0, "cut_1": 6.0, "subject_sd": 0.5}
    draws = ThinnedDraws(
        np.zeros((DRAWS, 2)), {name: np.full(DRAWS, value) for name, value in parameters.items()}
    )
    counts = count_responses(table, table.questions[0])
    (person,) = deviations(counts, model, draws, 16, np.random.default_rng(1))
    weight = np.exp(person.log_weight)
    z = np.abs(person.at[..., 0])
    for reach in (1.0, 2.0, 2.5):
        beyond = (weight * (z > reach)).sum(axis=1) / weight.sum(axis=1)
        assert beyond.mean() == pytest.approx(2 * stats.norm.sf(reach), abs=0.004)


def test_points_spread_over_all_strips_wherever_in_them_they_lie():
    within = np.random.default_rng(2).random((3, 16, 2))
    strips = np.sort(np.floor(16 * stats.norm.cdf(spread_normal(2, 16, within))), axis=1)
    np.testing.assert_array_equal(strips, np.broadcast_to(np.arange(16.0)[:, None], strips.shape))
