"""Can these answers rank these modes? Checked before anything is sampled."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from analysis.counts import Counts
from analysis.figures.labels import isolated
from analysis.groups import Group, groups_of, listed

FEW_COMPARISONS = 10
"""Fewer comparisons of a mode than this bring a warning. Untuned: a day's pilot, not a study."""
ONE_SIDE_BY_CHANCE = 0.001
"""All answers for one side count as chance if coins would do that at least so often: up to ten answers."""
_PAIRS_NAMED = 6
"""Pairs never shown that a sentence names before it counts the rest."""

Pair = tuple[str, str]


@dataclass(frozen=True)
class Examination:
    """What the answers allow.

    Attributes
    ----------
    refusal : str
        Why there can be no ranking, as a sentence; empty if there can be one.
    missing_pairs : tuple of (str, str)
        Pairs that were never compared and would connect two groups.
    warnings : tuple of str
        What the reader of the ranking must know, a sentence each.
    has_side_effect : bool
        False if the model is to have no side effect, or if the answers make none of it known.
    """

    refusal: str
    missing_pairs: tuple[Pair, ...]
    warnings: tuple[str, ...]
    has_side_effect: bool = True


def examine(
    counts: Counts, modes: tuple[str, ...], *, has_participants: bool, side_effect: bool
) -> Examination:
    """Look for what stands against a ranking.

    Parameters
    ----------
    modes : tuple of str
        The order in which modes are named.
    side_effect : bool
        True if the model is to have a side effect.
    """
    place = [counts.modes.index(mode) for mode in modes]
    wins, ties = counts.wins()[np.ix_(place, place)], counts.ties()[np.ix_(place, place)]
    compared = wins + wins.T + ties
    groups = groups_of(modes, compared)
    if len(groups) > 1:
        missing = _between(groups, modes)
        return Examination(_refusal(counts, groups, missing), missing, ())
    warnings = []
    if has_participants and len(counts.participants) == 1:
        warnings.append(
            "All answers are one participant's: what they say of other people rests on the prior for how "
            "much people differ."
        )
    if counts.levels > 2 and ties.sum() == compared.sum():
        warnings.append("Every answer is a tie: the modes can't be told apart.")
    else:
        warnings += _separation(modes, wins, ties)
    warnings += _never_shown(modes, compared)
    few = [mode for mode, n in zip(modes, compared.sum(axis=1), strict=True) if n < FEW_COMPARISONS]
    if few:
        warnings.append(
            f"Few data: {_named(few)} {_are(few)} in fewer than {FEW_COMPARISONS} comparisons; the ranking "
            "rests on the prior as much as on the answers."
        )
    if side_effect and sides_are_alike(counts.responses.sum(axis=0)):
        return Examination("", (), (*warnings, _one_side(counts)), False)
    if side_effect:
        warnings += _sides(counts)
    return Examination("", (), tuple(warnings), side_effect)


def _between(groups: tuple[Group, ...], modes: tuple[str, ...]) -> tuple[Pair, ...]:
    group_of = {mode: g for g, group in enumerate(groups) for mode in group.modes}
    return tuple((a, b) for i, a in enumerate(modes) for b in modes[i + 1 :] if group_of[a] != group_of[b])


def _refusal(counts: Counts, groups: tuple[Group, ...], missing: tuple[Pair, ...]) -> str:
    if counts.n == 0:
        return "There are no answers to this question."
    needed = f"Missing: {listed([f'{isolated(a)} against {isolated(b)}' for a, b in missing], 'or')}"
    unseen = [group.modes[0] for group in groups if len(group.modes) == 1]
    way_out = "“elbowroom report --largest-group” ranks the largest group alone."
    if len(unseen) == len(groups) - 1:
        was = "was" if len(unseen) == 1 else "were"
        return f"{_named(unseen)} {was} never compared with another mode. {needed}. {way_out}"
    parts = "; ".join(_named(list(group.modes)) for group in groups)
    apart = f"The modes fall into {len(groups)} groups never compared with each other"
    return f"{apart}: {parts}. {needed}. {way_out}"


