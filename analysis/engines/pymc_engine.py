"""The model of record: one joint PyMC model of the whole questionnaire, its questions independent.

It states likelihood and priors a second time, with PyMC's own distributions, so that it and the compiled
density check each other; extensions (covariates, other hierarchies) start here. PyMC and ArviZ cost seconds
to import and are imported where they are used.
"""

import logging
import shutil
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from analysis.counts import Counts
from analysis.model import (
    CUT_GAP_SCALE,
    LAPSE_BETA,
    LEARNING,
    LEARNING_SD,
    LOG_NU_SD,
    SCALE_SD_SCALE,
    SIDE_DRIFT_SD,
    SIDE_EFFECT_SD,
    SIDE_SD_SCALE,
    SUBJECT_SD_SCALE,
    Model,
    Problem,
)
from analysis.results import Draws, FitSettings
from analysis.softmax import worth_of

if TYPE_CHECKING:
    import arviz as az
    import pymc as pm
    from pytensor.tensor.variable import TensorVariable


MANY_CELLS = 2000
"""From so many cells on, LLVM's optimiser is worth its half minute; below, it costs more than it gains."""


def compiler_note() -> tuple[str, ...]:
    """A sentence for the report if PyTensor has no C++ compiler to use, else nothing.

    Sampling doesn't need one: the joint model is compiled with numba. Measured on a small study, a
    whole report took 1.05 times as long without a compiler as with one.
    """
    if shutil.which("g++") or shutil.which("clang++"):
        return ()
    return (
        "No C++ compiler (g++ or clang++) was found: sampling keeps its speed, but what PyTensor evaluates "
        "by itself, such as pointwise log-likelihoods, is slow.",
    )


@dataclass(frozen=True)
class Block:
    """Questions on one scale and about as many modes, which PyMC holds as one set of variables with an axis
    for the question.

    Attributes
    ----------
    prefix : str
        What the names of its variables begin with.
    members : tuple of int
        Places of its questions among the problems, along the question axis.
    """

    prefix: str
    model: Model
    members: tuple[int, ...]


@dataclass(frozen=True)
class JointModel:
    """A PyMC model of several questions, and where each question stands in it."""

    model: "pm.Model"
    blocks: tuple[Block, ...]
    n_cells: int


def joint_model(problems: Sequence[Problem]) -> JointModel:
    """The PyMC model of these problems."""
    kinds = [(problem.model, len(problem.counts.modes)) for problem in problems]
    is_mixed = len({n for _, n in kinds}) > 1
    blocks = tuple(
        Block(
            f"{model.link}{model.levels}_{'' if model.hierarchical else 'pooled_'}{f'{n}_modes_' * is_mixed}",
            model,
            tuple(k for k, kind in enumerate(kinds) if kind == (model, n)),
        )
        for model, n in dict.fromkeys(kinds)
    )
    with _quiet():
        import pymc as pm

        with pm.Model() as joint:
            for block in blocks:
                _add_block(block, [problems[k].counts for k in block.members])
    return JointModel(joint, blocks, sum(len(problem.counts.mode_a) for problem in problems))


def _add_block(block: Block, questions: list[Counts]) -> None:
    """The variables of a block, in the context of a model."""
    import pymc as pm
    import pytensor.tensor as pt

    prefix, model = block.prefix, block.model
    n_questions, n_modes = len(questions), len(questions[0].modes)
    question = np.repeat(np.arange(n_questions), [len(counts.mode_a) for counts in questions])
    a = np.concatenate([counts.mode_a for counts in questions])
    b = np.concatenate([counts.mode_b for counts in questions])
    # A participant answers each question out of an own deviation: nothing is shared between questions.
    people = np.cumsum([0, *(len(counts.participants) for counts in questions)])
    person = np.concatenate([c.participant + first for c, first in zip(questions, people, strict=False)])
    n_people = int(people[-1])
    ability = pm.ZeroSumNormal(prefix + "ability", sigma=model.prior_sd, shape=(n_questions, n_modes))
    eta = ability[question, a] - ability[question, b]
    if model.side_effect:
        eta = eta + pm.Normal(prefix + "side_effect", 0, SIDE_EFFECT_SD, shape=n_questions)[question]
    if model.position:
        t, x_a, x_b = np.concatenate([counts.order for counts in questions if counts.order is not None]).T
        drift = pm.Normal(prefix + "side_drift", 0, SIDE_DRIFT_SD, shape=n_questions)
        learning = pm.ZeroSumNormal(prefix + "learning", sigma=LEARNING_SD, shape=(n_questions, n_modes))
        eta = eta + drift[question] * t + learning[question, a] * x_a - learning[question, b] * x_b
    if model.hierarchical:
        subject_sd = pm.HalfNormal(prefix + "subject_sd", SUBJECT_SD_SCALE, shape=n_questions)
        z = pm.ZeroSumNormal(prefix + "z", sigma=1, shape=(n_people, n_modes))
        eta = eta + subject_sd[question] * (z[person, a] - z[person, b])
    if model.person_side:
        side_sd = pm.HalfNormal(prefix + "side_sd", SIDE_SD_SCALE, shape=n_questions)
        eta = eta + side_sd[question] * pm.Normal(prefix + "s", 0, 1, shape=n_people)[person]
    width = None
    if model.person_scale:
        scale_sd = pm.HalfNormal(prefix + "scale_sd", SCALE_SD_SCALE, shape=n_questions)
        width = scale_sd[question] * pm.Normal(prefix + "w", 0, 1, shape=n_people)[person]
    if model.link == "adjacent":
        log_nu = pm.Normal(prefix + "log_nu", 0, LOG_NU_SD, shape=n_questions)[question]
        log_nu = log_nu if width is None else log_nu + width
        odds = pt.stack([eta / 2, log_nu, -eta / 2], axis=1)
        log_p = odds - pt.logsumexp(odds, axis=1, keepdims=True)
    else:
        cuts = pt.zeros((n_questions, 0))
        if model.n_gaps:
            gaps = pm.HalfNormal(prefix + "gaps", CUT_GAP_SCALE, shape=(n_questions, model.n_gaps))
            cuts = pm.Deterministic(prefix + "cuts", pt.cumsum(gaps, axis=1))
        middle = pt.zeros((n_questions, 1 - model.levels % 2))
        theta = pt.concatenate([cuts[:, ::-1], middle, -cuts], axis=1)
        own = theta[question] if width is None else theta[question] * pt.exp(width)[:, None]
        log_p = _cumulative_log_p(eta, own)
    if model.lapse:
        lapse = pm.Beta(prefix + "lapse", 1, LAPSE_BETA, shape=n_questions)[question][:, None]
        log_p = pt.logaddexp(pt.log1p(-lapse) + log_p, pt.log(lapse / model.levels))
    # The multinomial coefficients are constants of the data and stay out, as in the compiled density.
    pm.CustomDist(
        prefix + "responses",
        log_p,
        logp=lambda value, log_p: (value * log_p).sum(axis=1),
        signature="(k)->(k)",
        observed=np.concatenate([counts.responses for counts in questions]),
    )


