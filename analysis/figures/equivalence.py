"""Differences of abilities, with the region in which two modes are practically equal."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from analysis.equivalence import EQUIVALENT_BELOW, Equivalence
from analysis.figures.labels import (
    LIKELY,
    distinct,
    fitted_pair,
    one_line,
    percent,
    percent_in_words,
    width_px,
)
from analysis.figures.panels import draw_panels
from analysis.figures.style import (
    DATA,
    INK,
    INK_2,
    INK_3,
    LINE,
    SUNKEN,
    Drawing,
    place_axes,
    write_heading,
    write_text,
)
from data.responses import QuestionScale

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ROW_PX, _HEAD_PX, _FOOT_PX = 20, 42, 32
_LONG_PX = 170
"""Pairs whose names need more room have panels of the whole width."""


def draw_equivalence(
    questions: Sequence[QuestionScale], found: Sequence[Equivalence], modes: tuple[str, ...], tag: str = ""
) -> tuple[Drawing, ...]:
    """One panel a ranked question: the difference of every pair, turned so that it is not negative."""
    of = {q.name: [e for e in found if e.question == q.name] for q in questions}
    shown = [q for q in questions if of[q.name]]
    names = dict(zip(modes, distinct(modes, 30), strict=True))
    longest = max(width_px(f"{names[e.mode_i]} over {names[e.mode_j]}") for e in found)
    reach = 1.05 * max(
        max(abs(e.difference_hdi_low), abs(e.difference_hdi_high), 2 * EQUIVALENT_BELOW) for e in found
    )

    def draw(figure: "Figure", k: int, left: float, top: float, width: float) -> None:
        pairs = of[shown[k].name]
        write_heading(figure, left, top + 16, shown[k], width)
        label, right = min(max(0.36 * width, 12 + longest), 0.55 * width), 40.0
        write_text(figure, left + width, top + _HEAD_PX - 6, "equal %", ha="right", fontsize=8.4)
        axes = place_axes(figure, left + label, top + _HEAD_PX, width - label - right, _ROW_PX * len(pairs))
        axes.set_xlim(-0.42 * reach, reach)
        axes.set_ylim(len(pairs), 0)
        axes.set_yticks([])
        axes.axvspan(-EQUIVALENT_BELOW, EQUIVALENT_BELOW, color=LINE, linewidth=0, zorder=0)
        axes.axvline(0, color=INK_3, linewidth=0.75, zorder=1)
        step = 1 if reach < 4 else 2
        ticks = [t for t in range(-step, int(reach) + 1, step) if t > -0.42 * reach]
        axes.set_xticks(ticks, [str(t).replace("-", "\u2212") for t in ticks])
        bottom = top + _HEAD_PX + _ROW_PX * len(pairs) + 15
        write_text(figure, left + label - 8, bottom, "difference [logit]", ha="right", fontsize=8.4)
        for row, e in enumerate(pairs):
            turned = e.difference_mean < 0
            mean, low, high = e.difference_mean, e.difference_hdi_low, e.difference_hdi_high
            first, second = names[e.mode_i], names[e.mode_j]
            if turned:
                mean, low, high, first, second = -mean, -high, -low, second, first
            axes.hlines(row + 0.5, low, high, color=DATA, linewidth=1.15, zorder=3)
            is_equal = e.reading == "equal in practice"
            face = DATA if e.reading == "different" else SUNKEN if is_equal else "white"
            axes.plot(
                [mean],
                [row + 0.5],
                "s" if is_equal else "o",
                markersize=6,
                markerfacecolor=face,
                markeredgecolor=DATA,
                markeredgewidth=1.5,
                zorder=4,
            )
            y = top + _HEAD_PX + _ROW_PX * (row + 0.5) + 4
            text = fitted_pair(first, second, label - 8)
            write_text(figure, left + label - 8, y, text, ha="right", color=INK)
            write_text(
                figure,
                left + width,
                y,
                percent(e.p_equal),
                ha="right",
                color=INK if e.p_equal >= LIKELY else INK_2,
                weight="bold" if e.p_equal >= LIKELY else "normal",
            )

    said = [
        f"{one_line(e.question)}: {one_line(e.mode_i)} less {one_line(e.mode_j)} {e.difference_mean:+.2f}, "
        f"equal in "
        f"practice {percent_in_words(e.p_equal)}"
        for e in found[:24]
    ]
    heights = [_HEAD_PX + _ROW_PX * len(of[q.name]) + _FOOT_PX for q in shown]
    per_row = 1 if len(shown) == 1 or longest > _LONG_PX else 2
    alt = f"Differences of abilities by pair. {'; '.join(said)}."
    return draw_panels(heights, draw, per_row=per_row, name="differences", alt=alt, tag=tag)
