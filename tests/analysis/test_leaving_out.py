"""Models compared by the answers of people they have not seen, on answers whose truth is planted."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp

from analysis import marginal, persons
from analysis.answer_shares import thinned
from analysis.calibration.world import Design, draw_answers
from analysis.calibration.world import Truth as LinkTruth
from analysis.counts import count_responses
from analysis.fit import fit
from analysis.leaving_out import _pointwise, left_out, model_scores
from analysis.model import Model, model_of
from analysis.pareto import smoothed
from analysis.persons import prior_nodes
from analysis.results import FitSettings

SETTINGS = FitSettings(draws=1000, tune=500, chains=2)


@pytest.fixture(scope="module")
def scored(table_of, answers_of, truth):
    """Scores by model of ten people's answers with another truth than usual."""

    def score(**planted):
        rows = answers_of(replace(truth, **planted), levels=2, participants=10, repetitions=4, seed=3)
        table = table_of(rows, levels=2)
        return {s.model: s for s in model_scores(table, fit(table, SETTINGS))}

    return score


def test_weighted_draws_score_a_person_as_a_fit_without_that_person_does(simulated):
    table = simulated(3, participants=8)
    fitted = fit(table, FitSettings())
    counts = count_responses(table, table.questions[0])
    model = model_of(fitted.settings, 3, has_participants=True)
    found = _pointwise(counts, fitted.settings, fitted.questions[0].draws, fitted.modes)
    brute = [left_out(counts, person, model, fitted.settings) for person in range(8)]
    assert found.refitted < 3
    assert found.values == pytest.approx(brute, abs=0.3)
    assert np.abs(found.values - brute).mean() < 0.1


@pytest.mark.parametrize("pooled", [False, True])
def test_own_deviations_are_integrated_out_as_a_sum_over_the_prior_does(simulated, pooled):
    table = simulated(5, participants=3)
    fitted = fit(table, replace(SETTINGS, pooled=pooled))
    counts, draws = count_responses(table, table.questions[0]), thinned(fitted.questions[0].draws, 20)
    model = model_of(fitted.settings, 5, has_participants=True)
    nodes = np.zeros((1, 3)) if pooled else prior_nodes(3, 4096)
    plain = persons.log_likelihoods(counts, draws.ability, draws.parameters, nodes)
    expected = logsumexp(plain, axis=2) - np.log(len(nodes))
    assert marginal.log_likelihoods(counts, model, draws) == pytest.approx(expected, abs=0.1)


def test_a_planted_side_effect_is_missed_by_a_model_without_one(scored):
    assert scored(side_effect=1.5)["without a side effect"].reading == "predicts worse"


def test_without_a_side_effect_and_differences_the_simpler_models_do_as_well(scored):
    scores = scored(side_effect=0.0, subject_sd=0.0)
    assert scores["without a side effect"].reading == "not told apart"
    assert scores["people alike"].reading == "not told apart"
    assert scores["as reported"].difference == 0


def test_planted_differences_between_people_are_missed_by_a_pooled_model(scored):
    score = scored(subject_sd=2.5)["people alike"]
    assert score.reading == "predicts worse"
    assert score.participants == 10


@pytest.mark.parametrize("link", ["cumulative", "adjacent"])
def test_the_link_that_the_answers_come_from_predicts_them_better(link):
    parameters = {"cut_1": 1.0} if link == "cumulative" else {"log_nu": 0.0}
    model = Model(3, link, hierarchical=False, side_effect=False, prior_sd=1.0)
    planted = LinkTruth(np.array([2.0, 0.0, -2.0]), parameters)
    # The links are so much alike that it takes this many answers to tell them apart.
    table = draw_answers(model, planted, Design(8, 600), np.random.default_rng(1))
    settings = replace(SETTINGS, pooled=True, side_effect=False, prior_sd=3.0, link=link)
    scores = {s.model: s for s in model_scores(table, fit(table, settings))}
    other = "adjacent link" if link == "cumulative" else "cumulative link"
    assert scores[other].reading == "predicts worse"


def test_links_are_compared_on_three_levels_alone(simulated):
    table = simulated(5, participants=4)
    assert {s.model for s in model_scores(table, fit(table, SETTINGS))} == {
        "as reported",
        "without a side effect",
        "people alike",
    }


def test_two_people_are_too_few_to_leave_any_out(simulated):
    table = simulated(3, participants=2)
    assert model_scores(table, fit(table, SETTINGS)) == ()


@pytest.mark.parametrize("shape", [0.2, 0.5, 1.0])
def test_the_tail_of_the_weights_has_the_shape_that_was_planted(shape):
    chance = np.random.default_rng(5).random(20_000)
    weights = smoothed(-shape * np.log(chance))
    assert weights.k == pytest.approx(shape, abs=0.15)
    assert weights.trusted == (shape < 0.7)
    assert np.exp(weights.log).sum() == pytest.approx(1.0)


def test_smoothed_weights_give_the_mean_of_the_distribution_they_aim_at():
    x = np.random.default_rng(7).normal(size=4000)
    weights = smoothed(0.5 * x**2 - 0.5 * (x - 0.5) ** 2)
    assert np.exp(weights.log) @ x == pytest.approx(0.5, abs=0.06)
    assert weights.trusted
    assert weights.effective < 4000
