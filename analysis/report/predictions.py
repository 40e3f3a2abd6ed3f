"""The report's section on the model: would it have given such answers?"""

from collections.abc import Sequence

from analysis.closer_look import CloserLook
from analysis.figures.labels import isolated, one_line, p_value, percent
from analysis.figures.predictive import MOST_PAIRS, NAMES, draw_predictive
from analysis.predictive import SHARES, UNLIKELY, Kind, PredictiveCheck
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_MOST_SAID = 6
_MEANINGS: dict[Kind, str] = {
    "wins": "the share of a pair's answers for the first mode",
    "ties": "of ties",
    "level": "of each answer as shown",
    "spread": "how far people lie apart (root mean square of their net answers around everybody's)",
    "lapse": "careless answers (answers that go against what is expected of the person)",
    "width_by_person": "use of the scale (whether it differs from person to person)",
    "side_by_person": "own sides (whether some favour A and others B)",
    "one_line": "one direction (whether people differ about some modes more than about others)",
    "camps": "camps (whether they form two groups)",
    "repeats": "repeats (whether an answer is that given to the same pair before)",
    "side": "sides (whether A or B is favoured)",
    "side_drift": "side over time (whether that changes in the order of a person's answers)",
    "width_drift": "scale over time (whether its use does)",
}


def predictive_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Would the model have given such answers?"""
    found = look.checks
    if not found.checks:
        return None
    far = [c for c in found.checks if c.is_unlikely]
    names = [f"{check_name(c)} on {isolated(c.question)}" for c in far[:_MOST_SAID]]
    more = f" and {len(far) - _MOST_SAID:,} more" if len(far) > _MOST_SAID else ""
    named = f": {', '.join(names) if more else listed(names)}{more}" if far else ""
    counted = f"{len(far):,}" if far else "None"
    verb = "lie" if len(far) > 1 else "lies"
    words = [
        f"{counted} of {len(found.checks):,} checked quantities {verb} outside the {percent(1 - UNLIKELY)} % "
        f"of the model's predictions{named}. If the model were right, {found.expected:.1f} would be "
        f"expected, and in 95 of 100 studies no more than {found.at_most:,}.",
        _read_on(far, found.at_most),
    ]
    if found.answers < found.answers_in_all:
        words.append(
            f"The checks look at {found.answers:,} of {found.answers_in_all:,} answers, of people drawn at "
            "random."
        )
    rows = tuple(
        (
            one_line(c.question),
            check_name(c),
            *(_shares(c) if c.kind in SHARES else ("", "", "")),
            f"{c.z:+.2f}".replace("-", "\u2212"),
            _p(c.p),
            _p(c.p_all),
        )
        for c in found.checks
    )
    columns = ("Question", "Check", "Observed", "Predicted", "94 % of predictions", "z", "p", "p of all")
    table = Table(columns, (False, False, *([True] * 6)), rows, "predictive.csv")
    caption = (
        "How far each checked quantity lies from what the fitted model predicts of as many new people with "
        "the same schedule, given what its own parameters are fitted to; in standard deviations of a normal "
        f"(z), grey: the {percent(1 - UNLIKELY)} % that the model predicts, bold and a diamond outside. "
        f"Checked are {listed(_meanings(found.checks))}."
    )
    most = max(
        sum(c.kind == "wins" and c.question == q.question.name for c in found.checks) for q in fit.questions
    )
    if most > MOST_PAIRS:
        caption += f" Of the pairs the {MOST_PAIRS} that the model predicts worst are drawn."
    drawings = draw_predictive([q.question for q in fit.questions], found.checks, tag)
    return Section("Does the model fit?", drawings, "", caption, table, words=tuple(words))


def check_name(check: PredictiveCheck) -> str:
    """What a check is called in a sentence and in a table."""
    return NAMES.get(check.kind) or one_line(check.what)


def _read_on(far: Sequence[PredictiveCheck], at_most: int) -> str:
    sure = [c for c in far if c.is_surely_unlikely]
    if sure:
        names = listed([f"{check_name(c)} on {isolated(c.question)}" for c in sure[:_MOST_SAID]])
        return (
            f"Farther out than chance explains even for the most extreme of so many checks: {names}. What "
            "that means stands in “Before you quote this”."
        )
    if len(far) > at_most:
        return "Each may be chance, but together they are more than chance explains."
    return (
        "That is no more than chance explains. It does not show that the model is right: few answers "
        "contradict little, and careless answers above all are hard to see where preferences are weak."
    )


def _shares(check: PredictiveCheck) -> tuple[str, str, str]:
    return (
        f"{check.observed:.3f}",
        f"{check.predicted_mean:.3f}",
        f"{check.predicted_low:.3f} to {check.predicted_high:.3f}",
    )


def _p(p: float) -> str:
    return p_value(p) if p < 0.1 else f"{p:.2f}"


def _meanings(checks: Sequence[PredictiveCheck]) -> list[str]:
    """What is checked, in words."""
    kinds = {check.kind for check in checks}
    return [text for kind, text in _MEANINGS.items() if kind in kinds]
