"""Which rank each mode may hold."""

from collections.abc import Sequence

import numpy as np

from analysis.figures.grid import IN_ORDER_UP_TO, NUMBERED_UP_TO, Grid, draw_grids
from analysis.figures.labels import one_line, percent
from analysis.figures.style import Drawing
from analysis.results import QuestionFit


def draw_ranks(
    questions: Sequence[QuestionFit], modes: tuple[str, ...], tag: str = ""
) -> tuple[Drawing, ...]:
    """A matrix a question: the chance that the row's mode holds the column's rank, 1 the highest."""
    ranks = tuple(str(k + 1) for k in range(len(modes)))

    def grid_of(question: QuestionFit) -> Grid | None:
        if not question.ranked:
            return None
        shown = list(question.modes)
        if len(modes) > IN_ORDER_UP_TO:
            shown.sort(key=lambda m: m.rank_mean)
        shares = np.array([mode.rank_probabilities for mode in shown], dtype=float)
        return Grid(shares, tuple(mode.mode for mode in shown), ranks, ())

    return draw_grids(
        questions,
        modes,
        grid_of,
        name="ranks",
        alt=_alt(questions),
        text_of=percent,
        column_title="rank",
        middle="#BDCAD1",
        tag=tag,
        darkest=highest_chance(questions) if len(modes) > NUMBERED_UP_TO else 1.0,
    )


def highest_chance(questions: Sequence[QuestionFit]) -> float:
    """The highest chance of any rank: with many modes, none comes near 1."""
    return max((p for q in questions for m in q.modes for p in m.rank_probabilities), default=1.0)


def _alt(questions: Sequence[QuestionFit]) -> str:
    said = []
    for question in questions:
        ordered = sorted(question.modes, key=lambda m: m.rank_mean)[:8]
        means = ", ".join(f"{one_line(m.mode)} {m.rank_mean:.1f}" for m in ordered)
        said.append(f"{one_line(question.question.name)}: {means if question.ranked else 'not ranked'}.")
    return "Mean rank, 1 is the highest. " + " ".join(said)
