"""Modes that comparisons connect: only within such a group can they be ranked against each other."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from analysis.counts import count_responses
from analysis.figures.labels import isolated
from data.responses import QuestionScale, ResponseTable, rows_sha256

_LISTED = 6
"""Names or pairs that a sentence lists before it counts the rest."""


@dataclass(frozen=True)
class Group:
    """Modes that comparisons connect, directly or through others, and the answers between them."""

    modes: tuple[str, ...]
    answers: int


def groups_of(modes: tuple[str, ...], compared: NDArray[np.int64]) -> tuple[Group, ...]:
    """The groups that modes fall into, in the order of their first modes.

    Parameters
    ----------
    compared : ndarray of int64, shape (mode, mode)
        How often each pair was answered, symmetric.
    """
    n, label = connected_components(csr_array(compared), directed=False)
    return tuple(
        Group(
            tuple(mode for mode, own in zip(modes, label == g, strict=True) if own),
            int(compared[label == g].sum()) // 2,
        )
        for g in range(n)
    )


def largest_groups(table: ResponseTable) -> ResponseTable:
    """The same with every question cut to the largest group that its comparisons connect.

    The largest has most modes, then most answers, then the mode that comes first. A question without
    answers, or whose modes are all connected, stays as it is; a note of the table says what was left out.
    """
    questions, notes = [], list(table.notes)
    kept = np.ones(len(table.rows), bool)
    for question in table.questions:
        modes = table.modes_of(question)
        counts = count_responses(table, question)
        place = [counts.modes.index(mode) for mode in modes]
        groups = groups_of(modes, counts.compared()[np.ix_(place, place)])
        if len(groups) > 1 and counts.n:
            largest = max(groups, key=lambda group: (len(group.modes), group.answers))
            rows = table.rows
            is_out = (rows["question"] == question.name) & ~rows["check"].astype(bool)
            kept &= ~(is_out & ~rows["mode_a"].isin(largest.modes)).to_numpy()
            notes.append(_about(question, largest, groups, counts.n))
            question = replace(question, modes=largest.modes)
        questions.append(question)
    if kept.all() and len(notes) == len(table.notes):
        return table
    rows = table.rows[kept].reset_index(drop=True)
    return replace(table, rows=rows, questions=tuple(questions), notes=tuple(notes), sha256=rows_sha256(rows))


def _about(question: QuestionScale, largest: Group, groups: tuple[Group, ...], answers: int) -> str:
    left_out = [isolated(mode) for group in groups if group is not largest for mode in group.modes]
    lost = answers - largest.answers
    return (
        f"{isolated(question.name)}: no comparison connects the {len(groups)} groups that the modes are in, "
        f"and the largest alone is ranked, as asked: {listed([isolated(mode) for mode in largest.modes])}. "
        f"{listed(left_out)} {'is' if len(left_out) == 1 else 'are'} left out, with {lost:,} of {answers:,} "
        "answers."
    )


def listed(names: Sequence[str], last: str = "and") -> str:
    """Names in a sentence: of many the first ones and how many there are beside them."""
    shown = list(names[:_LISTED])
    if len(names) > _LISTED:
        return f"{', '.join(shown)} {last} {len(names) - _LISTED} more"
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} {last} {shown[-1]}"
