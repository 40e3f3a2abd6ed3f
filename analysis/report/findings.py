"""What the answers settle, question by question, and the paragraph that says it in plain words."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from analysis.claims import Claim, joint_sentence
from analysis.equality_reach import EqualityReach
from analysis.figures.labels import LIKELY, isolated, percent_in_words
from analysis.results import Fit, QuestionFit
from analysis.stuck import StuckRate

FIRSTS = "What the answers settle"
_MOST_NAMED = 6
_TOGETHER = 0.94
"""Chance that the modes which are named as an open question's possible firsts hold the place together."""
_MOST_STUCK_NAMED = 3

Reading = Literal["likely", "open", "not ranked"]


@dataclass(frozen=True)
class Finding:
    """The first place on one question.

    Attributes
    ----------
    first : str
        The mode most often first in the posterior; empty if the question is not ranked.
    chance : float
        Its chance to rank first.
    rival : str
        The mode it is least surely above.
    above_rival : float
    ties : float
        Share of ties among all answers to the question; nan if its scale has none.
    label : str
        What the question is called in a sentence: its short form, unless others share it.
    """

    question: QuestionFit
    first: str
    chance: float
    rival: str
    above_rival: float
    ties: float
    reading: Reading
    label: str

    @property
    def worth(self) -> str:
        """Worth of the first mode with its 94 % interval, as the page prints it; empty if not ranked."""
        for m in self.question.modes:
            if m.mode == self.first:
                return f"{m.worth_mean:.2f} ({m.worth_hdi_low:.2f} to {m.worth_hdi_high:.2f})"
        return ""


@dataclass(frozen=True)
class Phrase:
    """A run of words; strong ones are printed semibold."""

    text: str
    strong: bool = False


def findings(fit: Fit) -> tuple[Finding, ...]:
    """One finding a question, in the order of the fit."""
    shorts = [q.question.short for q in fit.questions]
    labels = [
        isolated(
            q.question.short if q.question.short and shorts.count(q.question.short) == 1 else q.question.name
        )
        for q in fit.questions
    ]
    return tuple(_finding(question, label) for question, label in zip(fit.questions, labels, strict=True))


def first_claims(found: Sequence[Finding]) -> tuple[Claim, ...]:
    """The first places that are called likely."""
    return tuple(
        Claim(FIRSTS, f"{isolated(f.first)} ranks first for {f.label}.", f.chance, f.question.question.name)
        for f in found
        if f.reading == "likely"
    )


def first_sentence(found: Sequence[Finding]) -> str:
    """What the likely first places are worth together; empty if there are none."""
    return joint_sentence(first_claims(found), "named first", "named firsts")


def chances_above(question: QuestionFit, mode: str) -> dict[str, float]:
    """Posterior probability that one mode ranks above each of the others."""
    ahead = {p.mode_j: p.p_i_above_j for p in question.pairs if p.mode_i == mode}
    behind = {p.mode_i: 1 - p.p_i_above_j for p in question.pairs if p.mode_j == mode}
    return ahead | behind


def _finding(question: QuestionFit, label: str) -> Finding:
    answers = sum(p.n for p in question.pairs)
    tied = sum(p.ties for p in question.pairs)
    ties = tied / answers if answers and question.question.levels % 2 else float("nan")
    if not question.ranked:
        return Finding(question, "", float("nan"), "", float("nan"), ties, "not ranked", label)
    first = max(question.modes, key=lambda m: m.p_best)
    above = chances_above(question, first.mode)
    rival = min(above, key=lambda other: above[other])
    reading: Reading = "likely" if first.p_best >= LIKELY else "open"
    return Finding(question, first.mode, first.p_best, rival, above[rival], ties, reading, label)


