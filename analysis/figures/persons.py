"""Each participant's own worths, beside the group's."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from analysis.figures.labels import distinct, fitted, one_line, percent_in_words, width_px
from analysis.figures.panels import draw_panels
from analysis.figures.style import (
    DATA_2,
    INK,
    INK_2,
    INK_3,
    LINE,
    LINE_STRONG,
    MARKERS,
    Drawing,
    draw_point,
    place_axes,
    write_heading,
    write_text,
)
from analysis.persons import MOST_PEOPLE, Agreement
from analysis.results import QuestionFit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_INTERVALS = 24
"""With more people than these their intervals would hide the dots."""
MOST_MODES = 8
"""Of more modes those with the highest worth are drawn."""
_PLOT_PX, _HEAD_PX, _FOOT_PX = 130, 40, 44


def draw_persons(
    questions: Sequence[QuestionFit], found: Sequence[Agreement], modes: tuple[str, ...], tag: str = ""
) -> tuple[Drawing, ...]:
    """One panel a question: a dot a participant for every mode, the group's worth as its marker beside them.

    Of many people nobody can be told by a place in the row, so each mode has its own row from low to high.
    """
    shown = [(q, a) for q, a in zip(questions, found, strict=True) if a.people]
    highest = max(p.worth_hdi_high for _, a in shown for p in a.people)
    step = 0.2 if highest > 0.4 else 0.1
    top_of_scale = min(1.0, step * math.ceil(highest / step))
    n_drawn = min(len(modes), MOST_MODES)
    per_row = 1 if len(shown) == 1 else 3 if n_drawn <= 4 else 2
    is_one = max(len({p.participant for p in a.people}) for _, a in shown) == 1

    def draw(figure: "Figure", k: int, left: float, top: float, width: float) -> None:
        question, agreement = shown[k]
        write_heading(figure, left, top + 16, question.question, width)
        axes = place_axes(figure, left + 22, top + _HEAD_PX, width - 22, _PLOT_PX)
        axes.set_xlim(-0.5, n_drawn - 0.5)
        axes.set_ylim(0, top_of_scale)
        ticks = [t * step for t in range(round(top_of_scale / step) + 1)]
        axes.set_yticks(ticks, [f"{t:.1f}".removeprefix("0").removesuffix(".0") or "0" for t in ticks])
        write_text(figure, left, top + _HEAD_PX - 8, "worth", fontsize=8.4)
        axes.set_xticks([])
        axes.hlines(ticks, -0.5, n_drawn - 0.5, color=LINE, linewidth=0.75, zorder=0)
        axes.hlines(
            1 / len(modes), -0.5, n_drawn - 0.5, color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2))
        )
        people = list(dict.fromkeys(p.participant for p in agreement.people))
        spots = np.linspace(-0.12, 0.38, len(people)) if len(people) > 1 else np.array([0.1])
        for column, m in enumerate(_highest(question, n_drawn)):
            own = [p for p in agreement.people if p.mode == modes[m]]
            if len(people) > MOST_PEOPLE:
                own.sort(key=lambda p: p.worth_mean)
            x = column + spots
            if len(people) <= MOST_INTERVALS:
                low, high = [p.worth_hdi_low for p in own], [p.worth_hdi_high for p in own]
                axes.vlines(x, low, high, color=LINE_STRONG, linewidth=0.9, zorder=1)
            size = 3.2 if len(people) <= MOST_PEOPLE else 2.0
            means = [p.worth_mean for p in own]
            axes.plot(x, means, "o", color=DATA_2, markersize=size, markeredgewidth=0, zorder=2)
            result = question.modes[m]
            low_end, high_end = result.worth_hdi_low, result.worth_hdi_high
            axes.vlines(column - 0.27, low_end, high_end, color=INK_2, linewidth=1.15, zorder=3)
            draw_point(axes, column - 0.27, result.worth_mean, m, len(modes) > len(MARKERS))
            room = (width - 22) / n_drawn
            name = fitted(distinct(modes, 16)[m], room - 4)
            write_text(
                figure,
                left + 22 + room * (column + 0.5),
                top + _HEAD_PX + _PLOT_PX + 14,
                name,
                ha="center",
                color=INK,
            )
        share = percent_in_words(agreement.share_mean)
        text = f"{share}: own first is {one_line(agreement.first)}"
        if width_px(text, 8.4) > width - 22:
            text = f"chance of the same first: {share}" if is_one else f"{share} agree"
        write_text(
            figure,
            left + 22 + (width - 22) / 2,
            top + _HEAD_PX + _PLOT_PX + 28,
            text,
            ha="center",
            fontsize=8.4,
        )

    said = [
        f"{one_line(a.question)}: {'a chance of ' if is_one else ''}{percent_in_words(a.share_mean)} "
        f"{'that' if is_one else 'of'} {'the own first is' if is_one else 'people have'} {one_line(a.first)}"
        f"{'' if is_one else ' first'}"
        for _, a in shown
    ]
    heights = [_HEAD_PX + _PLOT_PX + _FOOT_PX] * len(shown)
    alt = f"Worth of every mode for each participant and for the group. {'; '.join(said)}."
    return draw_panels(heights, draw, per_row=per_row, name="persons", alt=alt, tag=tag)


def _highest(question: QuestionFit, n: int) -> list[int]:
    """Places of the modes with the highest worth for the group, in the order of the study."""
    return sorted(sorted(range(len(question.modes)), key=lambda k: -question.modes[k].worth_mean)[:n])
