"""The report's sections on pairs, people and the model: equivalence, strength, agreement, consistency,
checks."""

from collections.abc import Sequence
from math import isnan

from analysis.closer_look import CloserLook
from analysis.consistency import CIRCULAR_BY_CHANCE, Consistency
from analysis.equivalence import EQUIVALENT_BELOW, EQUIVALENT_CHANCE
from analysis.figures.equivalence import draw_equivalence
from analysis.figures.labels import isolated, one_line, percent, percent_in_words
from analysis.figures.persons import MOST_INTERVALS, draw_persons
from analysis.figures.predictive import draw_predictive
from analysis.figures.style import Drawing
from analysis.persons import MOST_PEOPLE, Agreement
from analysis.predictive import UNLIKELY
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit

_DRAWN_UP_TO = 8
_MOST_SAID = 6


def equivalence_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Which modes differ, which are equal in practice, and which are open."""
    if not look.equivalences:
        return None
    equal = [e for e in look.equivalences if e.reading == "equal in practice"]
    words = [
        f"Two modes count as equal in practice where neither would be felt to be the higher more than "
        f"{100 * EQUIVALENT_CHANCE:.0f} times in 100: abilities at most {EQUIVALENT_BELOW:.2f} apart. Not "
        f"to know "
        "which of two is higher is not the same as to know that they are equal: with few answers most pairs "
        "are neither."
    ]
    if equal:
        pairs = [
            f"{isolated(e.mode_i)} and {isolated(e.mode_j)} ({isolated(e.question)})"
            for e in equal[:_MOST_SAID]
        ]
        words.append(f"Likely equal in practice: {listed(pairs)}.")
    else:
        words.append("No pair is likely equal in practice.")
    rows = tuple(
        (
            one_line(e.question),
            one_line(e.mode_i),
            one_line(e.mode_j),
            f"{e.difference_mean:+.2f}".replace("-", "\u2212"),
            f"{e.difference_hdi_low:.2f} to {e.difference_hdi_high:.2f}".replace("-", "\u2212"),
            f"{percent(e.p_i_above)} %",
            f"{percent(e.p_equal)} %",
            f"{percent(e.p_j_above)} %",
            e.reading,
        )
        for e in look.equivalences
    )
    columns = (
        "Question",
        "Mode i",
        "Mode j",
        "Difference",
        "94 % interval",
        "i above",
        "Equal",
        "j above",
        "Reading",
    )
    table = Table(columns, (False, False, False, *([True] * 5), False), rows, "equivalence.csv")
    drawings: tuple[Drawing, ...] = ()
    if len(fit.modes) <= _DRAWN_UP_TO:
        questions = [q.question for q in fit.questions]
        drawings = draw_equivalence(questions, look.equivalences, fit.modes, tag)
    caption = (
        "Differences of abilities [logit] with 94 % intervals, turned so that the mean is not negative. "
        "The grey "
        "band is practical equality; a filled dot: likely different, a grey one: likely equal, a hollow one: "
        "open. On the right the chance, in per cent, that the pair is equal in practice."
    )
    return Section("Which differences matter", drawings, "", caption, table, words=tuple(words))


def strength_section(look: CloserLook) -> Section | None:
    """How often people said "much"."""
    if not look.strengths:
        return None
    rows = tuple(
        (
            one_line(s.question),
            one_line(s.mode_i),
            one_line(s.mode_j),
            f"{s.n:,}",
            f"{s.much_i:,}",
            f"{s.much_j:,}",
            _share(s.strong_share),
            _chance(s.p_much_i, s.p_much_i_low, s.p_much_i_high),
            _chance(s.p_much_j, s.p_much_j_low, s.p_much_j_high),
        )
        for s in look.strengths
    )
    columns = (
        "Question", "Mode i", "Mode j", "Answers", "i much", "j much", "Strong", "Chance i much", "Chance "
        "j much",
    )  # fmt: skip
    words = (
        "On scales of five levels: how many answers said “much”, their share among those that preferred "
        "either "
        "mode (strong), and the chance that someone new says “much” for a mode, with its 94 % interval.",
    )
    table = Table(columns, (False, False, False, *([True] * 6)), rows, "strength.csv")
    return Section("How strongly people prefer", (), "", "", table, words=words)


def agreement_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Is there one first mode for all?"""
    known = [a for a in look.agreements if a.people]
    reasons = list(dict.fromkeys(a.reason for a in look.agreements if a.reason and not a.people))
    if not known:
        why = [r for r in reasons if r != "The question is not ranked."]
        return Section("Is it one order for all?", (), "", "", None, words=tuple(why)) if why else None
    words = [
        "Each participant has an own order, which leans on the group's where the person's answers are few. "
        + " ".join(_agreement_sentence(a) for a in known[:_MOST_SAID])
    ]
    rows = tuple(
        (
            one_line(a.question),
            one_line(a.first),
            f"{percent(a.share_mean)} %",
            f"{percent(a.share_hdi_low)} to {percent(a.share_hdi_high)} %",
            f"{percent(a.new_person)} %",
        )
        for a in known
    )
    columns = ("Question", "First of the group", "Own first too", "94 % interval", "Someone new")
    table = Table(columns, (False, False, True, True, True), rows, "people.csv")
    shown = [q for q, a in zip(fit.questions, look.agreements, strict=True) if a.people]
    people = len({p.participant for a in known for p in a.people})
    drawings = draw_persons(shown, known, fit.modes, tag) if people <= MOST_PEOPLE else ()
    caption = (
        "Worth of each mode: on the left of each column the group's with its 94 % interval, beside it a "
        "dot for each "
        "participant, always in the same order"
        + (", with the 94 % interval of each. " if people <= MOST_INTERVALS else ". ")
        + "Dotted is no preference. Below: the expected share of these participants whose own first is the "
        "group's."
    )
    return Section("Is it one order for all?", drawings, "", caption, table, words=tuple(words))


