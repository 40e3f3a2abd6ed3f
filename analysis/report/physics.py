"""The report's section on preference and physics: what was measured of the laps, beside the answers."""

from math import isnan

from analysis.association import FEWEST_MODES, MEASURES, Association
from analysis.closer_look import CloserLook
from analysis.covariates import SLOPE_SD, CovariateEffect
from analysis.figures.association import draw_association
from analysis.figures.labels import isolated, one_line, percent
from analysis.figures.slopes import draw_slopes
from analysis.figures.style import Drawing
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_WORDS = {m.name: m.words for m in MEASURES}
_MOST_SAID, _MOST_METRICS = 4, 2
_PRIOR_REACH = 1.88 * SLOPE_SD
"""94 % of the prior of a slope lies within [logit]."""


def physics_section(
    look: CloserLook, fit: Fit, tag: str, simulated: bool, is_full: bool = False
) -> Section | None:
    """Pictures always, words of association, and where a model of worth on metrics is; a full report has its
    own section on that."""
    if not look.measures:
        return None
    known = [m for m in MEASURES if any(x.metric == m.name for x in look.measures)]
    words = [_said(look.associations, fit)]
    if simulated:
        words.append(
            "Simulated participants answer by such metrics, as the study file says: here the association "
            "shows the rule they were given, not what people feel."
        )
    words.append(
        "This is association: the metric lies between the mode and the answer, nobody set it, and other "
        "things that the mode changes go with it. In a comparison, too, a metric differs mostly because the "
        "two modes do, so that both views rest on the same few modes."
    )
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
            _interval(a.across_modes, a.across_modes_low, a.across_modes_high),
            f"{a.comparisons:,}",
            _interval(a.across_comparisons, a.across_comparisons_low, a.across_comparisons_high),
            "" if isnan(a.p_positive) else f"{percent(a.p_positive)} %",
        )
        for a in look.associations
    )
    columns = ("Question", "Metric", "Over modes", "Comparisons", "Over comparisons", "Above 0")
    table = Table(columns, (False, False, True, True, True, True), rows, "association.csv")
    drawings: tuple[Drawing, ...] = ()
    if any(q.ranked for q in fit.questions):
        drawings = draw_association(fit.questions, known, look.measures, fit.modes, tag)
    caption = (
        "Worth (across) and mean metric of the laps (upwards) of each mode, with 94 % credible intervals "
        "both ways: posterior of the worth, Bayesian bootstrap over participants of the metric. Times a lap "
        "are of laps that were finished. In the numbers: correlation of ability and metric over the modes, "
        "and rank correlation of the answers with the difference of the metric in the same comparison."
    )
    return Section("Preference meets physics", drawings, "", caption, table, words=tuple(words))


def effects_section(effects: tuple[CovariateEffect, ...], reason: str, fit: Fit, tag: str) -> Section:
    """Ability on metrics, or why there is no such model."""
    n_modes = len(fit.modes)
    heading = "Worth on metrics"
    if not effects:
        return Section(heading, (), "", "", None, words=(reason,))
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
        "Filled: the interval leaves out 0. Dotted: the interval before any answer; the closer a line comes "
        "to it, the less the answers say."
    )
    return Section(heading, drawings, "", caption, table, words=words)


def _narrowed(effects: tuple[CovariateEffect, ...]) -> str:
    shares = [e.slope_sd / SLOPE_SD for e in effects]
    return f"{min(shares):.2f} to {max(shares):.2f}"


def _slopes_said(effects: tuple[CovariateEffect, ...]) -> str:
    clear = sorted((e for e in effects if e.is_clear), key=lambda e: -abs(e.slope_mean))
    if not clear:
        return f"None of {len(effects):,} slopes is told apart from 0."
    said = [
        f"{'more' if e.slope_mean > 0 else 'less'} {_WORDS.get(e.metric, e.metric)} with a higher place on "
        f"{isolated(e.question)}"
        for e in clear[:_MOST_SAID]
    ]
    more = f" and {len(clear) - _MOST_SAID:,} more" if len(clear) > _MOST_SAID else ""
    return f"{len(clear):,} of {len(effects):,} slopes are told apart from 0: {'; '.join(said)}{more}."


def _said(found: tuple[Association, ...], fit: Fit) -> str:
    clear = sorted((a for a in found if a.direction), key=lambda a: -abs(a.across_comparisons))
    if not clear:
        return "No metric goes clearly with the answers of single comparisons."
    shorts = {q.question.name: q.question.short or q.question.name for q in fit.questions}
    groups: dict[str, list[Association]] = {}
    for a in clear:
        groups.setdefault(a.question, []).append(a)
    said = []
    for question, own in list(groups.items())[:_MOST_SAID]:
        metrics = [
            f"{'more' if a.direction > 0 else 'less'} {_WORDS[a.metric]}"
            f" ({a.across_comparisons:+.2f})".replace("-", "\u2212")
            for a in own[:_MOST_METRICS]
        ]
        said.append(f"“{isolated(shorts[question])}” with {listed(metrics)}")
    return (
        f"In single comparisons these went together: {'; '.join(said)}. In brackets stands the rank "
        "correlation of the answers with the difference between the two methods' laps; the table has its "
        "interval."
    )


def _interval(mean: float, low: float, high: float) -> str:
    return "" if isnan(mean) else f"{mean:.2f} ({low:.2f} to {high:.2f})".replace("-", "\u2212")
