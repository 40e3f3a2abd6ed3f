"""How strongly people prefer: "much more" among the answers, and what the model expects of new people."""

from collections.abc import Sequence
from dataclasses import dataclass

from analysis.answer_shares import PairShares
from analysis.results import Fit

NAN = float("nan")


@dataclass(frozen=True)
class Strength:
    """Two modes on one question with five levels; shares are of all answers to the pair.

    Attributes
    ----------
    n, much_i, much_j : int
        Answers, and those that said "much" for either mode.
    strong_share : float
        Share of "much" among the answers that preferred either mode; NaN if all are ties.
    p_much_i, p_much_j : float
        Posterior mean chance that a new person answers "much" for the mode; NaN if not ranked.
    p_much_i_low, p_much_i_high, p_much_j_low, p_much_j_high : float
        94 % HDI of these chances.
    """

    question: str
    mode_i: str
    mode_j: str
    n: int
    much_i: int
    much_j: int
    strong_share: float
    p_much_i: float
    p_much_i_low: float
    p_much_i_high: float
    p_much_j: float
    p_much_j_low: float
    p_much_j_high: float


def strengths(fit: Fit, shares: Sequence[Sequence[PairShares]]) -> tuple[Strength, ...]:
    """Every pair that was asked on a scale of five levels, in the order of the fit."""
    return tuple(
        _strength(question.question.name, pair)
        for question, pairs in zip(fit.questions, shares, strict=True)
        if question.question.levels == 5
        for pair in pairs
    )


def _strength(question: str, pair: PairShares) -> Strength:
    decided = pair.n - pair.counts[2]
    much = pair.counts[0] + pair.counts[4]
    known = (pair.expected, pair.expected_low, pair.expected_high)
    i, j = (tuple(shares[at] if shares else NAN for shares in known) for at in (0, 4))
    return Strength(
        question,
        pair.mode_i,
        pair.mode_j,
        pair.n,
        pair.counts[0],
        pair.counts[4],
        much / decided if decided else NAN,
        *i,
        *j,
    )
