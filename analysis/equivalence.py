"""Is the difference of two modes worth speaking of? Practical equivalence and strength, pair by pair.

References
----------
Kruschke 2018, "Rejecting or accepting parameter values in Bayesian estimation" (the region of practical
equivalence; here its posterior probability is reported).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from analysis.diagnostics import hdi
from analysis.figures.labels import LIKELY
from analysis.results import HDI_PROBABILITY, Fit, QuestionFit

EQUIVALENT_CHANCE = 0.55
"""Two modes are practically equal where neither is felt to be the higher with more than this chance: 11 of 20
times, which no designer would choose a controller by. Untuned: a convention, and stated in every report."""
EQUIVALENT_BELOW = float(np.log(EQUIVALENT_CHANCE / (1 - EQUIVALENT_CHANCE)))
"""The same as a difference of abilities: 0.20 logits."""

Verdict = Literal["different", "equal in practice", "open"]


@dataclass(frozen=True)
class Equivalence:
    """Two modes on one question.

    Attributes
    ----------
    difference_mean, difference_sd, difference_hdi_low, difference_hdi_high : float
        Ability of mode i less that of mode j [logit]; 94 % HDI.
    p_equal : float
        Posterior probability that the difference lies within ``EQUIVALENT_BELOW`` of 0.
    p_i_above, p_j_above : float
        That it lies above, or below, that region: the three sum to 1.
    reading : Verdict
        ``different`` or ``equal in practice`` from a chance of 80 % on.
    """

    question: str
    mode_i: str
    mode_j: str
    difference_mean: float
    difference_sd: float
    difference_hdi_low: float
    difference_hdi_high: float
    p_equal: float
    p_i_above: float
    p_j_above: float
    reading: Verdict


def equivalences(fit: Fit) -> tuple[Equivalence, ...]:
    """Every pair of modes of every ranked question, in the order of the fit."""
    return tuple(
        e for question in fit.questions if question.ranked for e in _pairs(question, question.mode_names)
    )


def _pairs(question: QuestionFit, modes: tuple[str, ...]) -> list[Equivalence]:
    assert question.draws is not None
    ability = question.draws.ability.reshape(-1, len(modes))
    found = []
    for i in range(len(modes) - 1):
        lead = ability[:, i : i + 1] - ability[:, i + 1 :]
        low, high = hdi(lead, HDI_PROBABILITY)
        above, below = (lead > EQUIVALENT_BELOW).mean(axis=0), (lead < -EQUIVALENT_BELOW).mean(axis=0)
        equal = (np.abs(lead) <= EQUIVALENT_BELOW).mean(axis=0)
        for k in range(lead.shape[1]):
            p_above, p_below, p_equal = float(above[k]), float(below[k]), float(equal[k])
            found.append(
                Equivalence(
                    question.question.name,
                    modes[i],
                    modes[i + 1 + k],
                    float(lead[:, k].mean()),
                    float(lead[:, k].std(ddof=1)),
                    float(low[k]),
                    float(high[k]),
                    p_equal,
                    p_above,
                    p_below,
                    _reading(p_equal, p_above, p_below),
                )
            )
    return found


def _reading(p_equal: float, p_above: float, p_below: float) -> Verdict:
    if max(p_above, p_below) >= LIKELY:
        return "different"
    return "equal in practice" if p_equal >= LIKELY else "open"
