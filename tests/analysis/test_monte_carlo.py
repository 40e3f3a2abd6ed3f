"""Monte Carlo errors are as large as means and chances differ from seed to seed."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.fit import fit
from analysis.monte_carlo import chance_errors, mean_errors, monte_carlo_errors
from analysis.observed_design import observed_design
from analysis.results import FitSettings


def chains(rho: float, studies: int, seed: int = 1) -> np.ndarray:
    """Autoregressive draws of mean 0 and sd 1, shape (study, 4, 1000)."""
    noise = np.random.default_rng(seed).standard_normal((studies, 4, 1000))
    draws = np.empty_like(noise)
    draws[..., 0] = noise[..., 0]
    for k in range(1, 1000):
        draws[..., k] = rho * draws[..., k - 1] + np.sqrt(1 - rho**2) * noise[..., k]
    return draws


@pytest.mark.parametrize("rho", [-0.3, 0.0, 0.7])
def test_means_and_chances_of_dependent_draws_vary_by_their_errors(rho):
    draws = chains(rho, 300)
    assert draws.mean(axis=(1, 2)).std() == pytest.approx(mean_errors(draws).mean(), rel=0.15)
    holds = draws > 1.0
    assert holds.mean(axis=(1, 2)).std() == pytest.approx(chance_errors(holds).mean(), rel=0.15)


def test_a_chance_that_held_in_every_draw_is_not_certain():
    error = float(chance_errors(np.ones((1, 4, 1000), dtype=bool))[0])
    assert 1 / 5000 < error < 1 / 3000


def test_errors_of_a_fit_are_what_other_seeds_change(simulated):
    table = simulated(3)
    fits = [fit(table, FitSettings(seed=seed)) for seed in range(12)]
    errors = [monte_carlo_errors(one) for one in fits]
    values = np.array([[e.value for e in one] for one in errors])
    expected = np.sqrt(np.mean([[e.mcse**2 for e in one] for one in errors], axis=0))
    assert [e.quantity for e in errors[0]].count("p_best") == 3
    assert {e.quantity for e in errors[0]} >= {"worth_mean", "p_i_above_j", "subject_sd", "rank_mean"}
    ratio = values.std(axis=0, ddof=1) / expected
    assert 0.7 < np.median(ratio) < 1.3
    assert ratio.max() < 2.2


def test_a_question_that_is_not_ranked_has_no_errors(simulated):
    fitted = fit(simulated(3))
    unranked = replace(fitted, questions=(replace(fitted.questions[0], ranked=False),))
    assert monte_carlo_errors(unranked) == ()


def test_questions_about_modes_of_their_own_have_the_errors_of_these(answers_of, truth, table_of):
    rows = answers_of(truth, levels=3, participants=6)
    other = rows.assign(question="Q2").replace({"M1": "M7"})
    table = table_of(pd.concat([rows, other]), modes=("M1", "M2", "M3", "M7"))
    first, second = table.questions
    own = (replace(first, modes=("M1", "M2", "M3")), replace(second, modes=("M2", "M3", "M7")))
    fitted = fit(replace(table, questions=own))
    errors = monte_carlo_errors(fitted)
    best = {(e.question, e.mode_i): e for e in errors if e.quantity == "p_best"}
    assert {mode for question, mode in best if question == "Q2"} == {"M2", "M3", "M7"}
    chances = {(q.question.name, m.mode): m.p_best for q in fitted.questions for m in q.modes}
    assert {key: e.value for key, e in best.items()} == chances
    design = observed_design(fitted)
    assert len(design.scenario.worth) == 3
