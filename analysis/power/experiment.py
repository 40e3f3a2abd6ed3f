"""Simulated studies of every size, each fitted as a report would fit it."""

from collections.abc import Callable

import numpy as np

from analysis.fit import fit
from analysis.power.answers import draw_answers
from analysis.power.outcome import Power, PowerPoint
from analysis.power.plan import Plan, check_plan
from analysis.power.scenario import Verdict
from analysis.results import FitSettings

Progress = Callable[[int, int, str], None]


def power(
    plan: Plan,
    *,
    n_jobs: int = 1,
    progress: Progress | None = None,
    each: Callable[[PowerPoint], None] | None = None,
) -> Power:
    """Simulate and fit the studies of a plan; the result does not depend on ``n_jobs``.

    Parameters
    ----------
    plan : Plan
    progress : callable, optional
        Called with studies done, studies in all and the size that is under way.
    each : callable, optional
        Called with every size as soon as it is done.

    Raises
    ------
    InputError
        If the plan makes no study; nothing has been simulated then.
    """
    check_plan(plan)
    from joblib import Parallel, delayed

    jobs = [(*size, k) for size in plan.sizes for k in range(plan.replicates)]
    one = delayed(verdict)
    # The largest first would balance better, but people like to see the small sizes done.
    results = Parallel(n_jobs=n_jobs, return_as="generator")(one(plan, *job) for job in jobs)
    found: list[Verdict] = []
    points: list[PowerPoint] = []
    for done, ((repetitions, people, _), result) in enumerate(zip(jobs, results, strict=True), start=1):
        found.append(result)
        if progress:
            progress(done, len(jobs), f"{people} participants")
        if len(found) == plan.replicates:
            answers = people * plan.answers_each(repetitions)
            points.append(PowerPoint.of(repetitions, people, answers, found))
            found = []
            if each:
                each(points[-1])
    return Power(plan, tuple(points))


def verdict(plan: Plan, repetitions: int, participants: int, number: int) -> Verdict:
    """What one simulated study concludes, from random numbers of its own."""
    world, sampler = np.random.SeedSequence([plan.seed, repetitions, participants, number]).spawn(2)
    study = plan.study_with(repetitions)
    table = draw_answers(study, plan.scenario, participants, np.random.default_rng(world))
    question = fit(table, FitSettings(seed=int(sampler.generate_state(1)[0]))).questions[0]
    return plan.conclusion.of(question, plan.scenario)
