"""The default engine: a compiled density per question, sampled by NUTS."""

import zlib
from collections.abc import Callable, Sequence

import numpy as np

from analysis.engines import nuts
from analysis.engines.coordinates import quantities_of
from analysis.engines.density import packed
from analysis.engines.form import form_of
from analysis.model import Problem
from analysis.results import Draws, FitSettings
from analysis.softmax import worth_of


def sample(
    problems: Sequence[Problem], settings: FitSettings, done: Callable[[int], None] = lambda k: None
) -> list[Draws]:
    """Draws of every question, in the order of the problems; ``done(k)`` follows each.

    A question's stream of random numbers depends on the seed and on its own name alone, so that other
    questions cannot change its draws.
    """
    results = []
    for k, problem in enumerate(problems):
        chains = nuts.sample(
            packed(problem, form_of(problem) if problem.model.hierarchical else None),
            problem.n_dim,
            problem.n_global,
            seed=question_seed(settings.seed, problem.counts.question.name),
            draws=settings.draws,
            tune=settings.tune,
            chains=settings.chains,
            target_accept=settings.acceptance(problem.n_dim),
        )
        results.append(_named(problem, chains))
        done(k + 1)
    return results


def question_seed(seed: int, question: str) -> int:
    """A seed of its own for each question."""
    return int(np.random.SeedSequence([seed, zlib.crc32(question.encode())]).generate_state(1, np.uint64)[0])


def _named(problem: Problem, chains: nuts.Chains) -> Draws:
    """The sampler's coordinates as the model's quantities."""
    found = quantities_of(chains.position, problem.model, problem.counts.modes)
    return Draws(found.ability, worth_of(found.ability), found.parameters, chains.diverging)
