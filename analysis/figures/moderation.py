"""Differences of worth between two groups of people: a row of small panels for each background question."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from analysis.figures.labels import distinct, fitted, one_line
from analysis.figures.style import (
    DATA,
    INK,
    INK_3,
    LINE,
    PAGE_HEIGHT_PX,
    WIDTH_PX,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)
from analysis.moderation import GroupDifference
from data.responses import QuestionScale

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_COLUMNS = 6
_LABEL_PX, _GAP_PX, _ROW_PX, _TITLE_PX, _HEAD_PX, _TICKS_PX = 112, 14, 18, 22, 34, 30


def draw_moderation(
    questions: Sequence[QuestionScale],
    found: Sequence[GroupDifference],
    modes: tuple[str, ...],
    tag: str = "",
) -> tuple[Drawing, ...]:
    """Worth in the second group less that in the first: a row a mode, a column a question."""
    backgrounds = list(dict.fromkeys(d.background for d in found))
    shown = [q for q in questions if any(d.question == q.name for d in found)]
    reach = 1.08 * max(max(abs(d.difference_hdi_low), abs(d.difference_hdi_high)) for d in found)
    height = _TITLE_PX + _HEAD_PX + _ROW_PX * len(modes) + _TICKS_PX
    blocks = [
        (background, shown[k : k + MOST_COLUMNS])
        for background in backgrounds
        for k in range(0, len(shown), MOST_COLUMNS)
    ]
    most = max(1, int(PAGE_HEIGHT_PX // height))
    parts = [blocks[k : k + most] for k in range(0, len(blocks), most)]
    drawings = []
    with house_style():
        for number, part in enumerate(parts):
            figure = new_figure(height * len(part) + 12)
            for row, (background, columns) in enumerate(part):
                own = [d for d in found if d.background == background]
                _draw_block(figure, own, columns, modes, height * row, reach)
            name = "groups" if len(parts) == 1 else f"groups_{number + 1}"
            drawings.append(finish(figure, name, _alt(found), tag))
    return tuple(drawings)


def _draw_block(
    figure: "Figure",
    own: Sequence[GroupDifference],
    columns: Sequence[QuestionScale],
    modes: tuple[str, ...],
    top: float,
    reach: float,
) -> None:
    name, one = one_line(own[0].background), own[0]
    title = fitted(f"{name}: right of 0 more worth among {one.second}, left among {one.first}", WIDTH_PX, 9)
    write_text(figure, 0, top + 14, title, color=INK)
    width = min(160.0, (WIDTH_PX - _LABEL_PX) / len(columns) - _GAP_PX)
    first_row = top + _TITLE_PX + _HEAD_PX
    for row, text in enumerate(distinct(modes, 16)):
        y = first_row + _ROW_PX * (row + 0.5) + 4
        write_text(figure, _LABEL_PX - 8, y, fitted(text, _LABEL_PX - 10), ha="right", color=INK)
    for column, question in enumerate(columns):
        left = _LABEL_PX + column * (width + _GAP_PX)
        heading = fitted(one_line(question.name), width, 9.6, bold=True)
        write_text(
            figure,
            left + width / 2,
            top + _TITLE_PX + 14,
            heading,
            ha="center",
            weight="bold",
            fontsize=9.6,
            color=INK,
        )
        short = fitted(one_line(question.short), width + 8, 7.8)
        if short != heading:
            write_text(figure, left + width / 2, top + _TITLE_PX + 27, short, ha="center", fontsize=7.8)
        axes = place_axes(figure, left, first_row, width, _ROW_PX * len(modes))
        axes.set_xlim(-reach, reach)
        axes.set_ylim(len(modes), 0)
        axes.set_yticks([])
        step = next(s for s in (0.05, 0.1, 0.2, 0.5) if reach / s < 3 or s == 0.5)
        ticks = [k * step for k in (-1, 0, 1) if abs(k * step) < reach]
        axes.set_xticks(ticks, [f"{t:+.2g}".replace("-", "\u2212") if t else "0" for t in ticks])
        axes.vlines([t for t in ticks if t], 0, len(modes), color=LINE, linewidth=0.75, zorder=0)
        axes.axvline(0, color=INK_3, linewidth=0.9, zorder=1)
        for d in own:
            if d.question != question.name:
                continue
            y = modes.index(d.mode) + 0.5
            axes.hlines(y, d.difference_hdi_low, d.difference_hdi_high, color=DATA, linewidth=1.15, zorder=3)
            axes.plot(
                [d.difference_mean],
                [y],
                "o",
                markersize=5.6,
                markerfacecolor=DATA if d.is_clear else "white",
                markeredgecolor=DATA,
                markeredgewidth=1.4,
                zorder=4,
            )


def _alt(found: Sequence[GroupDifference]) -> str:
    said = [
        f"{one_line(d.background)}, {one_line(d.question)}, {one_line(d.mode)}: {d.difference_mean:+.2f} "
        f"[{d.difference_hdi_low:+.2f}, {d.difference_hdi_high:+.2f}]"
        for d in found[:24]
    ]
    return f"Difference of worth between groups of people, mean [94 % interval]. {'; '.join(said)}."
