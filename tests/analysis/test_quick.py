"""The console's ranking against the sampled one."""

import pytest

from analysis.counts import count_responses
from analysis.fit import fit
from analysis.quick import quick_ranking
from analysis.results import FitSettings


@pytest.mark.parametrize("levels", [2, 3, 5])
def test_the_quick_ranking_is_close_to_the_pooled_fit(simulated, levels):
    table = simulated(levels)
    quick = quick_ranking(count_responses(table, table.questions[0]), table.modes)
    found = fit(table, FitSettings(pooled=True)).questions[0]
    for rough, mode in zip(quick.modes, found.modes, strict=True):
        assert rough.mode == mode.mode
        assert rough.worth == pytest.approx(mode.worth_mean, abs=0.02)
        assert rough.worth_low == pytest.approx(mode.worth_hdi_low, abs=0.03)
        assert rough.worth_high == pytest.approx(mode.worth_hdi_high, abs=0.03)
        assert rough.p_best == pytest.approx(mode.p_best, abs=0.03)


def test_modes_that_cannot_be_ranked_have_a_reason(table_of, answers_of, truth):
    table = table_of(answers_of(truth, levels=3, participants=2), modes=["M1", "M2", "M3", "M4"])
    quick = quick_ranking(count_responses(table, table.questions[0]), table.modes)
    assert quick.modes == ()
    assert "M4 was never compared" in quick.reason


def test_a_mode_that_always_wins_has_a_finite_interval(wins_table):
    table = wins_table([[0, 5, 5], [0, 0, 3], [0, 2, 0]])
    best = quick_ranking(count_responses(table, table.questions[0]), table.modes).modes[0]
    assert 1 / 3 < best.worth_low < best.worth < best.worth_high < 1.0
