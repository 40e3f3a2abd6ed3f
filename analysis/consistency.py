"""Do people agree with themselves and with each other? Circular triads, repeated pairs, Kendall's u.

References
----------
Kendall & Babington Smith 1940, "On the method of paired comparisons", Biometrika 31 (circular triads, the
coefficient of consistence zeta, the coefficient of agreement u).
"""

from dataclasses import dataclass
from math import comb, nan

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.agreement_chance import agreement_chance
from data.answers import SCALES
from data.responses import QuestionScale, ResponseTable

FloatArray = NDArray[np.float64]
CIRCULAR_BY_CHANCE = 0.25
"""Share of circular triads among those of someone who tosses a coin for every pair."""
MOST_MODES = 60
"""Triads grow with the cube of the modes; with more than these they are not counted."""


@dataclass(frozen=True)
class Consistency:
    """One participant's answers to one question, or all participants' (``participant`` is "all").

    Attributes
    ----------
    answers : int
    triads : int
        Triples of modes whose three pairs the person decided, repetitions taken together.
    circular : int
        Those of them that go round in a circle.
    zeta : float
        Coefficient of consistence, 1 without circles, 0 with as many as there can be; NaN unless every pair
        is decided. For all: the mean over participants that have one.
    repeated, same, reversed : int
        Answers to a pair that the person had answered before, set beside the answer before; those that again
        prefer the same mode (or again none), and those that prefer the other one.
    same_by_chance : float
        Share of the same that would be expected by chance, given how often each answer was given to the pair
        before and after: for all.
    retest : float
        Correlation of such answers with those before within pairs: the scale goes from much j (-2) to much i
        (2), and of every pair its mean before and its mean after are taken out, so that pairs which everybody
        decides alike do not count as a memory. For all.
    u : float
        Kendall's coefficient of agreement between people; 1 if all agree on every pair. For all.
    u_p : float
        Exact chance that people who toss a coin for every pair they decided agree as much. For all.
    """

    question: str
    participant: str
    answers: int
    triads: int
    circular: int
    zeta: float
    repeated: int
    same: int
    reversed: int
    same_by_chance: float = nan
    retest: float = nan
    u: float = nan
    u_p: float = nan


def consistencies(table: ResponseTable) -> tuple[Consistency, ...]:
    """All participants together, then each, question by question; none if participants are unknown."""
    if not table.has_participants:
        return ()
    rows = table.rows[~table.rows["check"].astype(bool)]
    return tuple(
        found
        for question in table.questions
        for found in _question(rows[rows["question"] == question.name], table.modes_of(question), question)
    )


def _question(rows: pd.DataFrame, modes: tuple[str, ...], question: QuestionScale) -> list[Consistency]:
    if rows.empty:
        return []
    turned = _turned(rows, modes, question)
    people = {str(who): group for who, group in turned.groupby("participant", sort=False)}
    each = [_person(question.name, who, group, len(modes)) for who, group in people.items()]
    chance, retest = _over_repeats(turned)
    u, u_p = _agreement(turned, len(modes))
    zetas = [c.zeta for c in each if not np.isnan(c.zeta)]
    together = Consistency(
        question.name,
        "all",
        sum(c.answers for c in each),
        sum(c.triads for c in each),
        sum(c.circular for c in each),
        float(np.mean(zetas)) if zetas else nan,
        sum(c.repeated for c in each),
        sum(c.same for c in each),
        sum(c.reversed for c in each),
        chance,
        retest,
        u,
        u_p,
    )
    return [together, *each]


def _turned(rows: pd.DataFrame, modes: tuple[str, ...], question: QuestionScale) -> pd.DataFrame:
    """One row an answer, turned to the mode that comes first in the study: ``score`` > 0 prefers it.

    ``before`` is the score of the same person's answer to the same pair before this one, or nan.
    """
    place = {mode: k for k, mode in enumerate(modes)}
    half = question.levels // 2
    steps = [k for k in range(half, -half - 1, -1) if k or question.levels % 2]
    worth = dict(zip(SCALES[question.levels], steps, strict=True))
    a, b = rows["mode_a"].map(place).to_numpy(), rows["mode_b"].map(place).to_numpy()
    score = rows["response"].map(worth).to_numpy() * np.where(a < b, 1, -1)
    frame = pd.DataFrame(
        {
            "participant": rows["participant"].to_numpy(),
            "i": np.minimum(a, b),
            "j": np.maximum(a, b),
            "score": score,
            "repetition": rows["repetition"].to_numpy(),
        }
    )
    frame = frame.loc[frame.index.repeat(rows["count"].to_numpy())]
    frame = frame.sort_values("repetition", kind="stable", ignore_index=True)
    return frame.assign(before=frame.groupby(["participant", "i", "j"])["score"].shift())


