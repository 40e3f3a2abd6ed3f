"""How strongly people prefer: "much more" among the answers, and what the model expects of new people."""

from collections.abc import Sequence
from dataclasses import dataclass

from analysis.answer_shares import PairShares
from analysis.results import Fit

NAN = float("nan")


@dataclass(frozen=True)
class Strength:
    """Two modes on one question with four levels or more; shares are of all answers to the pair.

    "Much" is every answer that is stronger than the weakest preference.

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
    """Every pair that was asked on a scale of four levels or more, in the order of the fit."""
    return tuple(
        _strength(question.question.name, pair)
        for question, pairs in zip(fit.questions, shares, strict=True)
        if question.question.levels > 3
        for pair in pairs
    )


def _strength(question: str, pair: PairShares) -> Strength:
    half = len(pair.counts) // 2
    decided = pair.n - sum(pair.counts[half : half + len(pair.counts) % 2])
    much_i, much_j = sum(pair.counts[: half - 1]), sum(pair.counts[1 - half :])
    i, j = (much or (NAN, NAN, NAN) for much in (pair.much_i, pair.much_j))
    return Strength(
        question,
        pair.mode_i,
        pair.mode_j,
        pair.n,
        much_i,
        much_j,
        (much_i + much_j) / decided if decided else NAN,
        *i,
        *j,
    )
