"""Truths from the priors, answers from the truths, fits as a report makes them, and where the truths rank."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from analysis.calibration.outcome import Calibration, Ranked, Replicate
from analysis.calibration.quantities import quantities, true_quantities
from analysis.calibration.uniformity import FloatArray, rank_of
from analysis.calibration.world import Design, draw_answers, draw_truth
from analysis.counts import count_responses
from analysis.fit import fit
from analysis.model import Model, model_of
from analysis.results import FitSettings
from data.answers import SCALES
from data.errors import ElbowroomError, InputError, one_of

Progress = Callable[[int, int, str], None]

MOST_REPLICATES = 20_000


def settings_for(model: Model) -> FitSettings:
    """The settings of a report that fits this very model."""
    return FitSettings(
        pooled=not model.hierarchical,
        side_effect=model.side_effect,
        prior_sd=model.prior_sd,
        link=model.link,
        lapse=model.lapse,
        person_side=model.person_side,
        person_scale=model.person_scale,
        position=model.position,
    )


def world_of(settings: FitSettings, levels: int) -> Model:
    """The model that a report with these settings fits to answers of known people, checked.

    Raises
    ------
    InputError
        If there is no such scale, or the link does not fit it.
    """
    if levels not in SCALES:
        raise one_of("levels", levels, tuple(str(n) for n in SCALES))
    return model_of(settings, levels, has_participants=True)


def check_replicates(replicates: int) -> None:
    """Refuse a number of replicates that is none, or more than the bands can be computed for."""
    if not 1 <= replicates <= MOST_REPLICATES:
        raise InputError(f"replicates: {replicates!r} is not between 1 and {MOST_REPLICATES}")


def calibrate(
    model: Model,
    design: Design,
    *,
    replicates: int,
    seed: int,
    n_jobs: int = 1,
    settings: FitSettings | None = None,
    progress: Progress | None = None,
) -> Calibration:
    """Simulate, fit and rank; the result depends on the seed and not on ``n_jobs``.

    Parameters
    ----------
    model : Model
        What true values and answers are drawn from.
    settings : FitSettings, optional
        What the answers are fitted with; by default the same model, as a report would. Their seed is
        replaced by one of each replicate's own.

    Raises
    ------
    InputError
        If there are no or too many replicates.
    ElbowroomError
        If no replicate converges.
    """
    check_replicates(replicates)
    used = settings or settings_for(model)
    from joblib import Parallel, delayed

    one = delayed(replicate)
    results = Parallel(n_jobs=n_jobs, return_as="generator")(
        one(model, design, used, seed, k) for k in range(replicates)
    )
    done: list[Replicate] = []
    failures = 0
    for result in results:
        done.append(result)
        failures += not result.converged
        if progress:
            progress(len(done), replicates, f"{failures} without convergence" if failures else "")
    if failures == replicates:
        raise ElbowroomError(f"calibrate: the sampling converged in none of {replicates} replicates")
    return Calibration(model, design, used, seed, tuple(done))


def replicate(model: Model, design: Design, settings: FitSettings, seed: int, number: int) -> Replicate:
    """One truth, its answers, their fit and the ranks, from random numbers of the replicate's own."""
    world, sampler, ties = np.random.SeedSequence([seed, number]).spawn(3)
    rng = np.random.default_rng(world)
    truth = draw_truth(model, design.n_modes, rng)
    table = draw_answers(model, truth, design, rng)
    question = fit(table, replace(settings, seed=int(sampler.generate_state(1)[0]))).questions[0]
    assert question.draws is not None, "every pair is compared, so no question is refused"
    counts = count_responses(table, table.questions[0], in_order=model.position)
    true = true_quantities(truth, counts, model, design)
    drawn = quantities(question.draws, counts, model, design)
    return Replicate(
        number,
        question.ranked,
        question.rhat_max,
        question.ess_min,
        question.divergences,
        ranked_truths(true, drawn, np.random.default_rng(ties)),
    )


def ranked_truths(
    true: Mapping[str, float], drawn: Mapping[str, FloatArray], rng: np.random.Generator
) -> tuple[Ranked, ...]:
    """Every true quantity among its draws, each of shape (draw,)."""
    return tuple(
        Ranked(
            name, value, float(drawn[name].mean()), float(drawn[name].std(ddof=1)),
            rank_of(value, drawn[name], rng),
        )
        for name, value in true.items()
    )  # fmt: skip
