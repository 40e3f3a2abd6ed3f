"""Worth beside what was measured: one small picture a question and metric, intervals both ways."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from analysis.figures.labels import fitted, one_line, width_px
from analysis.figures.style import (
    DATA,
    INK,
    INK_2,
    LINE,
    LINE_STRONG,
    MARKERS,
    WIDTH_PX,
    Drawing,
    draw_point,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)
from analysis.measures import Measure, ModeMeasure
from analysis.results import QuestionFit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_COLUMNS = 6
_LABEL_PX, _CELL_PX, _GAP_PX, _HEAD_PX, _FOOT_PX, _KEY_LINE_PX = 118, 84, 12, 40, 26, 19


def draw_association(
    questions: Sequence[QuestionFit],
    measures: Sequence[Measure],
    found: Sequence[ModeMeasure],
    modes: tuple[str, ...],
    tag: str = "",
) -> tuple[Drawing, ...]:
    """A row a metric, a column a ranked question; as many drawings as columns need."""
    shown = [q for q in questions if q.ranked]
    parts = [shown[k : k + MOST_COLUMNS] for k in range(0, len(shown), MOST_COLUMNS)]
    alt = _alt(measures, found)
    drawings = []
    with house_style():
        for number, part in enumerate(parts):
            key = _key(modes)
            below = _HEAD_PX + len(measures) * (_CELL_PX + _GAP_PX) + _FOOT_PX
            height = below + _KEY_LINE_PX * len(key)
            figure = new_figure(height)
            width = min(150.0, (WIDTH_PX - _LABEL_PX) / len(part) - _GAP_PX)
            high = max(m.worth_hdi_high for q in part for m in q.modes)
            for column, question in enumerate(part):
                left = _LABEL_PX + column * (width + _GAP_PX)
                name = fitted(one_line(question.question.name), width, 9.6, bold=True)
                short = fitted(one_line(question.question.short), width + 8, 7.8)
                write_text(
                    figure, left + width / 2, 14, name, ha="center", weight="bold", fontsize=9.6, color=INK
                )
                if short != name:
                    write_text(figure, left + width / 2, 28, short, ha="center", fontsize=7.8)
                for row, measure in enumerate(measures):
                    top = _HEAD_PX + row * (_CELL_PX + _GAP_PX)
                    own = [m for m in found if m.metric == measure.name]
                    is_last, is_first = row == len(measures) - 1, column == 0
                    _draw_cell(figure, question, own, modes, (left, top, width), high, is_first, is_last)
            for row, measure in enumerate(measures):
                top = _HEAD_PX + row * (_CELL_PX + _GAP_PX)
                lines = _wrapped(measure.words)
                for k, text in enumerate([*lines, *([f"[{measure.unit}]"] if measure.unit else [])]):
                    write_text(figure, 0, top + 26 + 13 * k, text, color=INK if k < len(lines) else INK_2)
            write_text(figure, 0, below, "across: worth", fontsize=8.4)
            for line, entries in enumerate(key):
                _draw_key_line(figure, below + _KEY_LINE_PX * line, entries)
            name = "association" if len(parts) == 1 else f"association_{number + 1}"
            drawings.append(finish(figure, name, alt, tag))
    return tuple(drawings)


def _draw_cell(
    figure: "Figure",
    question: QuestionFit,
    own: Sequence[ModeMeasure],
    modes: tuple[str, ...],
    place: tuple[float, float, float],
    high: float,
    is_first: bool,
    is_last: bool,
) -> None:
    left, top, width = place
    axes = place_axes(figure, left, top, width, _CELL_PX)
    for side in ("left", "bottom"):
        axes.spines[side].set(visible=True, color=LINE_STRONG, linewidth=0.75)
    ends = [v for m in own for v in (m.low, m.high, m.mean) if not np.isnan(v)]
    low_end, high_end = min(ends), max(ends)
    pad = 0.12 * (high_end - low_end or 1.0)
    axes.set_xlim(-0.06 * high, high * 1.03)
    axes.set_ylim(low_end - pad, high_end + pad)
    ticks = [t for t in (0, 0.2, 0.4, 0.6, 0.8) if t <= high]
    axes.vlines(ticks, low_end - pad, high_end + pad, color=LINE, linewidth=0.6, zorder=0)
    axes.set_xticks(ticks, ["0" if not t else f".{round(10 * t)}" for t in ticks] if is_last else [])
    marks = [low_end, high_end]
    digits = 0 if high_end - low_end > 20 else 1 if high_end - low_end > 1 else 2
    axes.set_yticks(marks, [f"{m:.{digits}f}" for m in marks] if is_first else [])
    axes.tick_params(labelsize=7.6, pad=2)
    results = {m.mode: m for m in question.modes}
    for measured in own:
        worth = results.get(measured.mode)
        if worth is None:
            continue
        if not np.isnan(measured.low):
            axes.vlines(worth.worth_mean, measured.low, measured.high, color=DATA, linewidth=0.9)
        axes.hlines(measured.mean, worth.worth_hdi_low, worth.worth_hdi_high, color=DATA, linewidth=0.9)
        draw_point(
            axes, worth.worth_mean, measured.mean, modes.index(measured.mode), len(modes) > len(MARKERS)
        )


@dataclass(frozen=True)
class _Entry:
    """A mode in the key, and where it begins [px]."""

    place: int
    text: str
    left: float


def _key(modes: tuple[str, ...]) -> list[list[_Entry]]:
    """The lines of the key; none where there are more modes than markers, and none has its own."""
    if len(modes) > len(MARKERS):
        return []
    lines: list[list[_Entry]] = [[]]
    x = float(_LABEL_PX)
    for k, mode in enumerate(modes):
        text = fitted(mode, 200, 8.4)
        width = 17 + width_px(text, 8.4) + 18
        if x + width > WIDTH_PX and lines[-1]:
            lines.append([])
            x = float(_LABEL_PX)
        lines[-1].append(_Entry(k, text, x))
        x += width
    return lines


def _draw_key_line(figure: "Figure", y: float, entries: Sequence[_Entry]) -> None:
    for entry in entries:
        swatch = place_axes(figure, entry.left, y - 9, 12, 12)
        swatch.set_xticks([])
        swatch.set_yticks([])
        swatch.set_xlim(-1, 1)
        swatch.set_ylim(-1, 1)
        draw_point(swatch, 0, 0, entry.place)
        write_text(figure, entry.left + 17, y, entry.text, fontsize=8.4)


def _wrapped(words: str) -> list[str]:
    lines = [""]
    for word in words.split():
        if len(lines[-1]) + len(word) > 15 and lines[-1]:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def _alt(measures: Sequence[Measure], found: Sequence[ModeMeasure]) -> str:
    said = []
    for measure in measures:
        own = ", ".join(f"{one_line(m.mode)} {m.mean:.3g}" for m in found if m.metric == measure.name)
        said.append(f"{measure.words}: {own}")
    return f"Worth of each mode beside its mean metrics. {'; '.join(said[:8])}."
