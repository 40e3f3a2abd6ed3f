"""The report's section on people who answer in a line, and what it means for who quotes the report."""

from math import isnan

from analysis.figures.labels import isolated, one_line
from analysis.lag import LagChange
from analysis.report.changes import changes_table
from analysis.report.findings import listed
from analysis.report.page import Section
from analysis.straight_lining import BY_CHANCE, FASTEST_S, Line, StraightLining

HEADING = "People who answer in a line"
_MOST_NAMED = 6


def straight_section(found: StraightLining) -> Section | None:
    """Who answers in a line, and the ranking without them."""
    if not found.lines:
        return None
    named = "; ".join(f"{isolated(line.participant)} {_what(line)}" for line in found.lines[:_MOST_NAMED])
    more = f"; and {len(found.lines) - _MOST_NAMED:,} more" if len(found.lines) > _MOST_NAMED else ""
    words = [
        f"{named}{more}. People whom the model describes would hardly do so: it happens by chance, to "
        f"anybody of all participants, in fewer than {100 * BY_CHANCE:g} % of studies"
        + (f"; for answers in less than {FASTEST_S:g} second a question no chance is worked out" if any(
            line.kind == "fast" for line in found.lines) else "")
        + ". That does not prove that somebody was careless: an honest person may find everything equal. "
        "Nobody is left out for it; the complete list is in careless.csv.",
    ]  # fmt: skip
    if found.changes:
        words.append(_changed(found) + " Worth and chance to rank first, with and without:")
        table = changes_table(found.changes, "careless_left_out.csv")
    else:
        words.append("Without them nobody would be left.")
        table = None
    return Section(HEADING, (), "", "", table, words=tuple(words))


def about_lines(found: StraightLining) -> list[str]:
    """A sentence that names them and says what the ranking is without them."""
    if not found.lines:
        return []
    people = found.participants
    names = [isolated(name) for name in people[:_MOST_NAMED]]
    more = f" and {len(people) - _MOST_NAMED:,} more" if len(people) > _MOST_NAMED else ""
    named = ", ".join(names) + more if more else listed(names)
    verb = "answers" if len(people) == 1 else "answer"
    first = found.lines[0]
    what = f" ({isolated(first.participant)} {_what(first)})" if len(people) > 1 else f": {_what(first)}"
    without = _changed(found) if found.changes else "Without them nobody would be left."
    return [f"{named} {verb} in a line{what}. {without} See “{HEADING}”."]


def _what(line: Line) -> str:
    if line.kind == "fast":
        return (
            f"took {line.seconds:.1f} s a question, less than {FASTEST_S:g} s in {line.answers:,} of "
            f"{line.of:,} comparisons"
        )
    if line.kind == "run":
        return f"gave one answer {line.answers:,} times running to {isolated(line.question)}"
    whole = {
        "all A": "chose what was shown as A",
        "all B": "chose what was shown as B",
        "all much": "gave the strongest answer",
        "all equal": "said “about the same”",
    }[line.kind]
    return f"{whole} in all of {line.of:,} answers"


def _changed(found: StraightLining) -> str:
    """Where another mode comes first without them."""
    changes = found.changes
    without = "Without this person" if len(found.participants) == 1 else "Without these people"
    by_question: dict[str, list[LagChange]] = {}
    for change in changes:
        by_question.setdefault(change.question, []).append(change)
    lost, other = [], []
    for question, own in by_question.items():
        before = [c for c in own if not isnan(c.p_best_with)]
        after = [c for c in own if not isnan(c.p_best_without)]
        if before and not after:
            lost.append(isolated(question))
        elif before and after:
            first, then = max(before, key=lambda c: c.p_best_with), max(after, key=lambda c: c.p_best_without)
            if first.mode != then.mode:
                other.append(f"{one_line(then.mode)} on {isolated(question)}")
    said = []
    if other:
        said.append(f"{without} another mode comes first: {listed(other)}.")
    if lost:
        said.append(f"{without} there is no ranking for {listed(lost)}.")
    known = [c for c in changes if not isnan(c.worth_with) and not isnan(c.worth_without)]
    if not said and known:
        most = max(known, key=lambda c: abs(c.worth_without - c.worth_with))
        same = "the same mode comes" if len(by_question) == 1 else "the same modes come"
        said.append(
            f"{without} {same} first; the largest change of a worth is that of "
            f"{one_line(most.mode)} on {isolated(most.question)}, from {most.worth_with:.3f} to "
            f"{most.worth_without:.3f}."
        )
    return " ".join(said)
