"""Grid posteriors against known values, and every sampler against grid posteriors."""

import numpy as np
import pytest

from analysis.counts import count_responses
from analysis.engines import gibbs
from analysis.exact import ExactPosterior, exact_dirichlet_posterior, exact_posterior
from analysis.fit import fit
from analysis.model import Model
from analysis.results import FitSettings, QuestionFit

WINS = [[0, 10, 5], [4, 0, 3], [9, 11, 0]]
MONTE_CARLO_ERRORS = 4.5
"""Distance in standard errors that a right sampler stays within; the seeds are fixed."""


def counts_of(table):
    return count_responses(table, table.questions[0])


def assert_agrees(found: QuestionFit, exact: ExactPosterior) -> None:
    """Means within Monte-Carlo error, spreads within a few percent."""
    assert found.ranked, found.reason
    slack = MONTE_CARLO_ERRORS / np.sqrt(found.ess_min)
    for k, mode in enumerate(found.modes):
        assert mode.ability_mean == pytest.approx(exact.ability_mean[k], abs=slack * exact.ability_sd[k])
        assert mode.worth_mean == pytest.approx(exact.worth_mean[k], abs=slack * exact.worth_sd[k])
        assert mode.ability_sd == pytest.approx(exact.ability_sd[k], rel=slack)
        assert mode.worth_sd == pytest.approx(exact.worth_sd[k], rel=slack)
        spread = np.sqrt(exact.p_best[k] * (1 - exact.p_best[k]))
        assert mode.p_best == pytest.approx(exact.p_best[k], abs=slack * spread + 0.002)
    for quantity in found.parameters:
        sd = exact.parameter_sd[quantity.name]
        assert quantity.mean == pytest.approx(exact.parameter_mean[quantity.name], abs=slack * sd)
        assert quantity.sd == pytest.approx(sd, rel=slack)


def test_the_flat_dirichlet_posterior_is_the_known_one(wins_table):
    exact = exact_dirichlet_posterior(counts_of(wins_table(WINS)), points=1201)
    np.testing.assert_allclose(exact.worth_mean, [0.3284, 0.1492, 0.5223], atol=6e-5)
    np.testing.assert_allclose(exact.worth_sd, [0.0861, 0.0535, 0.0971], atol=6e-5)
    np.testing.assert_allclose(exact.p_best, [0.1375, 0.0010, 0.8615], atol=1e-4)


def test_a_finer_grid_changes_nothing(simulated):
    counts, model = counts_of(simulated(3)), Model(3, "cumulative", False, True, 1.0)
    coarse, fine = exact_posterior(counts, model, 41, 15), exact_posterior(counts, model, 61, 25)
    np.testing.assert_allclose(coarse.ability_mean, fine.ability_mean, atol=1e-5)
    np.testing.assert_allclose(coarse.worth_sd, fine.worth_sd, atol=1e-5)
    np.testing.assert_allclose(coarse.p_best, fine.p_best, atol=2e-3)


@pytest.mark.parametrize("side_effect", [True, False])
@pytest.mark.parametrize(
    ("levels", "link"), [(2, "cumulative"), (3, "cumulative"), (3, "adjacent"), (5, "cumulative")]
)
def test_the_fast_engine_draws_from_the_exact_posterior(simulated, levels, link, side_effect):
    table = simulated(levels, participants=6)
    settings = FitSettings(pooled=True, link=link, side_effect=side_effect, seed=11)
    exact = exact_posterior(
        counts_of(table), Model(levels, link, False, side_effect, 1.0), 31, 9 if levels == 5 else 15
    )
    assert_agrees(fit(table, settings).questions[0], exact)


@pytest.mark.parametrize("prior_sd", [0.2, 5.0])
def test_the_prior_sd_is_the_abilities_alone(simulated, prior_sd):
    table = simulated(3, participants=6)
    exact = exact_posterior(counts_of(table), Model(3, "cumulative", False, True, prior_sd), 41, 15)
    assert_agrees(fit(table, FitSettings(pooled=True, prior_sd=prior_sd)).questions[0], exact)


def test_gibbs_draws_from_the_exact_posterior_without_ties(wins_table):
    table = wins_table(WINS)
    exact = exact_dirichlet_posterior(counts_of(table), points=601)
    assert_agrees(fit(table, FitSettings(engine="gibbs", draws=4000)).questions[0], exact)


def test_gibbs_draws_from_the_exact_posterior_with_ties(wins_table):
    table = wins_table(WINS, {(0, 1): 6, (1, 2): 2, (0, 2): 4})
    exact = exact_dirichlet_posterior(counts_of(table))
    assert_agrees(fit(table, FitSettings(engine="gibbs", draws=4000)).questions[0], exact)


def test_gibbs_collapses_five_levels_and_says_so(simulated):
    table = simulated(5)
    found = fit(table, FitSettings(engine="gibbs", draws=4000))
    assert any("was taken as A>B or B>A" in warning for warning in found.questions[0].warnings)
    assert any("pooled" in warning for warning in found.warnings)
    assert_agrees(found.questions[0], exact_dirichlet_posterior(counts_of(table).collapsed()))


@pytest.mark.parametrize("n_ties", [0, 1, 12, 10**10])
@pytest.mark.parametrize("rate_per_tie", [0.3, 1.0, 40.0])
def test_gibbs_draws_its_tie_parameter_from_its_full_conditional(n_ties, rate_per_tie):
    rate = rate_per_tie * max(n_ties, 1)
    theta = gibbs._theta(n_ties, np.full(20_000, rate), np.random.default_rng(1))
    middle, sd = theta.mean(), theta.std()
    phi = np.linspace(max(middle - 12 * sd, 1.0 + 1e-12), middle + 20 * sd, 200_001) - 1
    log_p = n_ties * (np.log(phi) + np.log(phi + 2)) - rate * phi
    weight = np.exp(log_p - log_p.max())
    weight /= weight.sum()
    mean = weight @ (phi + 1)
    spread = np.sqrt(weight @ (phi + 1 - mean) ** 2)
    assert middle == pytest.approx(mean, abs=5 * spread / np.sqrt(20_000))
    assert sd == pytest.approx(spread, rel=0.05)
