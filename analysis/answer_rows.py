"""The answers to one question one by one, in the order in which each person gave them."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.order import ORDER_COLUMNS, with_order
from data.answers import SCALES
from data.responses import QuestionScale, ResponseTable

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class AnswerRows:
    """One entry an answer, sorted by person and, within a person, by time.

    Attributes
    ----------
    levels : int
        Answers on the scale.
    people : tuple of str
        Names; one empty name where the answers name nobody.
    person, mode_a, mode_b : ndarray of int64, shape (answer,)
        Places in ``people`` and among the modes.
    level : ndarray of int64, shape (answer,)
        From A much (0) to B much.
    before : ndarray of int64, shape (answer,)
        Place of the same person's last answer to the same pair of modes; -1 if there is none.
    has_people, has_order : bool
        Whether the people and the order of their answers are known. The order is that of the rows; rows that
        stand for several answers have none.
    order : ndarray, shape (answer, 3), or None
        As in ``Counts.order``; None where the model does not ask for it.
    """

    levels: int
    people: tuple[str, ...]
    person: Integers
    mode_a: Integers
    mode_b: Integers
    level: Integers
    before: Integers
    has_people: bool
    has_order: bool
    order: NDArray[np.float64] | None = None

    @property
    def n(self) -> int:
        """Number of answers."""
        return len(self.level)

    @property
    def turned(self) -> NDArray[np.bool_]:
        """Whether the mode that comes later in the table was shown as A: shape (answer,)."""
        return self.mode_a > self.mode_b

    def collapsed(self) -> "AnswerRows":
        """The same on three levels, or two without a tie: how much more is not looked at."""
        half, levels = self.levels // 2, 2 + self.levels % 2
        merged = np.where(self.level < half, 0, np.where(self.level >= self.levels - half, levels - 1, 1))
        return replace(self, level=merged.astype(np.int64), levels=levels)

    def of_people(self, chosen: NDArray[np.bool_]) -> "AnswerRows":
        """All answers of some people; ``chosen`` has shape (person,)."""
        kept = chosen[self.person]
        place = np.cumsum(kept) - 1
        return replace(
            self.at(kept),
            people=tuple(name for name, is_kept in zip(self.people, chosen, strict=True) if is_kept),
            person=(np.cumsum(chosen) - 1)[self.person[kept]],
            before=np.where(self.before[kept] < 0, -1, place[self.before[kept]]),
            has_order=self.has_order,
        )

    def at(self, chosen: NDArray[np.generic]) -> "AnswerRows":
        """Some of the answers; what came before them is no longer known."""
        kept = {name: getattr(self, name)[chosen] for name in ("person", "mode_a", "mode_b", "level")}
        kept["order"] = None if self.order is None else self.order[chosen]
        return replace(self, **kept, before=np.full(len(kept["level"]), -1), has_order=False)


def answer_rows(
    table: ResponseTable, question: QuestionScale, modes: tuple[str, ...], *, in_order: bool = False
) -> AnswerRows:
    """All answers to a question but those to attention checks; ``modes`` gives the modes their places.

    ``in_order`` adds the places of comparisons that a model with ``position`` was fitted to.
    """
    table = with_order(table) if in_order else table
    rows = table.rows[(table.rows["question"] == question.name) & ~table.rows["check"].astype(bool)]
    has_order = table.has_participants and bool((rows["count"] <= 1).all())
    rows = rows.loc[rows.index.repeat(rows["count"].to_numpy())]
    names = rows["participant"].astype(str) if table.has_participants else pd.Series("", index=rows.index)
    people, person = np.unique(names.to_numpy(dtype=str), return_inverse=True)
    order = np.argsort(person, kind="stable")
    scale, places = pd.Index(SCALES[question.levels]), pd.Index(modes)
    frame = rows.iloc[order]
    mode_a, mode_b = (places.get_indexer(pd.Index(frame[side])) for side in ("mode_a", "mode_b"))
    person = person[order].astype(np.int64)
    repetition = frame["repetition"].to_numpy(dtype=np.int64)
    return AnswerRows(
        question.levels,
        tuple(str(name) for name in people),
        person,
        mode_a.astype(np.int64),
        mode_b.astype(np.int64),
        scale.get_indexer(pd.Index(frame["response"])).astype(np.int64),
        _answers_before(person, mode_a, mode_b, repetition) if has_order else np.full(len(frame), -1),
        table.has_participants,
        has_order,
        frame[list(ORDER_COLUMNS)].to_numpy(float) if in_order else None,
    )


def _answers_before(person: Integers, mode_a: Integers, mode_b: Integers, repetition: Integers) -> Integers:
    """Of every answer the same person's last answer to the same pair, by repetition and then by row."""
    i, j = np.minimum(mode_a, mode_b), np.maximum(mode_a, mode_b)
    order = np.lexsort((repetition, j, i, person))
    keys = np.stack([person, i, j])[:, order]
    is_again = np.zeros(len(order), dtype=bool)
    is_again[1:] = (keys[:, 1:] == keys[:, :-1]).all(axis=0)
    before = np.full(len(order), -1, dtype=np.int64)
    before[order[is_again]] = order[np.flatnonzero(is_again) - 1]
    return before
