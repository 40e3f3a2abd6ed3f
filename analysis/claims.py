"""What the report claims in words, and how many of these claims are expected to be wrong.

A claim is right with its posterior probability. So of several claims ``sum(1 - probability)`` are expected
to be wrong, whatever they have to do with each other. The chance that all of them are right follows exactly
where each is about another question, since questions share nothing in the model; for claims about one
question only its lower limit is known (Bonferroni).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, prod

import numpy as np

from analysis.figures.labels import percent_in_words

_ROUNDING = 1e-9
"""Of sums of chances: 0.15 + 0.85 shall not be a per cent less than 1."""


@dataclass(frozen=True)
class Claim:
    """One statement of the report that may be wrong.

    Attributes
    ----------
    section : str
        Heading of the section that makes it.
    text : str
        The statement as a sentence.
    probability : float
        Posterior probability that it is right.
    question : str
        Name of the question it is about; empty if it is about none.
    """

    section: str
    text: str
    probability: float
    question: str = ""


def expected_wrong(claims: Sequence[Claim]) -> float:
    """How many of the claims are expected to be wrong."""
    return float(np.sum([1.0 - claim.probability for claim in claims]))


def all_right(claims: Sequence[Claim]) -> float:
    """Probability that all claims are right; a lower limit where several are about one question."""
    wrong: dict[str, float] = {}
    for claim in claims:
        wrong[claim.question] = wrong.get(claim.question, 0.0) + 1.0 - claim.probability
    return prod(max(0.0, 1.0 - share) for share in wrong.values())


def joint_sentence(claims: Sequence[Claim], one: str, many: str) -> str:
    """How far several claims can be relied on together, as a sentence; empty if there are none.

    Parameters
    ----------
    one, many : str
        What is claimed, such as ``named first`` and ``named firsts``.
    """
    if not claims:
        return ""
    if len(claims) == 1:
        return f"The chance that this {one} is wrong is {percent_in_words(1.0 - claims[0].probability)}."
    questions = [claim.question for claim in claims]
    least = "at least " if len(set(questions)) < len(questions) else ""
    together = all_right(claims)
    said = f"Of the {len(claims):,} {many} {_number(expected_wrong(claims))} are expected to be wrong"
    if least and together < 0.5:
        # The limit for claims about one question falls to 0 with many of them, and says nothing then.
        return f"{said}."
    # A limit is rounded down: “at least” more than is known would be kinder than the answers.
    chance = floor(100 * together + _ROUNDING) / 100 if least else together
    return f"{said}; the chance that all of them are right is {least}{percent_in_words(chance)}."


def _number(expected: float) -> str:
    """An expected number with about two digits, never a bare 0."""
    if expected < 0.01:
        return "fewer than 0.01"
    return f"{expected:.2f}" if expected < 0.995 else f"{expected:.1f}"
