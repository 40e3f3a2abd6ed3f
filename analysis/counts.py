"""Responses counted per question, participant and ordered pair: the one input of every engine."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.order import ORDER_COLUMNS, with_order
from data.answers import SCALES
from data.errors import InputError, one_of
from data.responses import QuestionScale, ResponseTable

_ONE_FOR_ALL = ("",)


@dataclass(frozen=True)
class Counts:
    """How often each answer was given, by participant and ordered pair of modes.

    Modes and participants are sorted by name and cells by (participant, A, B), so that neither the
    order of the rows nor the way they were grouped can reach a sampler.

    Attributes
    ----------
    modes : tuple of str
        All modes that the question is about, sorted; ``mode_a`` and ``mode_b`` index them.
    participants : tuple of str
        Sorted; one empty name if the participants are unknown or pooled.
    participant, mode_a, mode_b : ndarray of int64, shape (cell,)
    responses : ndarray of int64, shape (cell, level)
        Counts in the order A much .. B much.
    order : ndarray, shape (cell, 3), or None
        When the comparisons of a cell were made, as ``analysis.order`` scales it: their place, and how often
        A and B came before. None where it does not matter; cells of different order are kept apart.
    """

    question: QuestionScale
    modes: tuple[str, ...]
    participants: tuple[str, ...]
    participant: NDArray[np.int64]
    mode_a: NDArray[np.int64]
    mode_b: NDArray[np.int64]
    responses: NDArray[np.int64]
    order: NDArray[np.float64] | None = None

    @property
    def n(self) -> int:
        """Responses in all."""
        return int(self.responses.sum())

    @property
    def levels(self) -> int:
        """Answers on the scale: 2 to 9."""
        return int(self.responses.shape[1])

    def pooled(self) -> "Counts":
        """The same counts with all participants taken as one."""
        return _gathered(
            self.question,
            self.modes,
            _ONE_FOR_ALL,
            np.zeros_like(self.participant),
            self.mode_a,
            self.mode_b,
            self.responses,
            self.order,
        )

    def collapsed(self) -> "Counts":
        """The same counts without strength: every answer that prefers a mode taken as the weakest one."""
        if self.levels <= 3:
            return self
        half = self.levels // 2
        tied = self.responses[:, half : half + self.levels % 2]
        first, second = (self.responses[:, side].sum(axis=1)[:, None] for side in self._sides)
        return replace(self, responses=np.concatenate([first, tied, second], axis=1))

    @property
    def _sides(self) -> tuple[slice, slice]:
        """Which answers prefer A, and which B."""
        return slice(None, self.levels // 2), slice(-(self.levels // 2), None)

    def wins(self) -> NDArray[np.int64]:
        """How often each mode was preferred to each other, whatever the sides.

        Returns
        -------
        ndarray of int64, shape (mode, mode)
            Row over column.
        """
        for_a, for_b = self._sides
        table = np.zeros((len(self.modes), len(self.modes)), dtype=np.int64)
        np.add.at(table, (self.mode_a, self.mode_b), self.responses[:, for_a].sum(axis=1))
        np.add.at(table, (self.mode_b, self.mode_a), self.responses[:, for_b].sum(axis=1))
        return table

    def ties(self) -> NDArray[np.int64]:
        """How often each pair was found equal: ndarray of int64, shape (mode, mode), symmetric."""
        table = np.zeros((len(self.modes), len(self.modes)), dtype=np.int64)
        if self.levels % 2:
            middle = self.responses[:, self.levels // 2]
            np.add.at(table, (self.mode_a, self.mode_b), middle)
            np.add.at(table, (self.mode_b, self.mode_a), middle)
        return table

    def compared(self) -> NDArray[np.int64]:
        """How often each pair was answered: ndarray of int64, shape (mode, mode), symmetric."""
        wins = self.wins()
        return wins + wins.T + self.ties()


def count_responses(table: ResponseTable, question: QuestionScale, *, in_order: bool = False) -> Counts:
    """Count the responses to one question; attention checks stay out.

    Parameters
    ----------
    table : ResponseTable
    question : QuestionScale
    in_order : bool
        Keep apart what was answered at different places of a participant's sequence.

    Raises
    ------
    InputError
        If an answer is not on the question's scale, a mode is not one of the question's, or a mode
        is compared with itself in a row that is no check.
    """
    if in_order:
        table = with_order(table)
    rows = table.rows[(table.rows["question"] == question.name) & ~table.rows["check"].astype(bool)]
    modes = tuple(sorted(table.modes_of(question)))
    scale = SCALES[question.levels]
    level = _codes(rows["response"], scale, f"question {question.name}: response")
    mode_a = _codes(rows["mode_a"], modes, f"question {question.name}: mode_a")
    mode_b = _codes(rows["mode_b"], modes, f"question {question.name}: mode_b")
    if np.any(mode_a == mode_b):
        twice = modes[int(mode_a[mode_a == mode_b][0])]
        raise InputError(
            f"question {question.name}: {twice!r} is compared with itself in a row that is no check"
        )
    names = rows["participant"].astype(str).to_numpy()
    participants, participant = np.unique(names, return_inverse=True)
    one_hot = np.zeros((len(rows), len(scale)), dtype=np.int64)
    one_hot[np.arange(len(rows)), level] = rows["count"].to_numpy(dtype=np.int64)
    known = tuple(str(name) for name in participants) if table.has_participants else _ONE_FOR_ALL
    if not table.has_participants:
        participant = np.zeros(len(rows), dtype=np.int64)
    order = rows[list(ORDER_COLUMNS)].to_numpy(dtype=np.float64) if in_order else None
    return _gathered(question, modes, known, participant.astype(np.int64), mode_a, mode_b, one_hot, order)


def _codes(values: pd.Series, valid: tuple[str, ...], what: str) -> NDArray[np.int64]:
    codes = pd.Index(valid).get_indexer(pd.Index(values))
    if np.any(codes < 0):
        raise one_of(what, values.iloc[int(np.argmax(codes < 0))], valid)
    return codes.astype(np.int64)


def _gathered(
    question: QuestionScale,
    modes: tuple[str, ...],
    participants: tuple[str, ...],
    participant: NDArray[np.int64],
    mode_a: NDArray[np.int64],
    mode_b: NDArray[np.int64],
    responses: NDArray[np.int64],
    order: NDArray[np.float64] | None,
) -> Counts:
    """Cells of one key added up, in the order of their keys."""
    n = len(modes)
    keys = (participant * n + mode_a) * n + mode_b
    orders, occasion = np.zeros((1, 3)), np.zeros(len(keys), dtype=np.int64)
    if order is not None and len(order):
        orders, occasion = np.unique(order, axis=0, return_inverse=True)
    keys, cell = np.unique(keys * len(orders) + occasion.ravel(), return_inverse=True)
    summed = np.zeros((len(keys), responses.shape[1]), dtype=np.int64)
    np.add.at(summed, cell, responses)
    keys, occasion = np.divmod(keys, len(orders))
    kept = None if order is None else orders[occasion]
    return Counts(question, modes, participants, keys // (n * n), keys // n % n, keys % n, summed, kept)
