"""The report's sections on what refits tell: other models, other priors, laggy comparisons left out."""

from math import isnan

from analysis.figures.labels import isolated, one_line, percent
from analysis.leaving_out import SMALL_DIFFERENCE, ModelScore
from analysis.refits import Refits
from analysis.report.changes import changes_table
from analysis.report.findings import listed
from analysis.report.moderated import moderation_section
from analysis.report.page import Section, Table
from analysis.report.physics import effects_section
from analysis.results import Fit
from analysis.sensitivity import PriorShift

LARGE_SHIFT = 0.05
"""A worth that moves by more is pointed out. Untuned."""
_MOST_SAID = 6
_NOT_USED = "Nothing is read from a fit that this report would not rank by."


def people_sections(found: Refits | None, fit: Fit, tag: str) -> list[Section]:
    """What a full report tells of groups of people."""
    return [] if found is None else [moderation_section(found.moderation, fit, tag)]


def metric_sections(found: Refits | None, fit: Fit, tag: str) -> list[Section]:
    """What a full report tells of worths and metrics; nothing where there are no laps."""
    if found is None or not (found.effects or found.no_effects):
        return []
    return [effects_section(found.effects, found.no_effects, fit, tag)]


def refit_sections(found: Refits | None) -> list[Section | None]:
    """What a full report tells of models and data beyond the ranking."""
    if found is None:
        return []
    return [_scores(found.scores), _shifts(found.shifts), _lag(found)]


def _scores(scores: tuple[ModelScore, ...]) -> Section | None:
    if not scores:
        return None
    told = [s for s in scores if s.reading in ("predicts better", "predicts worse")]
    blank = [s for s in scores if s.missing]
    again = sum(s.refitted for s in scores)
    words = [
        "Each model predicts the answers of every participant as if it had not seen them, and is scored by "
        "the log density that it gave them (elpd, higher is better). Its draws are weighted to leave the "
        "participant out; "
        + (
            f"in {again:,} cases the weights could not be trusted, and the model was fitted again without "
            "the participant. "
            if again
            else "the weights could be trusted throughout, so that nothing had to be fitted without a "
            "participant. "
        )
        + f"A difference below {SMALL_DIFFERENCE:g} or below two standard errors tells nothing."
    ]
    if told:
        said = [f"{isolated(s.question)}: “{s.model}” {s.reading} than the report's model" for s in told]
        words.append(f"{'; '.join(said)}.")
    elif any(s.reading == "not told apart" for s in scores):
        words.append(
            "No model is told apart from the report's: these answers cannot show that any of them would "
            "predict people better, or worse."
        )
    if blank:
        words.append(f"No score: {_listed_with_reasons(blank)}. {_NOT_USED}")
    if max(s.participants for s in scores) < 20:
        words.append("With so few participants the standard errors are rough themselves.")
    rows = tuple(
        (
            one_line(s.question),
            s.model,
            "" if isnan(s.elpd) else f"{s.elpd:.1f}".replace("-", "\u2212"),
            "" if not s.reading or isnan(s.difference) else f"{s.difference:+.1f}".replace("-", "\u2212"),
            "" if not s.reading or isnan(s.difference) else f"{s.difference_se:.1f}",
            s.reading,
        )
        for s in scores
    )
    columns = ("Question", "Model", "elpd", "Difference", "se", "Reading")
    table = Table(columns, (False, False, True, True, True, False), rows, "models.csv")
    return Section("Would another model predict people better?", (), "", "", table, words=tuple(words))


def _listed_with_reasons(blank: list[ModelScore]) -> str:
    said = [f"{isolated(s.question)}, “{s.model}”: {s.missing}" for s in blank[:_MOST_SAID]]
    more = f"; and {len(blank) - _MOST_SAID} more" if len(blank) > _MOST_SAID else ""
    return "; ".join(said) + more


