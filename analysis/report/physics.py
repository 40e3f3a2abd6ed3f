"""The report's section on preference and physics: what was measured of the laps, beside the answers."""

from math import isnan

from analysis.association import FEWEST_MODES, MEASURES, Association
from analysis.closer_look import CloserLook
from analysis.covariates import CovariateEffect
from analysis.figures.association import draw_association
from analysis.figures.labels import isolated, one_line, percent
from analysis.figures.style import Drawing
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_WORDS = {m.name: m.words for m in MEASURES}
_MOST_SAID, _MOST_METRICS = 4, 2


def physics_section(look: CloserLook, fit: Fit, tag: str, simulated: bool) -> Section | None:
    """Pictures always, words of association, and why there is no model of worth on metrics where there is
    none."""
    if not look.measures:
        return None
    known = [m for m in MEASURES if any(x.metric == m.name for x in look.measures)]
    words = [_said(look.associations, fit)]
    if simulated:
        words.append(
            "Simulated participants answer by such metrics, as the study file says: here the association "
            "shows the "
            "rule they were given, not what people feel."
        )
    words.append(
        "This is association: the metric lies between the mode and the answer, nobody set it, and other "
        "things "
        "that the mode changes go with it."
    )
    if len(fit.modes) < FEWEST_MODES:
        words.append(
            f"No model of worth on metrics is fitted: with {len(fit.modes)} modes a line goes through "
            f"whatever their "
            f"worths are; it takes {FEWEST_MODES} modes."
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
        "Worth (across) and mean metric of the laps (upwards) of each mode, with 94 % intervals both ways: "
        "posterior of "
        "the worth, Bayesian bootstrap over participants of the metric. In the numbers: correlation over "
        "modes, and rank correlation of the answers with the difference of the metric in the same comparison."
    )
    return Section("Preference meets physics", drawings, "", caption, table, words=tuple(words))


def effects_section(effects: tuple[CovariateEffect, ...]) -> Section | None:
    """Ability on metrics, where there are modes enough."""
    if not effects:
        return None
    words = (
        "Ability on one metric at a time (PyMC): logits for one standard deviation more over the modes, "
        "with 94 % "
        "interval, and what the metric leaves of the abilities. A slope is an association over these modes.",
    )
    rows = tuple(
        (
            one_line(e.question),
            _WORDS.get(e.metric, e.metric),
            _interval(e.slope_mean, e.slope_hdi_low, e.slope_hdi_high),
            f"{percent(e.p_positive)} %",
            f"{e.residual_sd:.2f}",
            "" if e.converged else "did not converge",
        )
        for e in effects
    )
    columns = ("Question", "Metric", "Slope", "Above 0", "Left over", "Sampling")
    table = Table(columns, (False, False, True, True, True, False), rows, "covariates.csv")
    return Section("Worth on metrics", (), "", "", table, words=words)


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
        f"correlation of the "
        "answers with the difference between the two methods' laps; the table has its interval."
    )


def _interval(mean: float, low: float, high: float) -> str:
    return "" if isnan(mean) else f"{mean:.2f} ({low:.2f} to {high:.2f})".replace("-", "\u2212")
