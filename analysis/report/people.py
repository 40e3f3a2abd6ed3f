"""The report's sections on participants: is it one order for all, and do they agree with themselves?"""

from collections.abc import Sequence
from math import isnan

from analysis.closer_look import CloserLook
from analysis.consistency import CIRCULAR_BY_CHANCE, Consistency
from analysis.figures.labels import isolated, one_line, p_value, percent, percent_in_words
from analysis.figures.own_modes import draw_by_modes
from analysis.figures.persons import MOST_INTERVALS, MOST_MODES, draw_persons
from analysis.persons import MOST_PEOPLE, Agreement
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_MOST_SAID = 6
_OTHERS = 3
"""Modes beside the group's first that the table names."""


def agreement_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Is there one first mode for all?"""
    known = [a for a in look.agreements if a.people]
    reasons = list(dict.fromkeys(a.reason for a in look.agreements if a.reason and not a.people))
    heading = "Is it one order for all?"
    if not known:
        why = [r for r in reasons if r != "The question is not ranked."]
        why += _someone_new(look.agreements)
        return Section(heading, (), "", "", None, words=tuple(why)) if why else None
    people = len({p.participant for a in known for p in a.people})
    rows = tuple(
        (
            one_line(a.question),
            one_line(a.first),
            f"{percent(a.share_mean)} %",
            *((f"{percent(a.share_hdi_low)} to {percent(a.share_hdi_high)} %",) if people > 1 else ()),
            _other_firsts(a),
            f"{percent(a.new_person)} %",
        )
        for a in known
    )
    own = ("Own first too", "94 % interval") if people > 1 else ("Chance of own first",)
    columns = ("Question", "First of the group", *own, "Others", "Someone new")
    table = Table(columns, (False, False, *([True] * (len(columns) - 2))), rows, "agreement.csv")
    shown = [q for q, a in zip(fit.questions, look.agreements, strict=True) if a.people]
    of = {a.question: a for a in known}
    drawings = draw_by_modes(
        shown, lambda some, modes: draw_persons(some, [of[q.question.name] for q in some], modes, tag)
    )
    words = _one_person(known) if people == 1 else _shares_of_people(known, people)
    dots = (
        "the participant's own"
        if people == 1
        else "a dot for each participant, always in the same order"
        if people <= MOST_PEOPLE
        else "a dot for each participant, from the lowest worth to the highest"
    )
    each = " of each" if people > 1 else ""
    below = (
        "the chance that the group's first is this participant's own first"
        if people == 1
        else "the expected share of these participants whose own first is the group's"
    )
    caption = (
        "Worth of each mode: on the left of each column the group's with its 94 % credible interval, beside "
        f"it {dots}"
        + (f", with the 94 % interval{each}. " if people <= MOST_INTERVALS else ". ")
        + f"Dotted is no preference. Below: {below}. In the numbers, “others” are "
        + ("the next most likely firsts." if people == 1 else "the modes that most of the others have first.")
    )
    n_modes = max(len(q.mode_names) for q in shown)
    if n_modes > MOST_MODES:
        caption += f" Of {n_modes} modes the {MOST_MODES} with the highest worth are drawn."
    return Section(heading, drawings, "", caption, table, words=(words,))


def _other_firsts(found: Agreement) -> str:
    """The modes that most other people have first, with the expected share of each."""
    total: dict[str, float] = {}
    for p in found.people:
        total[p.mode] = total.get(p.mode, 0.0) + p.p_first
    people = len({p.participant for p in found.people})
    others = sorted((-n / people, mode) for mode, n in total.items() if mode != found.first)
    return ", ".join(f"{one_line(mode)} {percent(-n)} %" for n, mode in others[:_OTHERS])


def _someone_new(found: Sequence[Agreement]) -> list[str]:
    """What is known of people in general where single participants' own worths are not worked out."""
    said = [
        f"{isolated(a.first)} on {isolated(a.question)} {percent_in_words(a.new_person)}"
        for a in found
        if not isnan(a.new_person)
    ]
    if not said:
        return []
    more = f"; {len(said) - _MOST_SAID} more are in agreement.csv" if len(said) > _MOST_SAID else ""
    return [
        "The chance that the group's first mode is the own first of someone new: "
        f"{'; '.join(said[:_MOST_SAID])}{more}."
    ]


