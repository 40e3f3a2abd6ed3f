"""The Bradley-Terry Gibbs sampler with Rao-Kupper ties: pooled, Dirichlet(1) worths, no side effect.

``P(i over j) = w_i / (w_i + theta w_j)`` and
``P(tie) = (theta^2 - 1) w_i w_j / ((w_i + theta w_j) (theta w_i + w_j))`` with skills w ~ Gamma(1), so that
worths ``w / sum(w)`` are Dirichlet(1), and theta flat above 1. A tie counts as a win of either over the
other, times ``theta^2 - 1``; given a Gamma variable for each ordered pair, skills are Gamma again. theta is
drawn exactly, by rejection.

References
----------
Caron & Doucet 2012, "Efficient Bayesian inference for generalized Bradley-Terry models", the
sections on the basic model (latent Gamma variables) and on ties.
"""

import zlib
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.sparse import coo_array

from analysis.counts import Counts
from analysis.model import Problem
from analysis.results import Draws, FitSettings

SHAPE = 1.0
"""Shape of the Gamma prior on skills: 1 makes worths Dirichlet(1), flat on the simplex."""


IMPROPER = (
    "Nearly every answer is a tie, and the gibbs engine's flat prior on ties has then no proper posterior: "
    "the engines fast and pymc have one."
)
"""Why a question is not ranked by this engine."""


def is_proper(counts: Counts) -> bool:
    """True if the posterior can be normalised, theta's flat prior being improper.

    As theta grows, let each worth fall as ``theta^-d``, d >= 0. Such worths have a mass of
    ``theta^-sum(d)``, a win of i over j the probability ``theta^-max(0, 1 + d_i - d_j)`` and a tie
    ``theta^-max(0, |d_i - d_j| - 1)``. The integral over theta is finite if the smallest total exponent over
    all d, found by a linear program, is above 1.
    """
    wins, ties = counts.wins(), np.triu(counts.ties())
    if counts.levels == 2:
        return True
    n = len(counts.modes)
    winner, loser = np.nonzero(wins)
    one, other = np.nonzero(ties)
    low, high = np.concatenate([winner, one, other]), np.concatenate([loser, other, one])
    # A row says d_low - d_high - excess <= bound; the two rows of a tie share their excess.
    n_wins, n_ties = len(winner), len(one)
    rows = np.arange(n_wins + 2 * n_ties)
    excess = n + np.concatenate([np.arange(n_wins), n_wins + np.tile(np.arange(n_ties), 2)])
    signs = np.repeat([1.0, -1.0, -1.0], len(rows))
    places = (np.tile(rows, 3), np.concatenate([low, high, excess]))
    limits = coo_array((signs, places), shape=(len(rows), n + n_wins + n_ties)).tocsr()
    bound = np.concatenate([-np.ones(n_wins), np.ones(2 * n_ties)])
    cost = np.concatenate([np.ones(n), wins[winner, loser], ties[one, other]])
    # More than two answers of a kind decide no more than two; large costs would only blur the solver's zero.
    least = linprog(np.minimum(cost, 2.0), A_ub=limits, b_ub=bound) if len(rows) else None
    return least is not None and least.fun > 1.0 + 1e-6


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
    cut = np.empty((n_chains, settings.draws))
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
            cut[:, draw] = np.log(theta)
    ability = np.log(worth)
    ability -= ability.mean(axis=2, keepdims=True)
    # Rao-Kupper's log theta is the first cut-point of the cumulative model (`analysis.model`).
    parameters = {"cut_1": cut} if has_ties else {}
    return Draws(ability, worth, parameters, np.zeros(worth.shape[:2], dtype=bool))


def _theta(n_ties: int, rate: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Draw theta above 1 with density proportional to ``(theta^2 - 1)^n_ties exp(-rate theta)``.

    With ``phi = theta - 1`` that is ``phi^n (phi + 2)^n exp(-rate phi)``. The tangent of
    ``n log(phi + 2)`` at the mode m lies above it everywhere, which makes a Gamma with the same mode an
    envelope to accept from. At least 7 draws of 10 are, however many ties there are.

    Parameters
    ----------
    rate : ndarray, shape (chain,)
    """
    # The positive root of rate m^2 + 2 (rate - n) m - 2 n = 0, in the form that cancels nothing.
    lead, root = n_ties - rate, np.hypot(n_ties, rate)
    mode = np.where(lead > 0, (lead + root) / rate, 2 * n_ties / (root + np.abs(lead)))
    # rate - n / (m + 2), which is n / m, without the difference of nearly equal numbers; rate at n = 0.
    envelope = n_ties / mode if n_ties else rate
    phi = np.empty_like(rate)
    left = np.ones(len(rate), dtype=bool)
    while left.any():
        drawn = rng.gamma(n_ties + 1.0, size=int(left.sum())) / envelope[left]
        step = (drawn - mode[left]) / (mode[left] + 2)
        phi[left] = drawn
        left[left] = np.log(rng.uniform(size=len(drawn))) > n_ties * (np.log1p(step) - step)
    return 1.0 + phi