def _cumulative_log_p(eta: "TensorVariable", theta: "TensorVariable") -> "TensorVariable":
    """Log-probabilities from A much to B much, shape (cell, level); theta falls along its last axis.

    An inner answer's is ``log(logistic(u) logistic(-l) (1 - e^(l - u)))`` between cut-points l and u, which
    loses no digits however far ``eta`` lies from them.
    """
    import pytensor.tensor as pt

    above, below = -pt.softplus(theta - eta[:, None]), -pt.softplus(eta[:, None] - theta)
    inner = below[:, :-1] + above[:, 1:] + pt.log1mexp(theta[:, 1:] - theta[:, :-1])
    return pt.concatenate([above[:, :1], inner, below[:, -1:]], axis=1)


def sample(
    problems: Sequence[Problem], settings: FitSettings, done: Callable[[int], None] = lambda k: None
) -> list[Draws]:
    """Draws of every question from the joint model, in the order of the problems."""
    joint = joint_model(problems)
    trace = _sampled(joint, settings)
    diverging = trace["sample_stats"]["diverging"].to_numpy()
    results: dict[int, Draws] = {}
    for block in joint.blocks:
        drawn = {
            str(name).removeprefix(block.prefix): values.to_numpy()
            for name, values in trace["posterior"].items()
        }
        for row, k in enumerate(block.members):
            ability = drawn["ability"][:, :, row]
            modes = problems[k].counts.modes
            parameters = {
                name: _drawn(drawn, name, modes)[:, :, row] for name in block.model.parameter_names(modes)
            }
            results[k] = Draws(ability, worth_of(ability), parameters, diverging)
            done(len(results))
    return [results[k] for k in range(len(problems))]


def _drawn(drawn: dict[str, "np.ndarray"], name: str, modes: Sequence[str]) -> "np.ndarray":
    """Draws of a parameter of a block, shape (chain, draw, question)."""
    if name.startswith("cut_"):
        return drawn["cuts"][..., int(name.removeprefix("cut_")) - 1]
    if name.startswith(LEARNING):
        return drawn["learning"][..., modes.index(name.removeprefix(LEARNING))]
    return drawn[name]


def _sampled(joint: JointModel, settings: FitSettings) -> "az.InferenceData":
    with _quiet():
        import nutpie

        with _optimised(joint.n_cells >= MANY_CELLS):
            compiled = nutpie.compile_pymc_model(joint.model)
        return nutpie.sample(
            compiled,
            draws=settings.draws,
            tune=settings.tune,
            chains=settings.chains,
            seed=settings.seed,
            target_accept=settings.target_accept,
            save_warmup=False,
            progress_bar=False,
        )


def pointwise_log_likelihood(problems: Sequence[Problem], settings: FitSettings) -> "az.InferenceData":
    """Draws with the log-likelihood of every cell (participant and ordered pair), for ``arviz.loo``.

    Returns
    -------
    InferenceData
        ``log_likelihood`` has a variable ``<prefix>responses`` per block of questions, of shape (chain, draw,
        cell): the cells of the block's questions one after another, each in the order of its ``Counts``.
    """
    joint = joint_model(problems)
    trace = _sampled(joint, settings)
    with _quiet():
        import pymc as pm

        return pm.compute_log_likelihood(trace, model=joint.model, progressbar=False)


@contextmanager
def _quiet() -> Iterator[None]:
    """ArviZ and PyTensor announce their own future at import: no news for the reader of a report.

    What a missing compiler means is said once, by `compiler_note`.
    """
    logging.getLogger("pytensor.configdefaults").setLevel(logging.ERROR)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@contextmanager
def _optimised(is_worth_it: bool) -> Iterator[None]:
    """Compile with numba's usual effort, or with the least."""
    from numba import config

    before = config.OPT
    config.OPT = before if is_worth_it else type(before)(0)
    try:
        yield
    finally:
        config.OPT = before