def lead(
    found: Sequence[Finding],
    stuck: Sequence[StuckRate],
    tag: str,
    unanswered: Sequence[str] = (),
    stuck_difference: str | None = None,
    equality: EqualityReach | None = None,
) -> tuple[Phrase, ...]:
    """The first paragraph of the report, careful and plain.

    Parameters
    ----------
    tag : str
        ``simulated data``, ``partly simulated data`` or nothing.
    unanswered : sequence of str
        Questions of the study that nobody answered.
    stuck_difference : str or None
        The surest difference of two stuck rates in people in general; empty if none is likely, None if rates
        were not compared.
    equality : EqualityReach or None
        What the study could show of equal modes, where that is known.
    """
    likely = [f for f in found if f.reading == "likely"]
    still_open = [f for f in found if f.reading == "open"]
    phrases: list[Phrase] = []
    if tag:
        what = "Some of these" if tag.startswith("partly") else "These"
        say = "cannot tell what people prefer" if tag.startswith("partly") else "say nothing about people"
        phrases.append(Phrase(f"{what} answers were simulated, so they {say}. "))
    elif found and max(f.question.n_participants for f in found) == 1:
        phrases.append(Phrase("All answers are one participant's: they tell little about other people. "))
    joint = [Phrase(f"{first_sentence(found)} ")] if likely else []
    if len(found) == 1:
        phrases += [*_one_question(found[0]), *joint]
    elif likely or still_open:
        phrases += [
            Phrase(_opening(found, likely, bool(unanswered)) + " "),
            *_likely_ones(likely),
            *joint,
            *_open_ones(still_open, likely),
        ]
    if still_open and equality is not None and equality.is_too_small:
        phrases.append(Phrase(f"{equality.about_open} "))
    if len(found) > 1:
        phrases += _unranked_ones([f for f in found if f.reading == "not ranked"], len(found))
    if unanswered:
        names = listed([f"“{isolated(name)}”" for name in unanswered])
        phrases.append(Phrase(f"Nobody answered {names}. "))
    if stuck:
        phrases.append(Phrase(_stuck_sentence(stuck, stuck_difference, tag)))
    return tuple(phrases)