def _separation(modes: tuple[str, ...], wins: NDArray[np.int64], ties: NDArray[np.int64]) -> list[str]:
    """Groups of modes that never lost or tied outside: there the likelihood has no maximum.

    References
    ----------
    Ford 1957: the estimate exists if and only if every mode can be reached from every other along wins.
    """
    n, label = connected_components(csr_array(wins + ties), directed=True, connection="strong")
    said = []
    groups = sorted(range(n if n > 1 else 0), key=lambda g: np.count_nonzero(label == g))
    # Of two groups the smaller says it all: what one won, the other lost.
    for g in groups[:1] if n == 2 else groups:
        inside = label == g
        group = [mode for mode, is_in in zip(modes, inside, strict=True) if is_in]
        won, lost = wins[np.ix_(inside, ~inside)].sum(), wins[np.ix_(~inside, inside)].sum()
        drawn = ties[np.ix_(inside, ~inside)].sum()
        if drawn or (won and lost):
            continue
        said.append(
            f"{_named(group)} {'won' if won else 'lost'} every comparison with the other modes: how far they "
            "are apart rests on the prior."
        )
    return said


def sides_are_alike(answers: NDArray[np.int64]) -> bool:
    """Whether every answer that is not a tie is for the same side, more of them than chance explains.

    Then a side effect as large as one likes explains them all, whatever the modes are like, and a file that
    names the winner first looks just like that.

    Parameters
    ----------
    answers : ndarray of int64, shape (level,)
        How often each was given, from A much to B much.
    """
    half = len(answers) // 2
    decided = sorted((int(answers[:half].sum()), int(answers[-half:].sum())))
    return decided[0] == 0 and 0.5 ** (decided[1] - 1) < ONE_SIDE_BY_CHANCE


def _one_side(counts: Counts) -> str:
    answers = counts.responses.sum(axis=0)
    half = counts.levels // 2
    side = "A" if answers[:half].sum() else "B"
    n = int(answers[:half].sum() + answers[-half:].sum())
    return (
        f"All {n:,} answers that prefer a mode prefer what stands as {side}, so the sides say nothing here "
        "and the side effect is left out. If the data name the "
        f"{'winner' if side == 'A' else 'loser'} first, that is right; if people saw these sides, they chose "
        f"{side} whatever it was, and this ranking shows only how often each mode stood there."
    )


def has_exchanged_sides(counts: Counts) -> bool:
    """Whether any pair was shown in both orders."""
    seen = _ordered_pairs(counts)
    return any((b, a) in seen for a, b in seen)


def _ordered_pairs(counts: Counts) -> set[tuple[int, int]]:
    return {(int(a), int(b)) for a, b in zip(counts.mode_a, counts.mode_b, strict=True)}


def _never_shown(modes: tuple[str, ...], compared: NDArray[np.int64]) -> list[str]:
    """Pairs without any answer, although other pairs connect their modes."""
    never = np.argwhere(np.triu(compared == 0, 1))
    pairs = [f"{isolated(modes[i])} and {isolated(modes[j])}" for i, j in never]
    if not pairs:
        return []
    where = "; pairwise.csv has them all, with n = 0" if len(pairs) > _PAIRS_NAMED else ""
    return [
        f"Never shown against each other: {'; '.join(pairs[:_PAIRS_NAMED])}"
        + (f"; and {len(pairs) - _PAIRS_NAMED:,} more pairs" if len(pairs) > _PAIRS_NAMED else "")
        + f". Which of two such modes is above the other follows from the other pairs alone{where}."
    ]


def _sides(counts: Counts) -> list[str]:
    """Warn where the side effect cannot be told from the modes."""
    if has_exchanged_sides(counts):
        return []
    seen = _ordered_pairs(counts)
    design = np.zeros((len(seen), len(counts.modes) + 1))
    for row, (a, b) in enumerate(sorted(seen)):
        design[row, [a, b, -1]] = 1.0, -1.0, 1.0
    if np.linalg.matrix_rank(design) < len(counts.modes):
        return [
            "No pair was shown with its sides exchanged and the side effect can't be told from the modes: it "
            "rests on its prior. If A and B mean nothing here, “--no-side-effect” leaves it out."
        ]
    return [
        "No pair was shown with its sides exchanged: the side effect is told from the modes only by how "
        "pairs fit together. If A and B mean nothing here, “--no-side-effect” leaves it out."
    ]


def _named(modes: list[str]) -> str:
    return listed([isolated(mode) for mode in modes])


def _are(names: list[str]) -> str:
    return "is" if len(names) == 1 else "are"
