"""The Bradley-Terry Gibbs sampler with Rao-Kupper ties: pooled, Dirichlet(1) worths, no side effect.

``P(i over j) = w_i / (w_i + theta w_j)`` and
``P(tie) = (theta^2 - 1) w_i w_j / ((w_i + theta w_j) (theta w_i + w_j))`` with skills w ~ Gamma(1), so that
worths ``w / sum(w)`` are Dirichlet(1), and theta flat above 1. A tie counts as a win of either over the
other, times ``theta^2 - 1``; given a Gamma variable for each ordered pair, skills are Gamma again. theta is
drawn exactly, from a finite mixture of Gammas.

References
----------
Caron & Doucet 2012, "Efficient Bayesian inference for generalized Bradley-Terry models", the
sections on the basic model (latent Gamma variables) and on ties.
"""

import zlib
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

from analysis.counts import Counts
from analysis.model import Problem
from analysis.results import Draws, FitSettings

SHAPE = 1.0
"""Shape of the Gamma prior on skills: 1 makes worths Dirichlet(1), flat on the simplex."""


def sample(
    problems: Sequence[Problem], settings: FitSettings, done: Callable[[int], None] = lambda k: None
) -> list[Draws]:
    """Draws of every question, in the order of the problems; chains run side by side in arrays."""
    results = []
    for k, problem in enumerate(problems):
        name = problem.counts.question.name
        rng = np.random.default_rng([settings.seed, zlib.crc32(name.encode())])
        results.append(_chains(problem.counts, settings, rng))
        done(k + 1)
    return results


def _chains(counts: Counts, settings: FitSettings, rng: np.random.Generator) -> Draws:
    wins, ties = counts.wins(), counts.ties()
    n_ties = int(np.triu(ties).sum())
    has_ties = counts.levels > 2
    winner, loser = np.nonzero(wins + ties)
    beaten = (wins + ties)[winner, loser]
    n_modes, n_chains = len(counts.modes), settings.chains
    total = np.bincount(winner, weights=beaten, minlength=n_modes)
    skill = rng.gamma(SHAPE, size=(n_chains, n_modes))
    theta = np.full(n_chains, 1.5 if has_ties else 1.0)
    worth = np.empty((n_chains, settings.draws, n_modes))
    log_theta = np.empty((n_chains, settings.draws))
    for draw in range(-settings.tune, settings.draws):
        latent = rng.gamma(beaten, size=(n_chains, len(beaten)))
        latent /= skill[:, winner] + theta[:, None] * skill[:, loser]
        rate = np.ones((n_chains, n_modes))
        for chain in range(n_chains):
            rate[chain] += np.bincount(winner, weights=latent[chain], minlength=n_modes)
            rate[chain] += theta[chain] * np.bincount(loser, weights=latent[chain], minlength=n_modes)
        skill = rng.gamma(SHAPE + total, size=(n_chains, n_modes)) / rate
        if has_ties:
            theta = _theta(n_ties, (skill[:, loser] * latent).sum(axis=1), rng)
        # The likelihood knows ratios alone, so the sum of the skills may be drawn anew from its prior.
        share = skill / skill.sum(axis=1, keepdims=True)
        skill = share * rng.gamma(SHAPE * n_modes, size=(n_chains, 1))
        if draw >= 0:
            worth[:, draw] = share
            log_theta[:, draw] = np.log(theta)
    ability = np.log(worth)
    ability -= ability.mean(axis=2, keepdims=True)
    parameters = {"log_theta": log_theta} if has_ties else {}
    return Draws(ability, worth, parameters, np.zeros(worth.shape[:2], dtype=bool))


def _theta(n_ties: int, rate: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Draw theta above 1 with density proportional to ``(theta^2 - 1)^n_ties exp(-rate theta)``.

    With ``phi = theta - 1`` that is ``phi^n (phi + 2)^n exp(-rate phi)``; expanding the second power gives
    Gamma(n + k + 1, rate) for k = 0 .. n, with weights
    ``C(n, k) 2^(n-k) Gamma(n + k + 1) / rate^(n + k + 1)``.

    Parameters
    ----------
    rate : ndarray, shape (chain,)
    """
    k = np.arange(n_ties + 1)
    shape = n_ties + k + 1.0
    log_weight = (
        gammaln(n_ties + 1)
        - gammaln(k + 1)
        - gammaln(n_ties - k + 1)
        + (n_ties - k) * np.log(2.0)
        + gammaln(shape)
    )
    log_weight = log_weight - shape * np.log(rate)[:, None]
    # The largest of log-weights with Gumbel noise is a draw in proportion to the weights.
    chosen = (log_weight + rng.gumbel(size=log_weight.shape)).argmax(axis=1)
    return 1.0 + rng.gamma(shape[chosen]) / rate
