"""Convergence diagnostics against ArviZ, and against what they must find."""

import warnings

import numpy as np
import pytest

from analysis.diagnostics import convergence, ess_of_mean, hdi

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import arviz as az


def autoregressive(rho: float, shape: tuple[int, int, int], seed: int = 0) -> np.ndarray:
    noise = np.random.default_rng(seed).normal(size=shape)
    draws = noise.copy()
    for t in range(1, shape[2]):
        draws[..., t] = rho * draws[..., t - 1] + noise[..., t]
    return draws


@pytest.mark.parametrize("rho", [-0.6, 0.0, 0.5, 0.95])
@pytest.mark.parametrize("n_draws", [5, 10, 101, 1000])
def test_rhat_and_ess_are_arvizs(rho, n_draws):
    draws = autoregressive(rho, (4, 4, n_draws))
    draws[1] = np.round(draws[1], 1)
    draws[2] += 0.3 * np.arange(4)[:, None]
    draws[3] = np.exp(draws[3])
    found = convergence(draws)
    for q, values in enumerate(draws):
        np.testing.assert_allclose(found.rhat[q], az.rhat(values), rtol=1e-10)
        np.testing.assert_allclose(found.ess_bulk[q], az.ess(values, method="bulk"), rtol=1e-10)
        # Between two equal draws ArviZ's quantile can fall an ulp below both; ours is the draw itself.
        if q != 1:
            tail = az.ess(values, method="tail", prob=(0.05, 0.95))
            np.testing.assert_allclose(found.ess_tail[q], tail, rtol=1e-10)
        np.testing.assert_allclose(ess_of_mean(draws)[q], az.ess(values, method="mean"), rtol=1e-10)


@pytest.mark.parametrize("probability", [0.5, 0.94])
def test_the_interval_is_arvizs(probability):
    draws = np.exp(np.random.default_rng(1).normal(size=(1000, 3)))
    expected = np.stack([az.hdi(column, hdi_prob=probability) for column in draws.T], axis=1)
    np.testing.assert_array_equal(hdi(draws, probability), expected)


def test_one_chain_elsewhere_does_not_pass():
    draws = autoregressive(0.0, (1, 4, 1000))
    assert convergence(draws).passed
    draws[0, 3] += 1.0
    assert not convergence(draws).passed


def test_a_drifting_chain_does_not_pass():
    draws = autoregressive(0.0, (1, 4, 1000)) + np.linspace(0, 2, 1000)
    assert convergence(draws).rhat_max > 1.05


def test_a_chain_of_another_width_does_not_pass():
    draws = autoregressive(0.0, (1, 4, 1000))
    draws[0, 3] *= 3.0
    assert not convergence(draws).passed


def test_a_constant_has_all_the_draws_and_chains_constant_at_different_values_never_pass():
    draws = np.full((2, 4, 1000), 3.0)
    draws[1, 2] = 4.0
    found = convergence(draws)
    assert found.rhat[0] == 1.0
    assert found.ess_bulk[0] == found.ess_tail[0] == 4000.0
    assert found.rhat[1] == np.inf
    assert not found.passed


def test_many_quantities_have_the_diagnostics_of_each():
    draws = autoregressive(0.5, (70, 4, 50))
    draws[::3] = np.round(draws[::3])
    together = convergence(draws)
    for q in (0, 1, 31, 32, 69):
        alone = convergence(draws[q : q + 1])
        assert (together.rhat[q], together.ess_bulk[q]) == (alone.rhat[0], alone.ess_bulk[0])
