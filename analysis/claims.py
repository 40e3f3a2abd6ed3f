"""What the report claims in words, and how many of these claims are expected to be wrong.

A claim is right with its posterior probability. So of several claims ``sum(1 - probability)`` are expected
to be wrong, whatever they have to do with each other. The chance that all of them are right follows exactly
where each is about another question, since questions share nothing in the model; for claims about one
question only its lower limit is known (Bonferroni).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod

import numpy as np


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
