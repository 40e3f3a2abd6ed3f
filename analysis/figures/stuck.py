"""How often the robot got stuck under each mode, per comparison and per minute."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from analysis.figures.labels import distinct, fitted, one_line, width_px
from analysis.figures.style import (
    DATA,
    DATA_2,
    INK,
    INK_2,
    LINE,
    WIDTH_PX,
    Drawing,
    draw_point,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)
from analysis.results import Quantity
from analysis.stuck import StuckRate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COUNTS_PX, _GAP_PX, _TOP_PX, _FOOT_PX = 64, 34, 40, 56
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)


@dataclass(frozen=True)
class _Row:
    """A rate with its interval, and the same over people."""

    mean: float
    low: float
    high: float
    over_people: tuple[float, float, float] | None


def draw_stuck(rates: Sequence[StuckRate], tag: str = "") -> Drawing:
    """Rates with intervals, one row a mode, and the counts; below each the rate in people in general."""
    with house_style():
        shares = [_Row(r.rate_mean, r.rate_hdi_low, r.rate_hdi_high, _numbers(r.between)) for r in rates]
        minutes = [
            _Row(own.mean, own.hdi_low, own.hdi_high, _numbers(r.per_minute_between))
            for r in rates
            if (own := r.per_minute) is not None
        ]
        panels = [("Share of comparisons", shares, True)]
        if len(minutes) == len(rates):
            panels.append(("Per minute of exposure", minutes, False))
        pitch = 30.0 if len(rates) <= 20 else 18.0
        names = distinct(tuple(rate.mode for rate in rates), 26)
        left = min(180.0, max(40.0, 14 + max(width_px(name) for name in names)))
        height = pitch * len(rates)
        figure = new_figure(_TOP_PX + height + _FOOT_PX)
        width = (WIDTH_PX - left - _COUNTS_PX - 12 - _GAP_PX * (len(panels) - 1)) / len(panels)
        for k, (title, rows, is_share) in enumerate(panels):
            x = left + k * (width + _GAP_PX)
            write_text(figure, x, 16, title, color=INK, weight="bold")
            axes = place_axes(figure, x, _TOP_PX - 8, width, height)
            _scale(axes, rows, is_share)
            for row, drawn in enumerate(rows):
                _draw_row(axes, row, drawn, len(rates))
        write_text(figure, WIDTH_PX, 16, "stuck", ha="right", fontsize=8.4)
        for row, (rate, name) in enumerate(zip(rates, names, strict=True)):
            y = _TOP_PX - 8 + pitch * (row + 0.5) + 3
            write_text(figure, left - 12, y, fitted(name, left - 12), ha="right", color=INK)
            write_text(figure, WIDTH_PX, y, f"{rate.stuck:,} / {rate.comparisons:,}", ha="right", color=INK_2)
        _write_key(figure, left, _TOP_PX + height + 38, any(row.over_people for row in shares))
        said = "; ".join(f"{one_line(r.mode)} {r.stuck} of {r.comparisons}" for r in rates)
        return finish(figure, "stuck", f"Comparisons with the robot stuck: {said}.", tag)


def _scale(axes: "Axes", rows: Sequence[_Row], is_share: bool) -> None:
    """A scale from 0 to above the highest interval, in about five steps."""
    highest = max(max(row.high, row.over_people[2] if row.over_people else 0.0) for row in rows)
    step = next((s for s in _STEPS if highest / s <= 5.0), _STEPS[-1])
    limit = step * (int(highest / step) + 1)
    if is_share:
        limit = min(1.0, limit)
    ticks = [k * step for k in range(round(limit / step) + 1)]
    axes.set_xlim(0, limit)
    axes.set_ylim(len(rows), 0)
    axes.set_yticks([])
    axes.set_xticks(ticks, [f"{100 * t:.0f} %" if is_share else f"{t:g}" for t in ticks])
    axes.vlines(ticks, 0, len(rows), color=LINE, linewidth=0.75, zorder=0)


def _draw_row(axes: "Axes", row: int, rate: _Row, modes: int) -> None:
    axes.hlines(row + 0.4, rate.low, rate.high, color=DATA, linewidth=1.15)
    if rate.over_people is not None:
        mean, low, high = rate.over_people
        axes.hlines(row + 0.74, low, high, color=DATA_2, linewidth=1.15)
        axes.vlines(mean, row + 0.63, row + 0.85, color=DATA_2, linewidth=2.0)
    draw_point(axes, rate.mean, row + 0.4, row, modes > 8)


def _numbers(q: Quantity | None) -> tuple[float, float, float] | None:
    return None if q is None else (q.mean, q.hdi_low, q.hdi_high)


def _write_key(figure: "Figure", left: float, base: float, over_people: bool) -> None:
    x = left
    marks = [(DATA, "these people and comparisons")]
    for colour, text in [*marks, *([(DATA_2, "people in general")] if over_people else [])]:
        mark = place_axes(figure, x, base - 8, 24, 8)
        mark.set_xlim(0, 1)
        mark.set_ylim(0, 1)
        mark.set_xticks([])
        mark.set_yticks([])
        mark.hlines(0.5, 0, 1, color=colour, linewidth=1.15)
        if colour == DATA_2:
            mark.vlines(0.5, 0.0, 1.0, color=colour, linewidth=2.0)
        else:
            mark.plot([0.5], [0.5], "o", color=colour, markersize=4.6, markeredgewidth=0)
        write_text(figure, x + 30, base, text, fontsize=8.4)
        x += 30 + width_px(text, 8.4) + 20
