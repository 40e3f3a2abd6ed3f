"""What a study of this size cannot tell: a likely first among several questions, or after early looks.

Each sentence rests on a quick estimate for the study's own schedule and people; see `analysis.looks`.
"""

from collections.abc import Sequence
from functools import lru_cache

from analysis.figures.labels import LIKELY, percent_in_words
from analysis.looks import LOOKS_GOOD, LookErrors, look_errors
from analysis.observed_design import ObservedDesign, observed_design
from analysis.report.findings import Finding
from analysis.results import Fit
from data.records import Look

_MOST_NAMED = 6


def size_cautions(fit: Fit, found: Sequence[Finding], looks: Sequence[Look], shown: Look) -> list[str]:
    """Sentences for the list "Before you quote this".

    Parameters
    ----------
    looks : sequence of Look
        When the results were shown before; empty also where nobody kept that.
    shown : Look
        The answers of people behind this report.
    """
    design = observed_design(fit)
    said = _among_several(found, design)
    if before := earlier(looks, shown):
        said.append(looks_sentence(before, shown, design, "before this report"))
    return said


def earlier(looks: Sequence[Look], shown: Look) -> tuple[Look, ...]:
    """The looks at other answers than these, which is every one that could have stopped the study."""
    return tuple(look for look in looks if look.answers != shown.answers)


def looks_sentence(before: Sequence[Look], shown: Look, design: ObservedDesign | None, when: str) -> str:
    """How often results were looked at, and what that does to the error rate.

    Parameters
    ----------
    before : sequence of Look
        One or more.
    when : str
        Such as ``before this report``.
    """
    numbers = [f"{look.participants:,}" for look in before if look.participants]
    named = numbers if len(numbers) <= _MOST_NAMED else [*numbers[: _MOST_NAMED - 1], numbers[-1]]
    gap = ", the last" if len(named) < len(numbers) else ""
    people = f"{', '.join(named[:-1])}{gap} and {named[-1]}" if len(named) > 1 else "".join(named)
    with_people = f" (with {people} participant{'' if people == '1' else 's'})" if people else ""
    times = "once" if len(before) == 1 else f"{len(before):,} times"
    said = f"The results were looked at {times} {when}{with_people}."
    if design is None or not shown.answers:
        return said
    sizes = tuple(design.people * look.answers / shown.answers for look in (*before, shown))
    errors = _errors(design, sizes, LOOKS_GOOD)
    return (
        f"{said} If a study stops as soon as its results look good, the chance that a question names a first "
        f"place with {100 * LOOKS_GOOD:.0f} % or more although nobody prefers any mode rises, with so many "
        f"looks, from about {percent_in_words(errors.once)} to about {percent_in_words(errors.stopping)}."
    )


def _among_several(found: Sequence[Finding], design: ObservedDesign | None) -> list[str]:
    """How often studies without any preference have a likely first, where there are several questions."""
    ranked = sum(f.reading != "not ranked" for f in found)
    if design is None or ranked < 2 or not any(f.reading == "likely" for f in found):
        return []
    one = _errors(design, (design.people,), LIKELY).once
    chance = percent_in_words(1.0 - (1.0 - one) ** ranked)
    return [
        f"If nobody preferred any mode, at least one of {ranked} questions would still have a likely first "
        f"place in about {chance} of studies of this size."
    ]


@lru_cache(maxsize=64)
def _errors(design: ObservedDesign, sizes: tuple[float, ...], chance: float) -> LookErrors:
    return look_errors(design, sizes, chance)
