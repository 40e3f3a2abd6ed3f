"""The report's sections on pairs of modes: which differences matter, and how strong preferences are."""

from collections.abc import Sequence
from math import isnan

from analysis.closer_look import CloserLook
from analysis.equivalence import EQUIVALENT_BELOW, EQUIVALENT_CHANCE
from analysis.figures.equivalence import draw_equivalence
from analysis.figures.labels import isolated, percent, percent_in_words, shortened
from analysis.figures.style import Drawing
from analysis.report.claims import difference_sentence
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Fit
from analysis.strength import Strength

_DRAWN_UP_TO = 8
_MOST_SAID = 6
_CELL = 40
"""Characters of a name in a table of pairs; the CSV files have them all."""


def equivalence_section(look: CloserLook, fit: Fit, tag: str) -> Section | None:
    """Which modes differ, which are equal in practice, and which are open."""
    if not look.equivalences:
        return None
    equal = [e for e in look.equivalences if e.reading == "equal in practice"]
    words = [
        "Two modes count as equal in practice where neither would be chosen over the other more than "
        f"{100 * EQUIVALENT_CHANCE:.0f} times in 100 if one had to choose: abilities at most "
        f"{EQUIVALENT_BELOW:.2f} apart. Not to know which of two is higher is not the same as to know that "
        "they are equal: with few answers a pair is often neither, and stays open."
    ]
    if equal:
        pairs = [
            f"{isolated(e.mode_i)} and {isolated(e.mode_j)} ({isolated(e.question)})"
            for e in equal[:_MOST_SAID]
        ]
        more = f" and {len(equal) - _MOST_SAID:,} more" if len(equal) > _MOST_SAID else ""
        shown = ", ".join(pairs) if more else listed(pairs)
        words.append(f"Likely equal in practice: {shown}{more}.")
    else:
        words.append("No pair is likely equal in practice.")
    n = len(look.equivalences)
    counted = [sum(e.reading == r for e in look.equivalences) for r in ("different", "open")]
    if n == 1 and not equal:
        words[-1] = (
            "The two modes are likely different."
            if counted[0]
            else "Whether the two modes are different or equal in practice is open."
        )
    elif n > 1:
        several = len({e.question for e in look.equivalences}) > 1
        whole = "Over all questions, " if several else "Of all pairs, "
        words[-1] += f" {whole}{counted[0]:,} of {n:,} are likely different and {counted[1]:,} open."
    if joint := difference_sentence(look.equivalences):
        words[-1] += f" {joint}"
    if counted[1] and look.equality is not None and look.equality.is_too_small:
        words.append(look.equality.sentence)
    rows = tuple(
        (
            shortened(e.question, _CELL),
            shortened(e.mode_i, _CELL),
            shortened(e.mode_j, _CELL),
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
        "Differences of abilities [logit] with 94 % credible intervals, turned so that the mean is not "
        "negative. The grey band is practical equality. Filled dots are likely different (a chance of 80 %), "
        "grey squares likely equal, hollow dots open. On the right the chance, in per cent, that the pair is "
        "equal in practice. In the numbers a mode is above another where it leads by more than that."
    )
    return Section("Which differences matter", drawings, "", caption, table, words=tuple(words))


def strength_section(look: CloserLook) -> Section | None:
    """How often people said "much"."""
    if not look.strengths:
        return None
    rows = tuple(
        (
            shortened(s.question, _CELL),
            shortened(s.mode_i, _CELL),
            shortened(s.mode_j, _CELL),
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
        "Question", "Mode i", "Mode j", "Answers", "Much i", "Much j", "Strong", "New: much i", "New: much j",
    )  # fmt: skip
    strongest = _strongest(look.strengths)
    has_longer = any(len(pair.counts) > 5 for pairs in look.shares for pair in pairs)
    words = (_strong_answers(look.strengths, bool(strongest), has_longer), *strongest)
    table = Table(columns, (False, False, False, *([True] * 6)), rows, "strength.csv").filled
    return Section("Strength of preference", (), "", "", table, words=words)


def _strong_answers(found: Sequence[Strength], is_expected: bool, has_longer: bool) -> str:
    said = []
    longer = (
        "; every arrow longer than one sign (A>>B, A>>>B and so on) counts as “much”" if has_longer else ""
    )
    for name in list(dict.fromkeys(s.question for s in found))[:_MOST_SAID]:
        own = [s for s in found if s.question == name]
        much, n = sum(s.much_i + s.much_j for s in own), sum(s.n for s in own)
        said.append(f"{much:,} of {n:,} on {isolated(name)}")
    return (
        f"Scales of four levels and more keep “much more” apart from “more”{longer}. “Much” was said in "
        f"{listed(said)}. In "
        "the table, “strong” is the share of “much” among the answers that preferred either mode"
        + (
            ", and “new” the chance that someone new says “much” for a mode, with its 94 % credible interval."
            if is_expected
            else "."
        )
    )


def _strongest(found: Sequence[Strength]) -> tuple[str, ...]:
    """The pair for which "much" is most to be expected."""
    known = [
        option
        for s in found
        if not isnan(s.p_much_i)
        for option in (
            (s.p_much_i, s.p_much_i_low, s.p_much_i_high, s.mode_i, s.mode_j, s.question),
            (s.p_much_j, s.p_much_j_low, s.p_much_j_high, s.mode_j, s.mode_i, s.question),
        )
    ]
    if not known:
        return ()
    p, low, high, mode, other, question = max(known)
    return (
        f"“Much” is most to be expected for {isolated(mode)} over {isolated(other)} on {isolated(question)}: "
        f"the estimated chance that someone new says it is {percent_in_words(p)} ({percent(low)} to "
        f"{percent(high)} %).",
    )


def _share(value: float) -> str:
    return "" if isnan(value) else f"{100 * value:.0f} %"


def _chance(mean: float, low: float, high: float) -> str:
    return "" if isnan(mean) else f"{percent(mean)} % ({percent(low)} to {percent(high)})"
