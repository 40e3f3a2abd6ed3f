"""The report's section on the model: would it have given such answers?"""

from collections.abc import Sequence

from analysis.closer_look import CloserLook
from analysis.figures.labels import isolated, one_line, percent
from analysis.figures.predictive import MOST_PAIRS, draw_predictive
from analysis.predictive import UNLIKELY, PredictiveCheck
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_MOST_SAID = 6
_CHECKED = {
    "wins": "answers for ",
    "ties": "share of ties",
    "level": "share of ",
    "spread": "people apart",
}


def predictive_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Would the model have given such answers?"""
    if not look.checks:
        return None
    far = [c for c in look.checks if c.is_unlikely]
    expected = 2 * UNLIKELY * len(look.checks)
    names = [f"{_CHECKED[c.kind]}{one_line(c.what)} on {isolated(c.question)}" if c.what
             else f"{_CHECKED[c.kind]} on {isolated(c.question)}" for c in far[:_MOST_SAID]]  # fmt: skip
    more = f" and {len(far) - _MOST_SAID:,} more" if len(far) > _MOST_SAID else ""
    named = f": {', '.join(names) if more else listed(names)}{more}" if far else ""
    counted = f"{len(far):,}" if far else "None"
    verb = "lie" if len(far) > 1 else "lies"
    words = [
        f"{counted} of {len(look.checks):,} checked quantities {verb} in the outer {percent(UNLIKELY)} % of "
        f"the model's predictions on either side{named}. If the model is right, up to about "
        f"{max(1.0, expected):.0f} would."
    ]
    rows = tuple(
        (
            one_line(c.question),
            _CHECKED[c.kind].strip(),
            one_line(c.what) if c.what else "",
            f"{c.observed:.3f}",
            f"{c.predicted_mean:.3f}",
            f"{c.predicted_low:.3f} to {c.predicted_high:.3f}",
            f"{c.p:.2f}",
        )
        for c in look.checks
    )
    columns = ("Question", "Check", "Of", "Observed", "Predicted", "94 % of predictions", "p")
    table = Table(columns, (False, False, False, True, True, True, True), rows, "predictive.csv")
    caption = (
        "Answers as observed (dots) and as the fitted model predicts them of as many new people with the "
        f"same schedule (grey: central 94 %, line: mean): {listed(_kinds(look.checks))}. p is the share of "
        f"predictions above what was observed; bold and a diamond below {UNLIKELY:g} or above "
        f"{1 - UNLIKELY:g}."
    )
    if max(
        sum(c.kind == "wins" and c.question == q.question.name for c in look.checks) for q in fit.questions
    ) > (MOST_PAIRS):
        caption += f" Of the pairs the {MOST_PAIRS} that the model predicts worst are drawn."
    drawings = draw_predictive([q.question for q in fit.questions], look.checks, tag)
    return Section("Does the model fit?", drawings, "", caption, table, words=tuple(words))


def _kinds(checks: Sequence[PredictiveCheck]) -> list[str]:
    """What is checked, in words."""
    words = {
        "wins": "the share of a pair's answers for the first mode",
        "ties": "of ties",
        "level": "of each answer as shown",
        "spread": "how far people lie apart (root mean square of their net answers around everybody's)",
    }
    known = {check.kind for check in checks}
    return [text for kind, text in words.items() if kind in known]
