"""From a response table to a fit: validate, examine, sample, gate, summarise."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, get_args

import numpy as np

from analysis.counts import Counts, count_responses
from analysis.gate import Gate, reported_convergence
from analysis.identifiability import Examination, examine, has_exchanged_sides
from analysis.model import Problem, describe, model_of, priors
from analysis.order import with_order
from analysis.results import Draws, Engine, Fit, FitSettings, Link, QuestionFit
from analysis.summaries import (
    draws_in_order,
    every_draw,
    mode_results,
    pair_results,
    parameter_results,
)
from data.answers import FEWEST_LEVELS
from data.errors import InputError, one_of
from data.responses import QuestionScale, ResponseTable

Progress = Callable[[int, int, str], None]
"""Called with questions done, questions in all and what is being done."""

LONGER = (2, 4)
"""How many times the draws are taken where the gate fails, before a question is not ranked."""
MOST_MODES = 1000
"""More modes than this are refused: every pair of them is a row of the report."""
NO_STRENGTH = (
    "The gibbs engine does not know strength of preference: every longer arrow (A>>B, A>>>B and so on) was "
    "taken as A>B or B>A."
)
NO_WIDTH = "On two levels people cannot differ in the width of the scale: that option is left out."
DIVERGENCES_WORTH_SAYING = 0.001
"""Share of the draws above which divergences are mentioned. Untuned."""


class Sampler(Protocol):
    """What an engine is: problems in, their draws out (modes in the order of the counts)."""

    def __call__(
        self, problems: Sequence[Problem], settings: FitSettings, done: Callable[[int], None] = ...
    ) -> list[Draws]: ...


@dataclass(frozen=True)
class _Prepared:
    counts: Counts
    examination: Examination
    problem: Problem
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class _Sampled:
    draws: Draws
    state: Gate


def fit(table: ResponseTable, settings: FitSettings | None = None, progress: Progress | None = None) -> Fit:
    """Fit every question of a response table.

    Questions share nothing: each is fitted as if it were alone. A question whose chains do not pass the
    convergence gate is sampled again with more draws, of which every second or fourth is kept; if that
    fails too, it is not ranked.

    Parameters
    ----------
    table : ResponseTable
    settings : FitSettings, optional
    progress : callable, optional

    Raises
    ------
    InputError
        If the settings are out of range or do not fit the scales; nothing has been sampled then.
    """
    settings = settings or FitSettings()
    _validate(table, settings)
    if settings.position:
        table = with_order(table)
    tell = progress or (lambda done, total, text: None)
    prepared = [_prepare(table, question, settings) for question in table.questions]
    askable = [k for k, p in enumerate(prepared) if not p.examination.refusal]
    total = len(askable)
    tell(0, total, "sampling")
    sampled = _sampled([prepared[k].problem for k in askable], settings, tell)
    by_question = dict(zip(askable, sampled, strict=True))
    fits = tuple(
        _question_fit(p, table.modes_of(p.counts.question), by_question.get(k))
        for k, p in enumerate(prepared)
    )
    is_hierarchical = table.has_participants and not settings.pooled and settings.engine != "gibbs"
    stated = replace(settings, side_effect=any(p.problem.model.side_effect for p in prepared))
    return Fit(
        questions=fits,
        settings=settings,
        modes=table.modes,
        model=describe(stated, is_hierarchical),
        priors=priors(stated, {q.levels for q in table.questions}, is_hierarchical),
        rhat_max=max((q.rhat_max for q in fits if q.draws is not None), default=math.nan),
        ess_min=min((q.ess_min for q in fits if q.draws is not None), default=math.nan),
        divergences=_divergences(fits, settings),
        converged=all(q.ranked for q in fits if q.draws is not None),
        ranked=all(q.ranked for q in fits),
        warnings=_about_the_whole(table, settings),
    )


def _validate(table: ResponseTable, settings: FitSettings) -> None:
    for what, given, valid in (
        ("engine", settings.engine, get_args(Engine)),
        ("link", settings.link, get_args(Link)),
    ):
        if given not in valid:
            raise one_of(what, given, valid)
    if settings.engine == "gibbs" and settings.options:
        option = settings.options[0]
        raise InputError(f"{option}: the engine gibbs does not have this option; valid: fast, pymc")
    if settings.engine == "gibbs" and settings.link != "cumulative":
        raise InputError(f"link: {settings.link} is not known to the engine gibbs; valid: cumulative")
    if not (math.isfinite(settings.prior_sd) and settings.prior_sd > 0):
        raise InputError(f"prior_sd: {settings.prior_sd!r} is not a positive number")
    if not 0 < settings.target_accept < 1:
        raise InputError(f"target_accept: {settings.target_accept!r} is not between 0 and 1")
    if settings.seed < 0:
        raise InputError(f"seed: {settings.seed!r} is negative")
    for what, number, least in (
        ("draws", settings.draws, 100),
        ("tune", settings.tune, 100),
        ("chains", settings.chains, 2),
    ):
        if number < least:
            raise InputError(f"{what}: {number!r} is fewer than {least}")
    if len(table.modes) < 2:
        raise InputError("a ranking needs at least two modes")
    if len(table.modes) > MOST_MODES:
        raise InputError(f"{len(table.modes)} modes are more than a report can rank; at most {MOST_MODES}")
    for question in table.questions:
        model_of(settings, question.levels, table.has_participants)


def _prepare(table: ResponseTable, question: QuestionScale, settings: FitSettings) -> _Prepared:
    counts = count_responses(table, question, in_order=settings.position)
    is_gibbs = settings.engine == "gibbs"
    examination = examine(
        counts,
        table.modes_of(question),
        has_participants=table.has_participants,
        side_effect=settings.side_effect and not is_gibbs,
    )
    used, warnings = counts, examination.warnings
    if is_gibbs and counts.levels > 3:
        used = counts.collapsed()
        warnings += (NO_STRENGTH,)
    if settings.person_scale and counts.levels == FEWEST_LEVELS:
        warnings += (NO_WIDTH,)
    if is_gibbs and not examination.refusal:
        from analysis.engines.gibbs import IMPROPER, is_proper

        if not is_proper(used):
            examination = replace(examination, refusal=IMPROPER)
    model = model_of(settings, used.levels, table.has_participants)
    model = replace(model, side_effect=model.side_effect and examination.has_side_effect)
    if is_gibbs:
        model = replace(model, hierarchical=False, side_effect=False)
    if not model.hierarchical:
        used = used.pooled()
    return _Prepared(counts, examination, Problem(used, model), warnings)


def _sampled(problems: list[Problem], settings: FitSettings, tell: Progress) -> list[_Sampled]:
    """Draws of every problem that pass the gate, or the longest there are."""
    if not problems:
        return []
    sample = _sampler(settings.engine)
    names = [problem.counts.question.short or problem.counts.question.name for problem in problems]
    draws = sample(problems, settings, lambda k: tell(k, len(problems), names[k - 1]))
    found = [_gated(d, problem) for d, problem in zip(draws, problems, strict=True)]
    for times in LONGER:
        failed = [k for k, one in enumerate(found) if not one.state.passed]
        if not failed:
            break
        tell(len(problems), len(problems), f"sampling longer: {', '.join(names[k] for k in failed)}")
        longer = replace(settings, draws=settings.draws * times)
        for k, again in zip(failed, sample([problems[k] for k in failed], longer), strict=True):
            # Thinned, so that every question has as many draws as the settings say.
            found[k] = _gated(every_draw(again, times), problems[k])
    return found


def _gated(draws: Draws, problem: Problem) -> _Sampled:
    return _Sampled(draws, reported_convergence(draws, problem.counts.modes))


def _sampler(engine: Engine) -> Sampler:
    """The engine's door; its imports are paid only by those who use it."""
    match engine:
        case "fast":
            from analysis.engines import fast

            return fast.sample
        case "pymc":
            from analysis.engines import pymc_engine

            return pymc_engine.sample
        case "gibbs":
            from analysis.engines import gibbs

            return gibbs.sample


