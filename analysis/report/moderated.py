"""The report's section on people's background: do those who said different things prefer different modes?"""

from analysis.figures.labels import isolated, one_line, percent, percent_in_words
from analysis.figures.moderation import draw_moderation
from analysis.moderation import FEWEST_PEOPLE, GroupDifference, Moderation
from analysis.report.page import Section, Table
from analysis.results import HDI_PROBABILITY, Fit

_MOST_SAID = 4


def moderation_section(found: Moderation, fit: Fit, tag: str) -> Section:
    """Differences of worth between groups, or why there are none."""
    heading = "Does it depend on who is asked?"
    if not found.differences:
        said = "People with another background are not compared. " + " ".join(map(isolated, found.reasons))
        return Section(heading, (), "", "", None, words=(said.strip(),))
    words = [_groups(found.differences), _said(found.differences)]
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


def _groups(found: tuple[GroupDifference, ...]) -> str:
    said = []
    for name in dict.fromkeys(d.background for d in found):
        own = [d for d in found if d.background == name]
        first, second = (max(getattr(d, f"people_{which}") for d in own) for which in ("first", "second"))
        said.append(f"{isolated(name)}: {own[0].first} ({first} people) and {own[0].second} ({second})")
    return (
        "What people said about themselves parts them into two groups, cut where the smaller one is "
        f"largest, before anyone looks at their preferences; each needs at least {FEWEST_PEOPLE} people, "
        f"and is fitted by itself, with nothing shared. {'; '.join(said)}."
    )


def _said(found: tuple[GroupDifference, ...]) -> str:
    clear = sorted((d for d in found if d.is_clear), key=lambda d: -abs(d.difference_mean))
    by_chance = (1 - HDI_PROBABILITY) * len(found)
    if clear:
        parts = [
            f"{isolated(d.mode)} on {isolated(d.question)} has "
            f"{'more' if d.difference_mean > 0 else 'less'} worth among {isolated(d.second)} than among "
            f"{isolated(d.first)} ({d.worth_second:.2f} against {d.worth_first:.2f}; the chance that the "
            f"sign is right is {percent_in_words(max(d.p_positive, 1 - d.p_positive))})"
            for d in clear[:_MOST_SAID]
        ]
        more = f" and {len(clear) - _MOST_SAID} more" if len(clear) > _MOST_SAID else ""
        said = f"{len(clear):,} of {len(found):,} differences leave out 0: {'; '.join(parts)}{more}."
    else:
        widest = max(max(abs(d.difference_hdi_low), abs(d.difference_hdi_high)) for d in found)
        said = (
            f"None of {len(found):,} differences is told apart from 0. That is not to say that the groups "
            f"agree: differences of up to {widest:.2f} in worth are still possible."
        )
    return (
        f"{said} So many intervals are looked at that up to about {max(1.0, by_chance):.0f} would leave out "
        "0 if nobody differed. Nobody was put into a group: a difference goes with what people said, and "
        "need not come from it."
    )
