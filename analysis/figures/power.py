"""The power curve: how often studies of each size come to the right conclusion."""

from typing import TYPE_CHECKING

from analysis.figures.style import (
    DATA,
    INK,
    INK_2,
    INK_3,
    LINE,
    SURFACE,
    WIDTH_PX,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)

if TYPE_CHECKING:
    from analysis.power import Power

_LEFT, _TOP, _WIDTH, _HEIGHT = 52.0, 56.0, WIDTH_PX - 76.0, 240.0


def draw_power(result: "Power", wanted: float) -> Drawing:
    """Share of right conclusions over the number of participants, with 94 % intervals."""
    sizes = [point.participants for point in result.points]
    with house_style():
        figure = new_figure(_TOP + _HEIGHT + 52)
        write_text(figure, 0, 16, "Studies that find the planted best mode", color=INK, weight="bold")
        write_text(figure, 0, 36, result.scenario.sentence, color=INK_2)
        axes = place_axes(figure, _LEFT, _TOP, _WIDTH, _HEIGHT)
        margin = 0.06 * (sizes[-1] - sizes[0] or 1)
        axes.set_xlim(sizes[0] - margin, sizes[-1] + margin)
        axes.set_ylim(0, 1)
        ticks = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
        axes.set_yticks(ticks, [f"{100 * t:.0f} %" for t in ticks])
        axes.set_xticks(sizes, [str(size) for size in sizes])
        axes.hlines(ticks, *axes.get_xlim(), color=LINE, linewidth=0.75, zorder=0)
        axes.axhline(wanted, color=INK_3, linewidth=0.9, linestyle=(0, (2, 3)), zorder=1)
        axes.plot(sizes, [p.right_share for p in result.points], color=DATA, linewidth=1.4, zorder=2)
        for point in result.points:
            axes.vlines(point.participants, point.low, point.high, color=DATA, linewidth=1.15, zorder=3)
            axes.plot(
                [point.participants], [point.right_share], marker="o", markersize=7, color=DATA,
                markerfacecolor=SURFACE, markeredgewidth=1.7, zorder=4, clip_on=False,
            )  # fmt: skip
        middle = _LEFT + _WIDTH / 2
        write_text(figure, middle, _TOP + _HEIGHT + 36, "participants", ha="center", color=INK_2)
        said = "; ".join(f"{p.participants} participants {100 * p.right_share:.0f} %" for p in result.points)
        return finish(figure, "power", f"Right conclusions: {said}.", "simulated for planning")