def _agreement_sentence(a: Agreement) -> str:
    return (
        f"{isolated(a.question)}: about {percent_in_words(a.share_mean)} of the participants have "
        f"{isolated(a.first)} first themselves."
    )


def consistency_section(look: CloserLook) -> Section | None:
    """Do people agree with themselves, and with each other?"""
    together = [c for c in look.consistencies if c.participant == "all"]
    if not together:
        return None
    triads, circular = sum(c.triads for c in together), sum(c.circular for c in together)
    repeated = sum(c.repeated for c in together)
    words = []
    if triads:
        words.append(
            f"{circular:,} of {triads:,} decided triads are circular (A over B over C over A); coin tosses "
            f"would make "
            f"{percent(CIRCULAR_BY_CHANCE)} % so."
        )
    if repeated:
        same, turned = sum(c.same for c in together), sum(c.reversed for c in together)
        chance = sum(c.same_by_chance * c.repeated for c in together if c.repeated) / repeated
        words.append(
            f"Asked again about a pair, people said the same in {same:,} of {repeated:,} cases "
            f"({percent(same / repeated)} %; {percent(chance)} % if their answers did not hang together) "
            f"and the "
            f"opposite in {turned:,}."
        )
    if any(not isnan(c.u) for c in together):
        words.append(
            "Kendall's u says how far people agree with each other: 1 if all do, about 0 if by chance; p "
            "is the share of "
            "sets of people tossing coins that agree as much."
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
            "" if isnan(c.u_p) else f"{c.u_p:.3f}",
        )
        for c in together
    )
    columns = ("Question", "Circular", "Zeta", "Same again", "Opposite", "Retest r", "Kendall's u", "p")
    table = Table(columns, (False, *([True] * 7)), rows, "consistency.csv")
    return Section("Do people agree with themselves?", (), "", "", table, words=tuple(words) or ("",))


def _unsteady(found: Sequence[Consistency]) -> list[str]:
    """Participants who more often said the opposite than the same, over all questions."""
    tally: dict[str, list[int]] = {}
    for c in found:
        if c.participant != "all":
            counted = tally.setdefault(c.participant, [0, 0])
            counted[0] += c.same
            counted[1] += c.reversed
    return [who for who, (same, turned) in tally.items() if turned > same]


def predictive_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Would the model have given such answers?"""
    if not look.checks:
        return None
    far = [c for c in look.checks if c.is_unlikely]
    expected = 2 * UNLIKELY * len(look.checks)
    names = [f"{isolated(c.question)} {isolated(c.what) if c.what else c.kind}" for c in far[:_MOST_SAID]]
    words = [
        f"{len(far)} of {len(look.checks)} checked shares lie where the model puts fewer than "
        f"{percent(UNLIKELY)} in 100 of its predictions on that side; of a model that is right about "
        f"{expected:.0f} at most would."
        + (f" They are: {listed(names)}{' and more' if len(far) > _MOST_SAID else ''}." if far else "")
    ]
    rows = tuple(
        (
            one_line(c.question),
            {"wins": "share for", "ties": "share of ties", "level": "share of", "spread": "people apart"}[
                c.kind
            ],
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
        "same "
        "schedule (grey: central 94 %, line: mean): share of a pair's answers for the first mode, of ties, "
        "of each "
        "answer as shown, and how far people lie apart (root mean square). p is the share of predictions "
        "above "
        f"what was observed; bold and a diamond below {UNLIKELY:g} or above {1 - UNLIKELY:g}."
    )
    drawings = draw_predictive([q.question for q in fit.questions], look.checks, tag)
    return Section("Does the model describe the answers?", drawings, "", caption, table, words=tuple(words))


def _number(value: float) -> str:
    return "" if isnan(value) else f"{value:.2f}".replace("-", "\u2212")


def _share(value: float) -> str:
    return "" if isnan(value) else f"{100 * value:.0f} %"


def _chance(mean: float, low: float, high: float) -> str:
    return "" if isnan(mean) else f"{percent(mean)} % ({percent(low)} to {percent(high)})"
