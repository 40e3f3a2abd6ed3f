"""What a reader must know before quoting the report: the list "Before you quote this"."""

import re
from collections.abc import Sequence
from math import isnan

import numpy as np

from analysis.data_quality import DataQuality
from analysis.diagnostics import ess_in_words, rhat_in_words
from analysis.figures.labels import isolated, one_line, percent
from analysis.lag import LagExclusion, ModeDelay
from analysis.predictive import PredictiveChecks
from analysis.report.findings import Finding, listed
from analysis.report.model_cautions import model_cautions
from analysis.report.parameter_cautions import about_priors, about_sides
from analysis.report.straight_lines import about_lines
from analysis.report.tables import neutralised_names
from analysis.results import Fit, QuestionFit
from analysis.straight_lining import StraightLining
from data.responses import ResponseTable
from data.study import Study

FEW_PARTICIPANTS = 20
"""Below this the report calls participants few. Untuned: simulated studies of this kind with twenty
people find the true first place surely in fewer than half of all cases."""
_DIVIDED = 0.3
_MOST_OF_A_KIND = 3
UNEQUAL_MS = 10.0
"""Difference between two modes' median input delay that the report warns of [ms]. Untuned."""
UNEQUAL_SKIPPED_PERCENT = 1.0
"""The same for the share of skipped ticks. Untuned."""

_TRIALS = {
    "observed": "Participants watched a simulated robot. A real arm in the hand may be judged differently.",
    "guided": (
        "Participants guided a simulated robot in the browser: they saw how it moved, but felt no force. "
        "Guiding with a mouse is not force contact, and a real arm in the hand may be judged differently."
    ),
    "external": (
        "Participants used a robot in the lab. An operator loaded each method and confirmed it: that it was "
        "the one that the schedule asked for is not measured."
    ),
}
"""What each source of trials leaves open."""


def cautions(
    table: ResponseTable,
    fit: Fit,
    found: Sequence[Finding],
    study: Study | None,
    checks: int,
    quality: DataQuality | None = None,
    model_checks: PredictiveChecks | None = None,
    lines: StraightLining | None = None,
    about_size: Sequence[str] = (),
) -> tuple[str, ...]:
    """Plain sentences, the gravest first."""
    quality = quality or DataQuality()
    said = [
        *_about_the_source(table, study),
        *unknown_sides(table, fit.settings.side_effect),
        *unequal_delays(quality.delays),
        *_about_the_number(fit),
        *about_size,
        *_about_the_unanswered(fit, study),
        *_about_the_questions(fit),
        *fit.warnings,
        *_about_people(found),
        *model_cautions(model_checks or PredictiveChecks()),
        *about_priors(fit),
        *about_sides(fit),
        *about_lines(lines or StraightLining()),
        *_about_what_is_left_out(quality.excluded),
        *_about_checks(checks),
        *_about_names(fit),
        *about_convergence(fit),
    ]
    return tuple(dict.fromkeys(said))


def unknown_sides(table: ResponseTable, has_side_effect: bool) -> list[str]:
    """What a side effect means where a file does not say what was shown as A (column ``sides``)."""
    if not has_side_effect or "sides" not in table.rows:
        return []
    total = int(table.rows["count"].sum())
    unknown = int(table.rows.loc[table.rows["sides"] == "unknown", "count"].sum())
    if not unknown:
        return []
    return [
        f"For {unknown:,} of {total:,} answers it is unknown which mode was shown as A: there the side "
        "effect is about the order of the modes in the file. --no-side-effect leaves it out."
    ]


def unanswered(fit: Fit, study: Study | None) -> tuple[str, ...]:
    """Questions of the study that nobody answered, in its order."""
    asked = {q.question.name for q in fit.questions}
    return tuple(q.name for q in study.questions if q.name not in asked) if study is not None else ()


def _about_the_source(table: ResponseTable, study: Study | None) -> list[str]:
    if table.is_simulated:
        sources = table.rows.groupby("source")["count"].sum()
        simulated, total = int(sources.get("simulated", 0)), int(sources.sum())
        if simulated < total:
            return [
                f"{simulated:,} of {total:,} answers were made by simulated participants. They are mixed "
                "with answers of people here: don't quote this as a result about people.",
                *([_TRIALS[study.protocol.trial_source]] if study is not None else []),
            ]
        return [
            "All answers were made by simulated participants. They show what the method does, not what "
            "people prefer."
        ]
    return [_TRIALS[study.protocol.trial_source]] if study is not None else []


def _about_the_number(fit: Fit) -> list[str]:
    people = max((q.n_participants for q in fit.questions), default=0)
    if 1 < people < FEW_PARTICIPANTS:
        return [
            f"{people} participants are few: more could change the order. “elbowroom power” tells how many "
            "are needed."
        ]
    return []


def _about_the_unanswered(fit: Fit, study: Study | None) -> list[str]:
    names = [isolated(name) for name in unanswered(fit, study)]
    if not names:
        return []
    return [
        f"Nobody answered {listed(names)}: there is no ranking for {'it' if len(names) == 1 else 'them'}."
    ]


