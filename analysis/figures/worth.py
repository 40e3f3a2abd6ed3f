"""The worth of every mode on every question, with its uncertainty."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from analysis.figures.labels import LIKELY, distinct, fitted, one_line, percent, width_px
from analysis.figures.style import (
    DATA,
    INK,
    INK_2,
    INK_3,
    LINE,
    PAGE_HEIGHT_PX,
    PART_HEIGHT_PX,
    WIDTH_PX,
    Drawing,
    draw_point,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_heading,
    write_text,
)
from analysis.results import ModeResult, QuestionFit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_SHAPES = 8
_SLOT_PX = 25
_AXIS_PX = 52
_FIRST_PAGE_PX = 560
"""What the first page leaves below the title and the first paragraph."""


def draw_worth(
    questions: Sequence[QuestionFit], modes: tuple[str, ...], tag: str = ""
) -> tuple[Drawing, ...]:
    """Worths with 94 % and 50 % intervals and, beside or below each, the chance to rank first.

    Few modes with short names stand side by side, as columns; otherwise every mode is a row, and more
    than eight modes are sorted by worth. What does not fit on one page becomes a further drawing.
    """
    with house_style():
        if _fits_in_columns(questions, modes):
            return _columns(questions, modes, tag)
        return _rows(questions, modes, tag)


def describe(question: QuestionFit) -> str:
    """The worths of one question in a sentence, for who cannot see the figure."""
    name = f"{one_line(question.question.name)} ({one_line(question.question.short)})"
    if not question.ranked:
        return f"{name}: not ranked."
    ordered = sorted(question.modes, key=lambda m: -m.worth_mean)
    parts = [
        f"{one_line(m.mode)} {m.worth_mean:.2f} [{m.worth_hdi_low:.2f}, {m.worth_hdi_high:.2f}], "
        f"first {percent(m.p_best)} %"
        for m in ordered[:_MOST_SHAPES]
    ]
    rest = f"; and {len(ordered) - _MOST_SHAPES} more" if len(ordered) > _MOST_SHAPES else ""
    return f"{name}: {'; '.join(parts)}{rest}."


def _alt(questions: Sequence[QuestionFit]) -> str:
    return "Worth by question, mean [94 % interval]. " + " ".join(describe(q) for q in questions)


def _fits_in_columns(questions: Sequence[QuestionFit], modes: tuple[str, ...]) -> bool:
    widest = max(width_px(one_line(mode)) for mode in modes)
    return len(questions) > 1 and len(modes) <= _MOST_SHAPES and widest <= _SLOT_PX * 1.1


def _scale_top(questions: Sequence[QuestionFit]) -> tuple[float, float]:
    """Upper end of the worth axis and the step between its lines."""
    highest = max((m.worth_hdi_high for q in questions for m in q.modes), default=1.0)
    step = 0.2 if highest > 0.4 else 0.1 if highest > 0.2 else 0.05 if highest > 0.1 else 0.02
    return min(1.0, step * math.ceil(highest / step + 0.05)), step


def _tick(value: float) -> str:
    return "0" if value < 1e-9 else "1" if value > 1 - 1e-9 else f"{value:.2f}".rstrip("0").lstrip("0")


def _columns(questions: Sequence[QuestionFit], modes: tuple[str, ...], tag: str) -> tuple[Drawing, ...]:
    room = WIDTH_PX - _AXIS_PX
    slots = len(modes) + 0.6
    per_row = max(1, min(int(room / (slots * _SLOT_PX)), len(questions)))
    rows = math.ceil(len(questions) / per_row)
    per_row = math.ceil(len(questions) / rows)
    group = min(room / per_row, slots * 60)
    row_height, rows_per_part = 270, 3
    drawings = []
    parts = math.ceil(rows / rows_per_part)
    top, step = _scale_top(questions)
    for part in range(parts):
        first = part * rows_per_part * per_row
        shown = questions[first : first + rows_per_part * per_row]
        figure = new_figure(row_height * math.ceil(len(shown) / per_row) + (14 if tag else 0))
        for row in range(math.ceil(len(shown) / per_row)):
            in_row = shown[row * per_row : (row + 1) * per_row]
            _draw_row_of_columns(figure, in_row, modes, row * row_height, group, top, step)
        name = "worth" if parts == 1 else f"worth_{part + 1}"
        drawings.append(finish(figure, name, _alt(shown), tag))
    return tuple(drawings)


def _draw_row_of_columns(
    figure: "Figure",
    questions: Sequence[QuestionFit],
    modes: tuple[str, ...],
    offset: float,
    group: float,
    top: float,
    step: float,
) -> None:
    plot_top, plot_height = offset + 8, 172
    width = group * len(questions)
    axes = place_axes(figure, _AXIS_PX, plot_top, width, plot_height)
    axes.set_xlim(0, len(questions))
    axes.set_ylim(0, top)
    axes.set_xticks([])
    ticks = [k * step for k in range(round(top / step) + 1)]
    axes.set_yticks(ticks, [_tick(t) for t in ticks])
    axes.hlines(ticks, 0, len(questions), color=LINE, linewidth=0.75, zorder=0)
    axes.hlines(1 / len(modes), 0, len(questions), color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2)))
    base = plot_top + plot_height
    write_text(
        figure, 12, plot_top + plot_height / 2, "worth", rotation=90, ha="center", va="center", fontsize=8.4
    )
    write_text(figure, _AXIS_PX - 6, base + 36, "first %", ha="right", fontsize=8.4)
    lines = place_axes(figure, _AXIS_PX, plot_top, width, plot_height + 88)
    lines.set_xlim(0, len(questions))
    lines.set_ylim(plot_height + 88, 0)
    lines.set_xticks([])
    lines.set_yticks([])
    lines.hlines(plot_height + 44, 0, len(questions), color=LINE, linewidth=0.75)
    lines.vlines(range(1, len(questions)), 0, plot_height + 84, color=LINE, linewidth=0.75)
    for k, question in enumerate(questions):
        left = _AXIS_PX + group * k
        if question.ranked:
            for j, mode in enumerate(question.modes):
                place = (j + 0.75) / (len(modes) + 0.5)
                place_px = left + group * place
                _draw_upright(axes, k + place, mode, modes.index(mode.mode))
                write_text(figure, place_px, base + 17, one_line(mode.mode), ha="center", color=INK)
                _write_chance(figure, place_px, base + 36, mode.p_best, "center")
        else:
            write_text(figure, left + group / 2, plot_top + plot_height / 2 + 4, "not ranked", ha="center")
        name = fitted(question.question.name, group - 8, 9.6, bold=True)
        short = fitted(question.question.short, group - 2)
        middle = left + group / 2
        write_text(figure, middle, base + 64, name, ha="center", fontsize=9.6, color=INK, weight="bold")
        if one_line(question.question.short) != one_line(question.question.name):
            write_text(figure, middle, base + 79, short, ha="center")


def _write_chance(figure: "Figure", x: float, y: float, chance: float, align: str) -> None:
    likely = chance >= LIKELY
    weight, colour = ("bold", INK) if likely else ("normal", INK_2)
    write_text(figure, x, y, percent(chance), ha=align, weight=weight, color=colour)


def _draw_upright(axes: "Axes", x: float, mode: ModeResult, index: int) -> None:
    axes.vlines(x, mode.worth_hdi_low, mode.worth_hdi_high, color=DATA, linewidth=1.15)
    axes.vlines(x, mode.worth_50_low, mode.worth_50_high, color=DATA, linewidth=3.75, alpha=0.5)
    draw_point(axes, x, mode.worth_mean, index)


def _rows(questions: Sequence[QuestionFit], modes: tuple[str, ...], tag: str) -> tuple[Drawing, ...]:
    many = len(modes) > _MOST_SHAPES
    pitch = 24 if not many else max(8.2, min(20, (PAGE_HEIGHT_PX - 76) / len(modes)))
    height = 76 + pitch * len(modes)
    first = max(1, int(_FIRST_PAGE_PX / height))
    per_page = max(1, int(PART_HEIGHT_PX / height))
    starts = [0, *range(first, len(questions), per_page)]
    top, step = _scale_top(questions)
    drawings = []
    for part, (start, end) in enumerate(zip(starts, [*starts[1:], len(questions)], strict=True)):
        shown = questions[start:end]
        figure = new_figure(height * len(shown))
        for k, question in enumerate(shown):
            _draw_panel_of_rows(figure, question, modes, k * height, pitch, top, step)
        name = "worth" if len(starts) == 1 else f"worth_{part + 1}"
        drawings.append(finish(figure, name, _alt(shown), tag))
    return tuple(drawings)


def _draw_panel_of_rows(
    figure: "Figure",
    question: QuestionFit,
    modes: tuple[str, ...],
    offset: float,
    pitch: float,
    top: float,
    step: float,
) -> None:
    many = len(modes) > _MOST_SHAPES
    size = 9 if pitch >= 15 else 0.72 * pitch * 0.8
    names = dict(zip(modes, distinct(modes, 26), strict=True))
    left = min(200.0, max(60.0, 14 + max(width_px(name, size) for name in names.values())))
    right, plot_top, plot_height = 60, offset + 38, pitch * len(modes)
    write_heading(figure, 0, offset + 18, question.question, 560)
    axes = place_axes(figure, left, plot_top, WIDTH_PX - left - right, plot_height)
    axes.set_xlim(0, top)
    axes.set_ylim(len(modes) - 0.5, -0.5)
    ticks = [k * step for k in range(round(top / step) + 1)]
    axes.set_xticks(ticks, [_tick(t) for t in ticks])
    axes.set_yticks([])
    write_text(figure, left - 12, plot_top + plot_height + 15, "worth", ha="right", fontsize=8.4)
    axes.vlines(ticks, -0.5, len(modes) - 0.5, color=LINE, linewidth=0.75, zorder=0)
    axes.vlines(1 / len(modes), -0.5, len(modes) - 0.5, color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2)))
    if not question.ranked:
        write_text(figure, left + 12, plot_top + plot_height / 2 + 4, "not ranked", color=INK_2)
        return
    write_text(figure, WIDTH_PX - 4, plot_top - 8, "first %", ha="right", fontsize=8.4)
    results = list(question.modes)
    if many:
        results.sort(key=lambda m: -m.worth_mean)
    rows = range(len(results))
    wide = [m.worth_hdi_low for m in results], [m.worth_hdi_high for m in results]
    narrow = [m.worth_50_low for m in results], [m.worth_50_high for m in results]
    axes.hlines(rows, *wide, color=DATA, linewidth=1.15)
    axes.hlines(rows, *narrow, color=DATA, linewidth=min(3.75, 0.3 * pitch), alpha=0.5)
    for row, mode in enumerate(results):
        draw_point(axes, mode.worth_mean, row, modes.index(mode.mode), many)
        y = plot_top + pitch * (row + 0.5) + size * 0.45
        write_text(
            figure,
            left - 12,
            y,
            fitted(names[mode.mode], left - 12, size),
            ha="right",
            color=INK,
            fontsize=size,
        )
        weight, colour = ("bold", INK) if mode.p_best >= LIKELY else ("normal", INK_2)
        write_text(
            figure,
            WIDTH_PX - 4,
            y,
            percent(mode.p_best),
            ha="right",
            fontsize=size,
            weight=weight,
            color=colour,
        )
