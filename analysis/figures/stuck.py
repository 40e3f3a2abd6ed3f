"""How often the robot got stuck under each mode."""

from collections.abc import Sequence

from analysis.figures.labels import distinct, fitted, one_line, width_px
from analysis.figures.style import (
    DATA,
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
from analysis.stuck import StuckRate


def draw_stuck(rates: Sequence[StuckRate], tag: str = "") -> Drawing:
    """Rates with intervals, one row a mode, and the counts behind them."""
    with house_style():
        modes = tuple(rate.mode for rate in rates)
        pitch = 26 if len(rates) <= 24 else 14
        names = distinct(modes, 26)
        left = min(200.0, max(60.0, 14 + max(width_px(name) for name in names)))
        right, top, height = 96, 24, pitch * len(rates)
        figure = new_figure(top + height + 40)
        axes = place_axes(figure, left, top, WIDTH_PX - left - right, height)
        highest = max(0.2, *(rate.rate_hdi_high for rate in rates))
        step = 0.2 if highest > 0.5 else 0.1 if highest > 0.2 else 0.05
        limit = min(1.0, step * (int(highest / step) + 1))
        ticks = [k * step for k in range(round(limit / step) + 1)]
        axes.set_xlim(0, limit)
        axes.set_ylim(len(rates), 0)
        axes.set_yticks([])
        axes.set_xticks(ticks, [f"{100 * t:.0f} %" for t in ticks])
        axes.vlines(ticks, 0, len(rates), color=LINE, linewidth=0.75, zorder=0)
        write_text(figure, WIDTH_PX, top - 8, "stuck / comparisons", ha="right", fontsize=8.4)
        for row, (rate, name) in enumerate(zip(rates, names, strict=True)):
            axes.hlines(row + 0.5, rate.rate_hdi_low, rate.rate_hdi_high, color=DATA, linewidth=1.15)
            draw_point(axes, rate.rate_mean, row + 0.5, row, len(rates) > 8)
            y = top + pitch * (row + 0.5) + 4
            write_text(figure, left - 12, y, fitted(name, left - 12), ha="right", color=INK)
            write_text(figure, WIDTH_PX, y, f"{rate.stuck} / {rate.comparisons}", ha="right", color=INK_2)
        said = "; ".join(f"{one_line(r.mode)} {r.stuck} of {r.comparisons}" for r in rates)
        return finish(figure, "stuck", f"Comparisons with the robot stuck: {said}.", tag)