def _about_the_questions(fit: Fit) -> list[str]:
    """Warnings of single questions, each said once with the questions it holds for."""
    by_text: dict[str, list[str]] = {}
    for question in fit.questions:
        for warning in question.warnings:
            by_text.setdefault(one_line(warning), []).append(isolated(question.question.name))
    inferred = [q for q in fit.questions if q.question.levels_inferred]
    said = []
    if inferred:
        levels = sorted({q.question.levels for q in inferred})
        counted = listed([str(k) for k in levels])
        said.append(
            f"No study file was given, so the levels of the scale ({counted}) were inferred from the "
            "answers: a level that nobody chose is not known."
        )
    many = len(fit.questions) > 1
    for text, names in by_text.items():
        if many and len(names) < len(fit.questions):
            said.append(f"{listed(names)}: {text}")
        else:
            # A number in the sentence is that of each question, not of all of them together.
            said.append(f"In each question: {text}" if many and re.search(r"\d", text) else text)
    return said


def _about_people(found: Sequence[Finding]) -> list[str]:
    """Where many people are expected to put the rival above the group's first."""
    divided = []
    for f in found:
        share = _disagreeing(f)
        if share is not None and share >= _DIVIDED:
            divided.append((share, f))
    divided.sort(key=lambda pair: -pair[0])
    said = [
        f"People differ: for “{f.label}” about {percent(share)} % would put {isolated(f.rival)} above "
        f"{isolated(f.first)}, although the group does not."
        for share, f in divided[:_MOST_OF_A_KIND]
        if f.reading == "likely"
    ]
    if said:
        said[-1] += " A worth is that of someone in the middle of the group, not a share of people."
    return said


def _disagreeing(found: Finding) -> float | None:
    """Posterior mean share of people whose own ability of the rival exceeds that of the first mode."""
    question = found.question
    if question.draws is None or not question.ranked or "subject_sd" not in question.draws.parameters:
        return None
    from scipy.special import ndtr

    names = [m.mode for m in question.modes]
    ability = question.draws.ability.reshape(-1, len(names))
    difference = ability[:, names.index(found.first)] - ability[:, names.index(found.rival)]
    tau = question.draws.parameters["subject_sd"].reshape(-1)
    return float(np.mean(ndtr(-difference / (np.sqrt(2) * np.maximum(tau, 1e-12)))))


def unequal_delays(delays: Sequence[ModeDelay]) -> list[str]:
    """A sentence for each way in which modes were delayed unequally."""
    said = []
    for name, unit, limit, digits in (
        ("latency_median_ms", " ms", UNEQUAL_MS, 0),
        ("skipped_percent", " %", UNEQUAL_SKIPPED_PERCENT, 1),
    ):
        known = sorted((getattr(d, name), d.mode) for d in delays if not isnan(getattr(d, name)))
        if len(known) < 2 or known[-1][0] - known[0][0] <= limit:
            continue
        (low, prompt), (high, laggy) = known[0], known[-1]
        what = "The input delay" if unit == " ms" else "The share of skipped ticks"
        said.append(
            f"{what} was unequal: {high:.{digits}f}{unit} with {isolated(laggy)}, {low:.{digits}f}{unit} "
            f"with {isolated(prompt)}. That alone can decide a comparison."
        )
    return said


def _about_what_is_left_out(excluded: LagExclusion | None) -> list[str]:
    if excluded is None or not excluded.comparisons:
        return []
    left = len(excluded.comparisons)
    return [
        f"{left:,} of {excluded.total:,} comparisons are left out because of lag. Who has a slow machine may "
        "differ from who has not: see what it changes below."
    ]


def _about_names(fit: Fit) -> list[str]:
    changed = neutralised_names(fit)
    if not changed:
        return []
    return [
        "In the CSV files these names have a ' before them, so that no spreadsheet runs them: "
        + ", ".join(isolated(name) for name in changed)
    ]


def _about_checks(checks: int) -> list[str]:
    if not checks:
        return []
    answers = (
        "1 answer to an attention check is" if checks == 1 else f"{checks:,} answers to attention checks are"
    )
    return [f"{answers} left out of the model."]


def about_convergence(fit: Fit) -> list[str]:
    """Whether the sampler converged, in figures."""
    if np.isnan(fit.rhat_max):
        return []
    ess = ess_in_words(fit.ess_min)
    figures = f"largest R-hat {rhat_in_words(fit.rhat_max)}, smallest effective sample size {ess}"
    if fit.settings.engine != "gibbs":
        figures += f", {_divergences(fit)}"
    if fit.converged:
        return [f"The sampler converged: {figures}."]
    failed = [isolated(q.question.name) for q in fit.questions if _sampled(q) and not q.ranked]
    return [f"The sampler did not converge{' in ' + listed(failed) if failed else ''}: {figures}."]


def _divergences(fit: Fit) -> str:
    if fit.divergences == 0:
        return "no divergences"
    return f"{fit.divergences:,} divergent draw{'' if fit.divergences == 1 else 's'}"


def _sampled(question: QuestionFit) -> bool:
    return question.draws is not None