def _question_fit(prepared: _Prepared, modes: tuple[str, ...], found: _Sampled | None) -> QuestionFit:
    counts, examination = prepared.counts, prepared.examination
    known = [name for name in counts.participants if name]
    unranked = QuestionFit(
        question=counts.question,
        ranked=False,
        reason=examination.refusal,
        modes=(),
        pairs=pair_results(counts, modes, None),
        parameters=(),
        draws=None,
        rhat_max=math.nan,
        ess_min=math.nan,
        divergences=0,
        warnings=prepared.warnings,
        n=counts.n,
        n_participants=len(known),
        missing_pairs=examination.missing_pairs,
        hierarchical=prepared.problem.model.hierarchical,
        is_side_told_apart=has_exchanged_sides(counts),
    )
    if found is None:
        return unranked
    draws = draws_in_order(found.draws, [counts.modes.index(mode) for mode in modes])
    state = found.state
    sampled = replace(
        unranked,
        draws=draws,
        rhat_max=state.rhat_max,
        ess_min=state.ess_min,
        divergences=int(draws.diverging.sum()),
    )
    if not state.passed:
        return replace(sampled, reason=state.refusal)
    said = sampled.warnings
    if draws.diverging.mean() > DIVERGENCES_WORTH_SAYING:
        said += (
            f"{draws.diverging.sum():,} of {draws.diverging.size:,} draws diverged: intervals may be too "
            "narrow. A fit with a higher target_accept (in Python: FitSettings) would show it.",
        )
    return replace(
        sampled,
        ranked=True,
        modes=mode_results(draws, modes),
        pairs=pair_results(counts, modes, draws),
        parameters=parameter_results(draws, prepared.problem.model.parameter_names(modes)),
        warnings=said,
    )


def _divergences(fits: Sequence[QuestionFit], settings: FitSettings) -> int:
    """Draws that diverged; the pymc engine samples the questions together, so theirs are the same draws."""
    diverging = [q.draws.diverging for q in fits if q.draws is not None]
    if settings.engine == "pymc" and diverging:
        return int(np.any(diverging, axis=0).sum())
    return sum(q.divergences for q in fits)


def _about_the_whole(table: ResponseTable, settings: FitSettings) -> tuple[str, ...]:
    said = list(table.notes)
    if not table.has_participants:
        said.append(
            "The answers name no participants, so they are taken as independent: if people answered more "
            "than once, the intervals are too narrow."
        )
    elif settings.pooled or settings.engine == "gibbs":
        said.append(
            "Participants are pooled: their answers are taken as independent, so intervals are too narrow."
        )
    if settings.engine == "gibbs" and settings.prior_sd != FitSettings.prior_sd:
        said.append(
            f"The gibbs engine's prior is Dirichlet(1) on the worths: the prior sd of {settings.prior_sd:g} "
            "is not used."
        )
    if settings.engine == "pymc":
        from analysis.engines.pymc_engine import compiler_note

        said += compiler_note()
    return tuple(said)