def _shifts(shifts: tuple[PriorShift, ...]) -> Section | None:
    if not shifts:
        return None
    known = [s for s in shifts if not isnan(s.worth_then)]
    large = [s for s in known if abs(s.worth_then - s.worth) > LARGE_SHIFT]
    most = max(known, key=lambda s: abs(s.worth_then - s.worth), default=None)
    blank = [s for s in shifts if isnan(s.worth_then)]
    weighted = sum(s.is_weighted for s in blank)
    words = [
        "The prior on abilities at half and at twice its scale: the model is fitted again. The prior on how "
        "much people differ (subject sd) at half and at twice its scale: nothing is fitted again, the "
        "report's draws are weighted, which tells the shift where it is moderate"
        + (f"; the weights could not be trusted in {_rows(weighted, shifts)}." if weighted else ".")
    ]
    if len(blank) > weighted:
        words.append(
            f"The fit under another prior does not rank the modes in {_rows(len(blank) - weighted, shifts)}. "
            f"{_NOT_USED}"
        )
    if most is not None:
        words.append(
            f"The largest shift: {isolated(most.mode)} on {isolated(most.question)}, from {most.worth:.2f} "
            f"to {most.worth_then:.2f} under {most.prior}. "
            + (
                f"{len(large):,} of {len(known):,} worths {'moves' if len(large) == 1 else 'move'} by more "
                f"than {LARGE_SHIFT:g}: there the prior matters."
                if large
                else f"No worth moves by more than {LARGE_SHIFT:g}."
            )
        )
    turned = _other_firsts(known)
    if turned:
        words.append(f"Another mode comes first under another prior: {listed(turned[:_MOST_SAID])}.")
    elif known:
        words.append("None of these priors changes which mode comes first.")
    rows = tuple(
        (
            one_line(s.question),
            one_line(s.mode),
            s.prior,
            f"{s.worth:.3f}",
            "" if isnan(s.worth_then) else f"{s.worth_then:.3f}",
            f"{percent(s.p_best)} %",
            "" if isnan(s.p_best_then) else f"{percent(s.p_best_then)} %",
        )
        for s in shifts
    )
    columns = ("Question", "Mode", "Prior", "Worth", "Then", "First", "Then first")
    table = Table(columns, (False, False, False, *([True] * 4)), rows, "priors.csv")
    return Section("Do the priors decide?", (), "", "", table, words=tuple(words))


def _rows(n: int, shifts: tuple[PriorShift, ...]) -> str:
    return f"{n:,} of {len(shifts):,} rows, left blank"


def _other_firsts(shifts: list[PriorShift]) -> list[str]:
    groups: dict[tuple[str, str], list[PriorShift]] = {}
    for s in shifts:
        groups.setdefault((s.question, s.prior), []).append(s)
    said = []
    for (question, prior), own in groups.items():
        before, then = max(own, key=lambda s: s.p_best), max(own, key=lambda s: s.p_best_then)
        if before.mode != then.mode:
            said.append(f"{isolated(then.mode)} on {isolated(question)} under {prior}")
    return said


def _lag(found: Refits) -> Section | None:
    excluded = found.lag
    if excluded is None:
        return None
    left, total = len(excluded.comparisons), excluded.total
    heading = "Would laggy comparisons change it?"
    if not left:
        text = f"None of {total:,} comparisons has a guided lap with {excluded.limits.sentence}."
        return Section(heading, (), "", "", None, words=(text,))
    text = (
        f"{left:,} of {total:,} comparisons have a guided lap with {excluded.limits.sentence}. This report "
        "keeps them. "
    )
    if not excluded.changes:
        return Section(heading, (), "", "", None, words=(text + "Without them nothing would be left.",))
    lost = [c.question for c in excluded.changes if isnan(c.worth_without) and not isnan(c.worth_with)]
    if lost:
        names = listed([isolated(name) for name in dict.fromkeys(lost)])
        text += f"Without them there is no ranking for {names}, left blank. {_NOT_USED} "
    text += "Worth and chance to rank first, with them and without:"
    return Section(heading, (), "", "", changes_table(excluded.changes, "lag.csv"), words=(text,))