def _shares_of_people(known: Sequence[Agreement], people: int) -> str:
    said = [
        f"{isolated(a.first)} on {isolated(a.question)} {percent_in_words(a.share_mean)} "
        f"({percent(a.share_hdi_low)} to {percent(a.share_hdi_high)} %)"
        for a in known[:_MOST_SAID]
    ]
    more = f"; {len(known) - _MOST_SAID} more questions are in the table" if len(known) > _MOST_SAID else ""
    return (
        "Each participant has an order of their own, which leans on the group's where that person's answers "
        f"are few. The share of these {people:,} participants whose own first mode is the group's, with its "
        f"94 % credible interval: {'; '.join(said)}{more}."
    )


def _one_person(known: Sequence[Agreement]) -> str:
    said = [
        f"{isolated(a.first)} on {isolated(a.question)} {percent_in_words(a.share_mean)}"
        for a in known[:_MOST_SAID]
    ]
    return (
        "One participant tells next to nothing about how much people differ, so that this rests on the "
        f"prior. The chance that the group's first mode is this participant's own first: {'; '.join(said)}."
    )


def consistency_section(look: CloserLook) -> Section | None:
    """Do people agree with themselves, and with each other?"""
    together = [c for c in look.consistencies if c.participant == "all"]
    if not together:
        return None
    people = len({c.participant for c in look.consistencies}) - 1
    triads, circular = sum(c.triads for c in together), sum(c.circular for c in together)
    repeated = sum(c.repeated for c in together)
    words = []
    if triads:
        words.append(
            "A triad is three modes whose pairs a person has all decided; it is circular if the first is "
            f"over the second, the second over the third and the third over the first. {circular:,} of "
            f"{triads:,} triads are; coin tosses would make {percent(CIRCULAR_BY_CHANCE)} % so."
        )
    if repeated:
        same, turned = sum(c.same for c in together), sum(c.reversed for c in together)
        chance = sum(c.same_by_chance * c.repeated for c in together if c.repeated) / repeated
        words.append(
            f"Asked again about a pair, {'people' if people > 1 else 'the participant'} said the same in "
            f"{same:,} of {repeated:,} cases ({percent(same / repeated)} %; by chance, given how often each "
            f"answer was given to the pair, it would be {percent(chance)} %) and the opposite in {turned:,}."
            + (
                " Retest r correlates an answer with the one before on the same pair, within pairs: where "
                "everybody prefers one mode of a pair, that alone does not make r large."
                if any(not isnan(c.retest) for c in together)
                else ""
            )
        )
    if any(not isnan(c.u) for c in together):
        words.append(
            "Kendall's u says how far people agree with each other: 1 if all do on every pair, about 0 or "
            "below if they toss coins; p is the exact chance that people tossing coins agree as much."
        )
    unsteady = _unsteady(look.consistencies)
    if unsteady:
        names = listed([isolated(name) for name in unsteady[:_MOST_SAID]])
        words.append(
            f"More opposite than equal answers to repeated pairs: {names}. Nobody is left out for it."
        )
    rows = tuple(
        (
            one_line(c.question),
            f"{c.circular:,} of {c.triads:,}" if c.triads else "",
            _number(c.zeta),
            f"{c.same:,} of {c.repeated:,}" if c.repeated else "",
            f"{c.reversed:,}" if c.repeated else "",
            _number(c.retest),
            _number(c.u),
            p_value(c.u_p),
        )
        for c in together
    )
    columns = ("Question", "Circular", "Zeta", "Same again", "Opposite", "Retest r", "Kendall's u", "p")
    table = Table(columns, (False, *([True] * 7)), rows, "consistency.csv").filled
    if not words:
        return None
    return Section("Do people agree with themselves?", (), "", "", table, words=tuple(words))


def _unsteady(found: Sequence[Consistency]) -> list[str]:
    """Participants who more often said the opposite than the same, over all questions."""
    tally: dict[str, list[int]] = {}
    for c in found:
        if c.participant != "all":
            counted = tally.setdefault(c.participant, [0, 0])
            counted[0] += c.same
            counted[1] += c.reversed
    return [who for who, (same, turned) in tally.items() if turned > same]


def _number(value: float) -> str:
    return "" if isnan(value) else f"{value:.2f}".replace("-", "\u2212")
