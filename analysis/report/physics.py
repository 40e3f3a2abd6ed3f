"""The report's section on preference and physics: what was measured of the laps, beside the answers."""

from collections.abc import Sequence
from math import isnan

from analysis.association import (
    FEWEST_TO_PASS,
    LIST_ERROR,
    SECTION,
    Association,
    association_claims,
)
from analysis.closer_look import CloserLook
from analysis.covariates import FEWEST_MODES, SLOPE_SD, SLOPES_SECTION, CovariateEffect
from analysis.figures.association import draw_association
from analysis.figures.labels import isolated, one_line, p_value, percent
from analysis.figures.slopes import draw_slopes
from analysis.figures.style import Drawing
from analysis.measures import MEASURES
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_MEASURES = {m.name: m for m in MEASURES}
_WORDS = {m.name: m.words for m in MEASURES}
_MOST_QUESTIONS, _MOST_METRICS = 4, 3
_PRIOR_REACH = 1.88 * SLOPE_SD
"""94 % of the prior of a slope lies within [logit]."""


def physics_section(
    look: CloserLook, fit: Fit, tag: str, simulated: bool, is_full: bool = False
) -> Section | None:
    """Pictures always, words of association where any pass, and where a model of worth on metrics is; a full
    report has its own section on that."""
    if not look.measures:
        return None
    measured = [m for m in MEASURES if any(x.metric == m.name for x in look.measures)]
    words = _association_words(look.associations, fit, simulated)
    if not is_full:
        words.append(
            f"No model of worth on metrics is fitted: with {len(fit.modes)} modes a line goes through their "
            f"worths whatever they are; it takes {FEWEST_MODES} modes."
            if len(fit.modes) < FEWEST_MODES
            else "A full report (elbowroom report --full) has a model of worth on each metric too."
        )
    rows = tuple(
        (
            one_line(a.question),
            _WORDS[a.metric],
            f"{a.comparisons:,}",
            f"{a.participants:,}",
            _interval(a.correlation, a.correlation_low, a.correlation_high),
            "" if isnan(a.mode_share) else f"{percent(a.mode_share)} %",
            p_value(a.p_in_list),
        )
        for a in look.associations
    )
    columns = ("Question", "Metric", "Comparisons", "People", "Within people", "From modes", "Corrected p")
    table = Table(columns, (False, False, True, True, True, True, True), rows, "association.csv")
    drawings: tuple[Drawing, ...] = ()
    if any(q.ranked for q in fit.questions):
        drawings = draw_association(fit.questions, measured, look.measures, fit.modes, tag)
    caption = (
        "Worth (across) and mean metric of the laps (upwards) of each mode, with 94 % intervals both ways: "
        "of the worth from the posterior, of the metric over people; as the same people met several modes, "
        "intervals of a metric that overlap do not say that modes are alike. "
        f"{_means_explained(look)}Times a lap are of laps that were finished. In the numbers: rank "
        "correlation within people of their answers with the difference of the metric between the two laps, "
        "with its 94 % interval over people, each by itself; how much of that difference comes from the "
        "modes; and p, corrected for all pairs of a question and a metric."
    )
    return Section(SECTION, drawings, "", caption, table, words=tuple(words))


def _means_explained(look: CloserLook) -> str:
    """Which means are geometric, and whom they leave out."""
    geometric = [m for m in MEASURES if any(x.metric == m.name and x.is_geometric for x in look.measures)]
    if not geometric:
        return ""
    words = f"The mean is geometric for {listed([m.words for m in geometric])}"
    with_zeros = [m.words for m in geometric if any(x.metric == m.name and x.zeros for x in look.measures)]
    if with_zeros:
        words += f"; the mean of {listed(with_zeros)} leaves out people at 0, and is 0 where all are"
    return words + ". "


def effects_section(effects: tuple[CovariateEffect, ...], reason: str, fit: Fit, tag: str) -> Section:
    """Ability on metrics, or why there is no such model."""
    n_modes = len(fit.modes)
    if not effects:
        return Section(SLOPES_SECTION, (), "", "", None, words=(reason,))
    words = (
        "Each metric by itself was put into the model: a straight line from the modes' mean metric to their "
        "abilities, and what the line leaves. A slope is how many logits of ability go with one standard "
        "deviation more of the metric over the modes.",
        f"The line has {n_modes} points, one a mode, however many people answered. So the slope is weakly "
        f"identified: before any answer its 94 % interval was \u2212{_PRIOR_REACH:.1f} to "
        f"{_PRIOR_REACH:.1f}, and the spread that is left (posterior sd over prior sd: "
        f"{_narrowed(effects)}) is mostly for want of modes. Metrics that go together over the modes cannot "
        "be told apart, and the modes' metrics are taken as known.",
        f"{_slopes_said(effects)} All of this is association: the metric lies between the mode and the "
        "answer, nobody set it, and whatever else differs between the modes goes with it.",
    )
    units = {m.name: m.unit for m in MEASURES}
    rows = tuple(
        (
            one_line(e.question),
            _WORDS.get(e.metric, e.metric),
            f"{e.metric_sd:.3g} {units.get(e.metric, '')}".strip(),
            _interval(e.slope_mean, e.slope_hdi_low, e.slope_hdi_high),
            f"{percent(e.p_positive)} %",
            f"{e.residual_sd:.2f}",
        )
        for e in effects
    )
    columns = ("Question", "Metric", "One sd is", "Slope [logit]", "Above 0", "Left over [logit]")
    table = Table(columns, (False, False, True, True, True, True), rows, "covariates.csv")
    drawings = draw_slopes([q.question for q in fit.questions], effects, _WORDS, _PRIOR_REACH, tag)
    caption = (
        "How much ability goes with one standard deviation more of a metric, with 94 % credible intervals. "
        "Filled: told apart from 0, corrected for the number of slopes. Dotted: the interval before any "
        "answer; the closer a line comes to it, the less the answers say."
    )
    return Section(SLOPES_SECTION, drawings, "", caption, table, words=words)