def listed(parts: Sequence[str]) -> str:
    """``a, b and c``."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def _one_question(found: Finding) -> list[Phrase]:
    if found.reading == "not ranked":
        return [Phrase(f"{_no_ranking([found])}. ", True), Phrase(f"{found.question.reason} ")]
    first, rival = isolated(found.first), isolated(found.rival)
    above = percent_in_words(found.above_rival)
    if found.reading == "likely":
        opening = Phrase(f"{first} likely ranks first for “{found.label}”", True)
        if len(found.question.modes) == 2:
            # To rank first and to be above the only other mode are one chance.
            return [opening, Phrase(f" (a chance of {percent_in_words(found.chance)}), above {rival}. ")]
        return [
            opening,
            Phrase(f" (a chance of {percent_in_words(found.chance)}). Its closest rival is {rival}: "),
            Phrase(f"the chance that {first} is really above it is {above}. "),
        ]
    return [
        Phrase(f"The answers don't settle which mode ranks first for “{found.label}”. ", True),
        Phrase(
            f"{first} comes first most often (a chance of {percent_in_words(found.chance)}), and is above "
            f"{rival} "
        ),
        Phrase(f"with a chance of {above}: more answers could change the order. "),
    ]


def _opening(found: Sequence[Finding], likely: Sequence[Finding], some_unanswered: bool) -> str:
    winners = {f.first for f in likely}
    if not likely:
        return "The answers don't settle a first place on any question yet."
    if len(winners) > 1:
        return "No mode comes first on every question."
    if len(likely) == len(found):
        return f"One mode is likely first on every question{' that was answered' if some_unanswered else ''}."
    if any(f.reading == "open" for f in found):
        return "Some questions have a likely first place, others are open."
    return "Every question that could be ranked has a likely first place."


def _likely_ones(likely: Sequence[Finding]) -> list[Phrase]:
    phrases: list[Phrase] = []
    by_mode: dict[str, list[Finding]] = {}
    for f in sorted(likely, key=lambda f: -f.chance)[:_MOST_NAMED]:
        by_mode.setdefault(f.first, []).append(f)
    for k, (mode, group) in enumerate(by_mode.items()):
        if k:
            phrases.append(Phrase("; "))
        verb = "likely ranks first for " if k == 0 else "for "
        for g, f in enumerate(group):
            joint = "" if g == 0 else " and " if g == len(group) - 1 else ", "
            if joint:
                phrases.append(Phrase(joint))
            name = f"{isolated(mode)} {verb}" if g == 0 else ""
            phrases.append(Phrase(f"{name}“{f.label}”", True))
            named = "a chance of " if k == g == 0 else ""
            phrases.append(Phrase(f" ({named}{percent_in_words(f.chance)}{_not_good(f)})"))
    if len(likely) > _MOST_NAMED:
        phrases.append(Phrase(f"; {len(likely) - _MOST_NAMED} more are in the table below"))
    if likely:
        phrases.append(Phrase(". "))
    return phrases


def _not_good(found: Finding) -> str:
    return ", which isn't better" if found.question.question.polarity == "lower_is_better" else ""


def _open_ones(still_open: Sequence[Finding], likely: Sequence[Finding]) -> list[Phrase]:
    if not still_open:
        return []
    if len(still_open) > _MOST_NAMED:
        where = f"On {len(still_open)} questions"
    else:
        where = f"For {listed([f'“{f.label}”' for f in still_open])}"
    still = "the first place is open" if likely else "more than one mode could be first"
    phrases = [Phrase(f"{where} {still}: more answers could change it. ")]
    if len(still_open) <= 2:
        phrases += [Phrase(text) for f in still_open if (text := _contenders(f))]
    return phrases


def _contenders(found: Finding) -> str:
    """The modes that may be first, where there are many more that hardly can."""
    ordered = sorted(found.question.modes, key=lambda m: -m.p_best)
    together, named = 0.0, []
    for m in ordered:
        named.append(isolated(m.mode))
        together += m.p_best
        if together >= _TOGETHER:
            break
    if len(named) > _MOST_NAMED or len(ordered) < 2 * len(named):
        return ""
    one = f"{', '.join(named[:-1])} or {named[-1]}" if len(named) > 1 else named[0]
    return f"On “{found.label}” it is {one} with a chance of {percent_in_words(together)}. "


def _unranked_ones(unranked: Sequence[Finding], total: int) -> list[Phrase]:
    if not unranked:
        return []
    if len(unranked) == total:
        return [
            Phrase(f"{_no_ranking(unranked)} on any question. ", True),
            Phrase(f"{unranked[0].question.reason} "),
        ]
    names = listed([f"“{f.label}”" for f in unranked[:_MOST_NAMED]])
    more = f" and {len(unranked) - _MOST_NAMED} more" if len(unranked) > _MOST_NAMED else ""
    return [Phrase(f"There is no ranking for {names}{more}; the reason stands below. ")]


def _no_ranking(unranked: Sequence[Finding]) -> str:
    """What failed: the answers, or the sampler."""
    if any(f.question.draws is not None for f in unranked):
        return "The modes are not ranked"
    return "The answers cannot rank the modes"


def _more_modes(n: int) -> str:
    return "1 more mode" if n == 1 else f"{n} more modes"


def _stuck_sentence(stuck: Sequence[StuckRate], difference: str | None, tag: str) -> str:
    """Counts of these people's comparisons, then what is likely of people in general."""
    some = sorted((r for r in stuck if r.stuck), key=lambda r: -r.stuck / r.comparisons)
    none = [r for r in stuck if not r.stuck]
    if not some:
        least, most = (f(r.comparisons for r in stuck) for f in (min, max))
        shown = f"{most:,}" if least == most else f"{least:,} to {most:,}"
        return f"The robot never got stuck, in {shown} comparisons with each mode."
    named = some[:_MOST_STUCK_NAMED]
    parts = [f"in {r.stuck} of {r.comparisons} with {isolated(r.mode)}{_people_stuck(r)}" for r in named]
    parts[0] = parts[0].replace(" with ", " comparisons with ", 1)
    if len(some) > _MOST_STUCK_NAMED:
        parts.append(f"at no higher rate with {_more_modes(len(some) - _MOST_STUCK_NAMED)}")
    if none:
        names = [isolated(r.mode) for r in none]
        parts.append(f"in none with {listed(names) if len(names) <= _MOST_NAMED else f'{len(names)} modes'}")
    counts = f"The robot got stuck {listed(parts)}."
    if difference is None:
        return counts
    general = difference or "no difference between two modes' rates is likely"
    simulated = "simulated " if tag and not tag.startswith("partly") else ""
    return f"{counts} That is of these comparisons; in {simulated}people in general {general}."


def _people_stuck(rate: StuckRate) -> str:
    if not rate.participants:
        return ""
    return f" ({rate.participants_stuck} of {rate.participants} people)"
