"""Worth on a metric: a planted slope is found, and too few modes are refused."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import multivariate_normal

from analysis.counts import count_responses
from analysis.covariates import (
    RESIDUAL_SD_SCALE,
    SLOPE_SD,
    _effect,
    covariate_claims,
    covariate_effects,
    covariate_refusal,
    slopes_of,
)
from analysis.fit import fit
from analysis.report.physics import effects_section
from analysis.results import Draws, FitSettings
from analysis.zero_sum import zero_sum_basis
from data.responses import MetricTable

SETTINGS = FitSettings(draws=1000, tune=500, chains=2)
FORCE = np.array([10.0, 12.0, 13.0, 15.0, 18.0, 22.0])
JERK = np.array([3.0, 1.0, 2.0, 3.0, 1.0, 2.0])


def laps(n_modes, people=4):
    rows = [
        (f"p{s}", f"p{s}.{k}", f"M{k + 1}", FORCE[k] + s, JERK[k])
        for s in range(people)
        for k in range(n_modes)
    ]
    columns = ["participant", "comparison", "mode", "force_mean_edge_n", "jerk_rms_m_s3"]
    return MetricTable(pd.DataFrame(rows, columns=columns))


@pytest.fixture(scope="module")
def planted_table(table_of, answers_of, truth):
    """Six modes whose abilities fall by 1.2 logits for each sd of force."""
    x = (FORCE - FORCE.mean()) / FORCE.std()
    rows = answers_of(replace(truth, ability=tuple(-1.2 * x)), levels=3, participants=10, repetitions=1)
    return table_of(rows, modes=[f"M{k + 1}" for k in range(6)], levels=3)


@pytest.fixture(scope="module")
def planted(planted_table):
    return fit(planted_table, SETTINGS)


def test_a_planted_slope_of_ability_on_force_is_found(planted):
    force, jerk = covariate_effects(planted, laps(6))
    assert (force.metric, jerk.metric) == ("force_mean_edge_n", "jerk_rms_m_s3")
    assert force.slope_hdi_low < -1.2 < force.slope_hdi_high < 0
    assert force.p_positive < 0.01
    assert force.metric_sd == pytest.approx(FORCE.std())
    assert jerk.slope_hdi_low < 0 < jerk.slope_hdi_high
    assert jerk.residual_sd > force.residual_sd


def test_slope_and_residual_are_those_of_the_model_integrated_by_brute_force():
    rng = np.random.default_rng(2)
    basis, x = zero_sum_basis(4), np.array([-1.2, -0.4, 0.2, 1.4])
    cov, mean = np.diag([0.05, 0.1, 0.2]), np.array([0.5, -0.3, 0.8])
    own = mean + rng.normal(size=(2, 4000, 3)) * np.sqrt(np.diag(cov))
    draws = Draws(own @ basis.T, own @ basis.T, {}, np.zeros((2, 4000), bool))
    found = _effect("Q1", "force", 1.0, x, draws, prior_sd=1.0)

    alone = np.linalg.inv(np.linalg.inv(cov) - np.eye(3))
    estimate = alone @ np.linalg.solve(cov, mean)
    slopes, spreads = np.linspace(-4, 4, 81), np.linspace(0.025, 2.475, 50)
    logs = np.array(
        [
            [
                multivariate_normal.logpdf(estimate, b * basis.T @ x, alone + r**2 * np.eye(3))
                - 0.5 * (b / SLOPE_SD) ** 2
                - 0.5 * (r / RESIDUAL_SD_SCALE) ** 2
                for r in spreads
            ]
            for b in slopes
        ]
    )
    weight = np.exp(logs - logs.max())
    weight /= weight.sum()
    assert found.slope_mean == pytest.approx(weight.sum(axis=1) @ slopes, abs=0.02)
    assert found.slope_sd == pytest.approx(
        np.sqrt(weight.sum(axis=1) @ slopes**2 - (weight.sum(axis=1) @ slopes) ** 2), abs=0.02
    )
    assert found.residual_sd == pytest.approx(weight.sum(axis=0) @ spreads, abs=0.02)


def test_a_slope_that_is_clear_by_itself_is_not_among_many():
    rng = np.random.default_rng(5)
    basis, x = zero_sum_basis(8), np.linspace(-1.5, 1.5, 8)
    mean = basis.T @ (0.55 * x + 0.4 * np.resize([1.0, -1.0, -1.0, 1.0], 8))
    ability = (mean + 0.3 * rng.normal(size=(2, 2000, 7))) @ basis.T
    draws = Draws(ability, ability, {}, np.zeros((2, 2000), bool))
    others = {f"m{k}": (rng.permutation(x), 1.0) for k in range(19)}
    (alone,) = slopes_of({"Q1": draws}, {"Q1": {"force": (x, 1.0)}}, 1.0)
    among = slopes_of({"Q1": draws}, {"Q1": {"force": (x, 1.0)} | others}, 1.0)
    assert alone.slope_hdi_low > 0
    assert alone.is_clear
    assert among[0].slope_mean == alone.slope_mean
    assert not any(e.is_clear for e in among)
    tails = sorted(2 * min(e.p_positive, 1 - e.p_positive) for e in among)
    assert min(e.p_in_list for e in among) == pytest.approx(20 * tails[0])


def test_the_section_says_association_units_and_how_few_points_there_are(planted):
    effects = covariate_effects(planted, laps(6))
    section = effects_section(effects, "", planted, "")
    said = " ".join(section.words)
    assert "association" in said
    assert "6 points" in said
    assert "weakly identified" in said
    assert "less force at the edge with a higher place on Q1" in said
    assert section.table.rows[0][2] == "4 N"
    (claim,) = covariate_claims(effects)
    assert claim.text == "Modes with less force at the edge rank higher on Q1."
    assert claim.probability == pytest.approx(1 - effects[0].p_positive)
    (drawing,) = section.drawings
    assert f"Q1, force at the edge: {effects[0].slope_mean:+.2f}" in drawing.alt
    assert "force at the edge" in re.findall(r">([^<>]+)</text>", drawing.svg)


def test_three_modes_are_refused_in_a_line_and_without_numbers(planted, simulated):
    three = fit(simulated(3, participants=4), SETTINGS)
    refused = covariate_refusal(three, laps(3))
    assert refused.startswith("With 3 modes a line goes through their worths whatever they are")
    assert covariate_effects(three, laps(3)) == ()
    assert effects_section((), refused, three, "").words == (refused,)


def test_without_a_metric_of_every_mode_there_is_no_slope(planted):
    assert covariate_refusal(planted, None).startswith("No metrics of laps")
    refused = covariate_refusal(planted, laps(5))
    assert refused.startswith("No metric is known of every mode")
    assert refused.endswith("nothing to set worths on.")
    assert covariate_refusal(replace(planted, settings=replace(SETTINGS, engine="gibbs")), laps(6)) != ""


def test_the_two_stages_say_what_one_model_of_answers_and_metric_says(planted_table, planted):
    import pymc as pm
    from pymc.math import log, sigmoid

    x = (FORCE - FORCE.mean()) / FORCE.std()
    counts = count_responses(planted_table, planted_table.questions[0])
    who, a, b = counts.participant, counts.mode_a, counts.mode_b
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pm.Model():
            slope, left = pm.Normal("slope", 0, SLOPE_SD), pm.HalfNormal("left", RESIDUAL_SD_SCALE)
            ability = slope * x + left * pm.ZeroSumNormal("own", 1, shape=6)
            person = pm.HalfNormal("sd", 1) * pm.ZeroSumNormal("z", 1, shape=(10, 6))
            lead = ability[a] - ability[b] + person[who, a] - person[who, b] + pm.Normal("side", 0, 0.5)
            cut = pm.HalfNormal("cut", 1)
            a_won, b_won = sigmoid(lead - cut), sigmoid(-lead - cut)
            won, tied, lost = counts.responses.T
            pm.Potential(
                "answers", (won * log(a_won) + tied * log(1 - a_won - b_won) + lost * log(b_won)).sum()
            )
            drawn = pm.sample(1000, tune=1000, chains=2, random_seed=1, progressbar=False).posterior
    found = covariate_effects(planted, laps(6))[0]
    assert found.slope_mean == pytest.approx(float(drawn["slope"].mean()), abs=0.1)
    assert found.slope_sd == pytest.approx(float(drawn["slope"].std()), rel=0.25)
    assert found.residual_sd == pytest.approx(float(drawn["left"].mean()), abs=0.1)
