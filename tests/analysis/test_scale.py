"""What grows and what does not: cells instead of rows, limits said in words, engines on every scale."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.counts import count_responses
from analysis.engines.gibbs import is_proper
from analysis.fit import MOST_MODES, fit
from analysis.results import FitSettings, QuestionFit
from data.errors import InputError

SETTINGS = FitSettings(seed=11)


def summary(question: QuestionFit) -> dict[str, tuple[float, float]]:
    """Mean and sd of every reported quantity."""
    return {m.mode: (m.ability_mean, m.ability_sd) for m in question.modes} | {
        p.name: (p.mean, p.sd) for p in question.parameters
    }


def test_a_hundred_copies_of_an_answer_are_one_cell_of_a_hundred(simulated):
    table = simulated(3, participants=5)
    copies = table.rows.loc[table.rows.index.repeat(100)].reset_index(drop=True)
    once = count_responses(table, table.questions[0])
    often = count_responses(replace(table, rows=copies), table.questions[0])
    assert len(often.mode_a) == len(once.mode_a)
    assert np.array_equal(often.responses, 100 * once.responses)


def test_more_modes_than_a_report_can_hold_are_refused_in_a_line(table_of):
    n = 10_000
    rows = pd.DataFrame({"mode_a": [f"m{k}" for k in range(n)], "mode_b": [f"m{k + 1}" for k in range(n)]})
    with pytest.raises(InputError, match=f"10001 modes are more than .* at most {MOST_MODES}"):
        fit(table_of(rows.assign(response="A>B")), SETTINGS)


@pytest.mark.parametrize("pooled", [True, False])
def test_the_engines_agree_on_scales_of_two_three_and_five_levels(simulated, table_of, pooled):
    parts = [simulated(k, participants=8).rows.assign(question=f"{k} levels") for k in (2, 3, 5)]
    table = table_of(pd.concat(parts, ignore_index=True), modes=("M1", "M2", "M3"))
    assert [q.levels for q in table.questions] == [2, 3, 5]
    fast = fit(table, replace(SETTINGS, pooled=pooled))
    pymc = fit(table, replace(SETTINGS, pooled=pooled, engine="pymc"))
    for one, other in zip(fast.questions, pymc.questions, strict=True):
        a, b = summary(one), summary(other)
        assert a.keys() == b.keys()
        slack = 5 * np.sqrt(1 / one.ess_min + 1 / other.ess_min)
        for name, (mean, sd) in a.items():
            assert b[name][0] == pytest.approx(mean, abs=slack * sd), (one.question.name, name)
            assert b[name][1] == pytest.approx(sd, rel=slack), (one.question.name, name)


@pytest.mark.parametrize(
    ("wins", "ties", "proper"),
    [
        ([[0, 0], [0, 0]], {(0, 1): 9}, False),
        ([[0, 1], [0, 0]], {(0, 1): 9}, False),
        ([[0, 9], [0, 0]], {(0, 1): 9}, False),
        ([[0, 1], [1, 0]], {(0, 1): 9}, True),
        ([[0, 9, 0], [0, 0, 0], [0, 0, 0]], {(1, 2): 3, (0, 2): 3}, False),
        ([[0, 9, 9], [0, 0, 9], [0, 0, 0]], {(0, 1): 3}, True),
    ],
)
def test_gibbs_knows_when_its_flat_prior_on_ties_leaves_no_posterior(wins_table, wins, ties, proper):
    table = wins_table(wins, ties)
    assert is_proper(count_responses(table, table.questions[0])) is proper


def test_gibbs_refuses_ties_alone_and_the_fast_engine_ranks_them(wins_table):
    table = wins_table([[0, 0], [0, 0]], {(0, 1): 20})
    refused = fit(table, replace(SETTINGS, engine="gibbs"))
    assert not refused.ranked
    assert "no proper posterior" in refused.questions[0].reason
    assert fit(table, SETTINGS).ranked


def test_gibbs_says_that_it_has_its_own_prior_and_names_its_cut_point(simulated):
    found = fit(simulated(3), replace(SETTINGS, engine="gibbs", prior_sd=2.0))
    assert any("prior sd of 2 is not used" in warning for warning in found.warnings)
    assert [p.name for p in found.questions[0].parameters] == ["cut_1"]
    silent = fit(simulated(3), replace(SETTINGS, engine="gibbs"))
    assert not any("prior sd" in warning for warning in silent.warnings)
