"""The report's section on people's background: do those who said different things prefer different modes?"""

from analysis.claims import joint_sentence
from analysis.figures.labels import isolated, one_line, percent
from analysis.figures.moderation import draw_moderation
from analysis.moderation import FEWEST_PEOPLE, GroupDifference, Moderation
from analysis.report.claims import group_claims
from analysis.report.page import Section, Table
from analysis.results import HDI_PROBABILITY, Fit

_MOST_SAID = 4


def moderation_section(found: Moderation, fit: Fit, tag: str) -> Section:
    """Differences of worth between groups, or why there are none."""
    heading = "Does it depend on who is asked?"
    if not found.differences:
        said = "Groups of people are not compared. " + " ".join(map(isolated, found.reasons))
        return Section(heading, (), "", "", None, words=(said.strip(),))
    asked = max(q.n_participants for q in fit.questions)
    words = [_groups(found.differences, asked), *_said(found.differences)]
    if found.reasons:
        words.append(f"Not compared: {' '.join(map(isolated, found.reasons))}")
    rows = tuple(
        (
            one_line(d.background),
            one_line(d.question),
            one_line(d.mode),
            f"{d.worth_first:.2f}",
            f"{d.worth_second:.2f}",
            f"{d.difference_mean:+.2f} ({d.difference_hdi_low:+.2f} to {d.difference_hdi_high:+.2f})".replace(
                "-", "\u2212"
            ),
            f"{percent(d.p_positive)} %",
        )
        for d in found.differences
    )
    columns = ("Background", "Question", "Mode", "Worth, first", "Second", "Difference", "Above 0")
    table = Table(columns, (False, False, False, *([True] * 4)), rows, "groups.csv")
    caption = (
        "Worth of each mode in the second group of people less that in the first, with 94 % credible "
        "intervals. Filled: the interval leaves out 0."
    )
    drawings = draw_moderation([q.question for q in fit.questions], found.differences, fit.modes, tag)
    return Section(heading, drawings, "", caption, table, words=tuple(words))


def _groups(found: tuple[GroupDifference, ...], asked: int) -> str:
    said = []
    for name in dict.fromkeys(d.background for d in found):
        own = [d for d in found if d.background == name]
        first, second = (max(getattr(d, f"people_{which}") for d in own) for which in ("first", "second"))
        silent = asked - first - second
        said.append(
            f"{isolated(name)} (“{isolated(own[0].wording)}”): {isolated(own[0].first)} ({first} people) and "
            f"{isolated(own[0].second)} ({second})" + (f"; {silent} did not say" if silent else "")
        )
    return (
        "What people said about themselves parts them into two groups, cut where the smaller one is "
        f"largest, before anyone looks at their preferences; each needs at least {FEWEST_PEOPLE} people, "
        f"and is fitted by itself, with nothing shared. {'. '.join(said)}."
    )


def _said(found: tuple[GroupDifference, ...]) -> list[str]:
    clear = sorted((d for d in found if d.is_clear), key=lambda d: -abs(d.difference_mean))
    by_chance = (1 - HDI_PROBABILITY) * len(found)
    if clear:
        parts = [
            f"{isolated(d.mode)} on {isolated(d.question)} with {d.worth_first:.2f} among "
            f"{isolated(d.first)} and {d.worth_second:.2f} among {isolated(d.second)}"
            for d in clear[:_MOST_SAID]
        ]
        leave = "leaves" if len(clear) == 1 else "leave"
        said = (
            f"{len(clear):,} of {len(found):,} differences of worth {leave} out 0"
            f"{', the largest first' if len(clear) > 1 else ''}: {'; '.join(parts)}"
            f"{f'; and {len(clear) - _MOST_SAID} more' if len(clear) > _MOST_SAID else ''}."
        )
    else:
        widest = max(max(abs(d.difference_hdi_low), abs(d.difference_hdi_high)) for d in found)
        said = (
            f"None of {len(found):,} differences of worth is told apart from 0. That is not to say that the "
            f"groups agree: differences of up to {widest:.2f} are still possible."
        )
    if joint := joint_sentence(group_claims(Moderation(found)), "difference", "differences"):
        said += f" {joint}"
    return [
        said,
        f"So many intervals are looked at that about {by_chance:.1f} would leave out 0 if "
        "nobody differed; those of one question go together, as its worths add up to 1. Nobody was put into "
        "a group: a difference goes with what people said, and need not come from it.",
    ]
