"""Shares of answers that have a plain meaning, of several sets of answers at once."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from analysis.answer_rows import AnswerRows
from analysis.level_names import SAME, level_names
from analysis.new_people import Answers

FloatArray = NDArray[np.float64]
Share = Literal["wins", "ties", "level", "spread"]

OVER = " over "
"""Between the modes of a pair in the name of its share of wins."""


def answer_quantities(
    rows: AnswerRows, answers: Answers, modes: tuple[str, ...]
) -> dict[tuple[Share, str], FloatArray]:
    """Shares that have a plain meaning, of every set of answers: each of shape (set,)."""
    half = rows.levels // 2
    first, second = answers < half, answers >= rows.levels - half
    for_i = np.where(rows.turned, second, first)
    pairs = np.minimum(rows.mode_a, rows.mode_b) * len(modes) + np.maximum(rows.mode_a, rows.mode_b)
    every, pair = np.unique(pairs, return_inverse=True)
    found: dict[tuple[Share, str], FloatArray] = {}
    shares = _means(for_i, pair)
    for column, (i, j) in enumerate(zip(*np.divmod(every, len(modes)), strict=True)):
        found["wins", f"{modes[i]}{OVER}{modes[j]}"] = shares[:, column]
    if rows.levels > 2:
        for k, name in enumerate(level_names(rows.levels)):
            share = (answers == k).mean(axis=1)
            if name == SAME:
                found["ties", ""] = share
            else:
                found["level", name] = share
    if len(rows.people) > 1:
        net = for_i.astype(float) - np.where(rows.turned, first, second)
        keys = rows.person * len(every) + pair
        cells, cell = np.unique(keys, return_inverse=True)
        around = _means(net, cell) - _means(net, pair)[:, cells % len(every)]
        found["spread", ""] = np.sqrt((around**2).mean(axis=1))
    return found


def _means(values: NDArray[np.generic], group: Answers) -> FloatArray:
    """Mean over the answers of each group: (set, group)."""
    n = np.bincount(group)
    picks = csr_array((1.0 / n[group], (group, np.arange(len(group)))), shape=(len(n), len(group)))
    return np.asarray(picks @ values.T.astype(float)).T