def _narrowed(effects: tuple[CovariateEffect, ...]) -> str:
    shares = [e.slope_sd / SLOPE_SD for e in effects]
    return f"{min(shares):.2f} to {max(shares):.2f}"


def _slopes_said(effects: tuple[CovariateEffect, ...]) -> str:
    clear = sorted((e for e in effects if e.is_clear), key=lambda e: -abs(e.slope_mean))
    if not clear:
        return f"None of {len(effects):,} slopes is told apart from 0, corrected for their number."
    said = [
        f"{_MEASURES[e.metric].compared(e.slope_mean)} with a higher place on {isolated(e.question)}"
        for e in clear[:_MOST_QUESTIONS]
    ]
    more = f" and {len(clear) - _MOST_QUESTIONS:,} more" if len(clear) > _MOST_QUESTIONS else ""
    return (
        f"{len(clear):,} of {len(effects):,} slopes are told apart from 0, corrected for their number: all "
        f"of these signs are right with a probability of at least {percent(1 - LIST_ERROR)} %. They are "
        f"{'; '.join(said)}{more}."
    )


def _association_words(found: Sequence[Association], fit: Fit, simulated: bool) -> list[str]:
    """What passes, with the error rate of the list and what it does not show; or that nothing does."""
    tested = [a for a in found if not isnan(a.p_in_list)]
    if not tested:
        return ["No answers can be set beside metrics here: it takes people with several comparisons each."]
    together = f"{len(tested):,} pairs of a question and a metric were tested together, people as the units"
    claims = association_claims(found, fit)
    if not claims:
        people = max(a.participants for a in tested)
        few = f" With {people} people none can: it takes {FEWEST_TO_PASS}." if people < FEWEST_TO_PASS else ""
        return [
            "No metric went with the answers of single comparisons more than chance allows: "
            f"{together}, and none passed.{few}"
        ]
    rate = f"{percent(LIST_ERROR)} %"
    words = [
        f"In single comparisons these went together: {_named(found, fit)}. In brackets stands the rank "
        "correlation within people of the answers with the difference between the two modes' laps.",
        f"{together}. The probability that a study names any pair that does not go together is at most "
        f"{rate}, so the false-discovery rate of its list is at most {rate} too.",
    ]
    if simulated:
        words.append(
            "Simulated participants answer by such metrics, as the study file says: here the association "
            "shows the rule they were given, not what people feel."
        )
    words.append(
        "This is association: nobody set the metric, and whatever else differs between the modes goes with "
        f"it. {_from_modes(tested)} What comes from the modes rests on {len(fit.modes)} modes, however many "
        "people answered."
    )
    return words


def _named(found: Sequence[Association], fit: Fit) -> str:
    shorts = {q.question.name: q.question.short or q.question.name for q in fit.questions}
    passing = sorted((a for a in found if a.passes), key=lambda a: -abs(a.correlation))
    by_question: dict[str, list[Association]] = {}
    for a in passing:
        by_question.setdefault(a.question, []).append(a)
    shown = [(q, own[:_MOST_METRICS]) for q, own in list(by_question.items())[:_MOST_QUESTIONS]]
    phrases = []
    for question, own in shown:
        metrics = [
            f"{_MEASURES[a.metric].compared(a.correlation)} ({a.correlation:+.2f})".replace("-", "\u2212")
            for a in own
        ]
        phrases.append(f"“{isolated(shorts[question])}” with {listed(metrics)}")
    more = len(passing) - sum(len(own) for _, own in shown)
    return "; ".join(phrases) + (f"; and {more:,} more, in the table" if more else "")


def _from_modes(tested: Sequence[Association]) -> str:
    """How much of the differences between laps is that between modes."""
    shares = {a.metric: a.mode_share for a in tested if not isnan(a.mode_share)}
    most, least = max(shares, key=lambda m: shares[m]), min(shares, key=lambda m: shares[m])
    if most == least:
        return f"The modes explain {percent(shares[most])} % of the differences in {_WORDS[most]}."
    return (
        f"Of the differences between two laps, the modes explain {percent(shares[most])} % in {_WORDS[most]} "
        f"and {percent(shares[least])} % in {_WORDS[least]}."
    )


def _interval(mean: float, low: float, high: float) -> str:
    return "" if isnan(mean) else f"{mean:.2f} ({low:.2f} to {high:.2f})".replace("-", "\u2212")