def _person(question: str, who: str, answers: pd.DataFrame, n_modes: int) -> Consistency:
    above = _decided(answers, n_modes)
    triads, circular = _triads(above)
    before, now = np.sign(answers["before"].to_numpy(float)), np.sign(answers["score"].to_numpy())
    again = ~np.isnan(before)
    return Consistency(
        question,
        who,
        len(answers),
        triads,
        circular,
        _zeta(above, circular),
        int(again.sum()),
        int((before == now).sum()),
        int((before * now < 0).sum()),
    )


def _decided(answers: pd.DataFrame, n_modes: int) -> NDArray[np.bool_]:
    """Which mode (row) the person puts above which (column), all repetitions added up."""
    net = np.zeros((n_modes, n_modes))
    np.add.at(net, (answers["i"].to_numpy(), answers["j"].to_numpy()), np.sign(answers["score"].to_numpy()))
    return np.asarray((net - net.T) > 0)


def _triads(above: NDArray[np.bool_]) -> tuple[int, int]:
    """Decided triads and the circular ones, by traces of powers of the adjacency matrix."""
    if len(above) > MOST_MODES:
        return 0, 0
    decided = (above | above.T).astype(np.int64)
    won = above.astype(np.int64)
    return int(np.trace(decided @ decided @ decided)) // 6, int(np.trace(won @ won @ won)) // 3


def _zeta(above: NDArray[np.bool_], circular: int) -> float:
    """``1 - d / d_max`` with d_max = (K^3 - K) / 24 for odd K and (K^3 - 4K) / 24 for even K."""
    n = len(above)
    if n < 3 or n > MOST_MODES or int(above.sum()) < comb(n, 2):
        return nan
    return 1.0 - 24.0 * circular / (n**3 - (n if n % 2 else 4 * n))


def _over_repeats(answers: pd.DataFrame) -> tuple[float, float]:
    """Share of the same expected by chance, and the correlation of answers with those before."""
    before = answers["before"]
    again = before.notna()
    if not again.any():
        return nan, nan
    pairs = pd.DataFrame(
        {
            "i": answers["i"],
            "j": answers["j"],
            "old": np.sign(before),
            "new": np.sign(answers["score"]),
        }
    )[again]
    expected = 0.0
    for _, group in pairs.groupby(["i", "j"]):
        old, new = group["old"].value_counts(normalize=True), group["new"].value_counts(normalize=True)
        expected += len(group) * float((old * new.reindex(old.index, fill_value=0.0)).sum())
    scores = answers.loc[again, ["before", "score"]].astype(float)
    centred = scores - scores.groupby([pairs["i"], pairs["j"]]).transform("mean")
    x, y = centred["before"].to_numpy(), centred["score"].to_numpy()
    size = float(np.sqrt((x**2).sum() * (y**2).sum()))
    return expected / len(pairs), float((x * y).sum() / size) if size else nan


def _agreement(answers: pd.DataFrame, n_modes: int) -> tuple[float, float]:
    """Kendall's u over the people who compared every pair, a tie as half a preference each; its chance."""
    net = answers.assign(sign=np.sign(answers["score"]))
    choices = net.groupby(["participant", "i", "j"])["sign"].sum().unstack(["i", "j"])
    if choices.shape[1] < comb(n_modes, 2):
        return nan, nan
    signs = np.sign(choices.dropna().to_numpy(float))
    if len(signs) < 2 or n_modes < 2:
        return nan, nan
    decided = np.abs(signs).sum(axis=0).astype(np.int64)
    return _kendall_u(signs), agreement_chance(signs.sum(axis=0).astype(np.int64), decided)


def _kendall_u(signs: FloatArray) -> float:
    """``2 Sum / (C(m, 2) C(K, 2)) - 1``; ``signs`` has shape (person, pair)."""
    m = len(signs)
    for_i = (1 + signs).sum(axis=0) / 2
    agreeing = (for_i * (for_i - 1) + (m - for_i) * (m - for_i - 1)) / 2
    return float(2 * agreeing.sum() / (comb(m, 2) * signs.shape[1]) - 1)
