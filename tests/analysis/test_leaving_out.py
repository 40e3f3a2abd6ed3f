"""Models compared by the answers of people they have not seen, on answers whose truth is planted."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp

from analysis.answer_shares import ThinnedDraws, answer_probabilities, thinned
from analysis.calibration.world import Design, draw_answers
from analysis.calibration.world import Truth as LinkTruth
from analysis.counts import Counts, count_responses
from analysis.engines import fast
from analysis.fit import fit
from analysis.leaving_out import _pointwise, left_out, model_scores
from analysis.marginal import log_likelihoods
from analysis.model import Model, model_of
from analysis.pareto import smoothed
from analysis.refits import Refits
from analysis.report.refitted import refit_sections
from analysis.results import FitSettings
from analysis.zero_sum import zero_sum_basis

SETTINGS = FitSettings(draws=1000, tune=500, chains=2)


@pytest.fixture(scope="module")
def scored(table_of, answers_of, truth):
    """Scores by model of ten people's answers with another truth than usual."""

    def score(**planted):
        rows = answers_of(replace(truth, **planted), levels=2, participants=10, repetitions=4, seed=3)
        table = table_of(rows, levels=2)
        return {s.model: s for s in model_scores(table, fit(table, SETTINGS))}

    return score


def on_a_grid(counts: Counts, draws: ThinnedDraws) -> np.ndarray:
    """Log-likelihood of each participant's answers about three modes by the plain formulas, deviations
    summed over a grid of their prior: (participant, draw)."""
    at, weight = np.polynomial.hermite_e.hermegauss(60)
    across, up = np.meshgrid(at, at)
    nodes = np.stack([across.ravel(), up.ravel()], axis=1) @ zero_sum_basis(3).T
    log_weights = np.log(np.outer(weight, weight) / weight.sum() ** 2).ravel()
    spread = draws.parameters.get("subject_sd", np.zeros(len(draws.ability)))
    own = draws.ability[:, None] + spread[:, None, None] * nodes
    columns = {name: values[:, None] for name, values in draws.parameters.items()}
    total = np.zeros((len(counts.participants), *own.shape[:2]))
    for s, a, b, said in zip(counts.participant, counts.mode_a, counts.mode_b, counts.responses, strict=True):
        eta = own[..., a] - own[..., b] + columns["side_effect"]
        total[s] += np.log(answer_probabilities(eta, columns, counts.levels)) @ said
    return logsumexp(total + log_weights, axis=2)


def test_weighted_draws_score_a_person_as_a_fit_without_that_person_does(simulated):
    table = simulated(3, participants=8)
    fitted = fit(table, FitSettings())
    found = _pointwise(table, fitted.settings, fitted.questions[0])
    brute = [left_out(table, person, fitted.settings) for person in range(8)]
    assert found.refitted < 3
    assert found.values == pytest.approx(brute, abs=0.3)
    assert np.abs(found.values - brute).mean() < 0.1


@pytest.mark.parametrize("pooled", [False, True])
def test_own_deviations_are_integrated_out_as_a_sum_over_a_grid_does(simulated, pooled):
    table = simulated(5, participants=3)
    fitted = fit(table, replace(SETTINGS, pooled=pooled))
    counts, draws = count_responses(table, table.questions[0]), thinned(fitted.questions[0].draws, 20)
    model = model_of(fitted.settings, 5, has_participants=True)
    found = log_likelihoods(counts, model, draws) - on_a_grid(counts, draws)
    assert np.abs(found).max() < 0.06
    assert np.sqrt((found**2).mean()) < 0.02


def test_many_answers_of_many_modes_are_integrated_out_by_few_points(answers_of, table_of, truth):
    planted = replace(truth, ability=tuple(np.linspace(-1, 1, 8)), subject_sd=1.5)
    table = table_of(answers_of(planted, levels=5, participants=4, repetitions=3), levels=5)
    fitted = fit(table, SETTINGS)
    counts, draws = count_responses(table, table.questions[0]), thinned(fitted.questions[0].draws, 20)
    model = model_of(fitted.settings, 5, has_participants=True)
    few, many = (log_likelihoods(counts, model, draws, n) for n in (32, 4096))
    assert np.sqrt(((few - many) ** 2).mean()) < 0.1


@pytest.fixture
def one_odd_person(answers_of, table_of, truth):
    """Seven people alike and one who always says the opposite, so that a fit is asked for without them."""
    rows = answers_of(replace(truth, ability=(2.0, -2.0, 0.0), subject_sd=0.1), levels=2, participants=8)
    turned = rows["response"].map({"A>B": "B>A", "B>A": "A>B"})
    rows["response"] = rows["response"].where(rows["participant"] != "p000", turned)
    return table_of(rows, levels=2)


def test_a_fit_without_a_person_that_does_not_converge_gives_no_score_and_is_told(
    one_odd_person, monkeypatch
):
    table, sample = one_odd_person, fast.sample
    fitted = fit(table, SETTINGS)
    people = len(count_responses(table, table.questions[0]).participants)

    def stuck_without_a_person(problems, settings, done=lambda k: None):
        draws = sample(problems, settings, done)
        for problem, d in zip(problems, draws, strict=True):
            if 1 < len(problem.counts.participants) < people:
                d.ability[0] += np.array([1.0, -1.0, 0.0])
        return draws

    monkeypatch.setattr(fast, "sample", stuck_without_a_person)
    scores = {s.model: s for s in model_scores(table, fitted)}
    assert scores["as reported"].refitted
    assert np.isnan(scores["as reported"].elpd)
    assert "no ranking from the fit without a participant" in scores["as reported"].missing
    assert scores["people alike"].reading == "not scored"
    (section,) = [s for s in refit_sections(Refits(tuple(scores.values()), (), None, (), "", None)) if s]
    said = " ".join(section.words)
    assert "No score: Q1, “as reported”: no ranking from the fit without a participant" in said
    assert "told apart" not in said
    assert "nan" not in " ".join(cell for row in section.table.rows for cell in row)


def test_a_model_that_does_not_converge_has_no_score_and_is_told(simulated, monkeypatch):
    table, sample = simulated(2, participants=4), fast.sample
    fitted = fit(table, SETTINGS)

    def stuck_when_pooled(problems, settings, done=lambda k: None):
        draws = sample(problems, settings, done)
        for d in draws:
            d.ability[0] += 5.0 * np.array([1.0, -1.0, 0.0]) * ("subject_sd" not in d.parameters)
        return draws

    monkeypatch.setattr(fast, "sample", stuck_when_pooled)
    scores = {s.model: s for s in model_scores(table, fitted)}
    assert (scores["people alike"].reading, scores["people alike"].missing) == (
        "not scored",
        "the model did not converge",
    )
    assert scores["without a side effect"].reading == "not told apart"


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
        "with careless answers",
        "with own side effects",
        "with own widths of the scale",
        "with position and learning",
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
