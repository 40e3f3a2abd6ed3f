"""The power curve: how often studies of each size conclude what is right, and what is wrong."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.figures.labels import apart, fitted
from analysis.figures.style import (
    DATA,
    DATA_2,
    DATA_TINT,
    INK,
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
from analysis.power.sentences import showings

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from analysis.power import Power

_LEFT, _TOP, _HEIGHT = 46.0, 74.0, 250.0
_RIGHT = 128.0
"""Room for the lines' names."""
_DASHES = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1, 2)))
_SHAPES = ("o", "s", "D", "^")


def draw_power(result: "Power") -> Drawing:
    """Shares of right and wrong conclusions over the number of participants, with 94 % intervals."""
    plan = result.plan
    sizes = sorted({point.participants for point in result.points})
    width = WIDTH_PX - _LEFT - _RIGHT
    with house_style():
        figure = new_figure(_TOP + _HEIGHT + 54)
        write_text(figure, 0, 16, "How often a study comes to the right conclusion", color=INK, weight="bold")
        concluded = plan.conclusion.sentence(plan.study.mode_names)
        write_text(figure, 0, 34, fitted(f"{concluded[0].upper()}{concluded[1:]}", WIDTH_PX))
        write_text(figure, 0, 51, fitted(f"Assumed: {plan.scenario.sentence}", WIDTH_PX))
        axes = place_axes(figure, _LEFT, _TOP, width, _HEIGHT)
        margin = 0.05 * (sizes[-1] - sizes[0] or 1)
        axes.set_xlim(sizes[0] - margin, sizes[-1] + margin)
        axes.set_ylim(0, 1)
        ticks = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
        axes.set_yticks(ticks, [f"{100 * t:.0f} %" for t in ticks])
        axes.set_xticks(sizes, [str(size) for size in sizes])
        axes.hlines(ticks, *axes.get_xlim(), color=LINE, linewidth=0.75, zorder=0)
        axes.axhline(plan.wanted, color=INK_3, linewidth=0.9, linestyle=(0, (2, 3)), zorder=1)
        names: list[tuple[float, str]] = []
        for index, repetitions in enumerate(result.repetitions):
            names += _draw(axes, result, repetitions, index)
        names.append((plan.wanted, "wanted"))
        for at, name in apart(names, 13 / _HEIGHT):
            y = _TOP + _HEIGHT * (1 - at) + 3
            write_text(figure, _LEFT + width + 8, y, fitted(name, _RIGHT - 8), fontsize=8.6)
        middle = _LEFT + width / 2
        write_text(figure, middle, _TOP + _HEIGHT + 34, "participants", ha="center")
        said = "; ".join(
            f"{p.participants} participants, {p.repetitions} showings of each pair: "
            f"{100 * p.right_share:.0f} % right, {100 * p.wrong_share:.0f} % wrong"
            for p in result.points
        )
        return finish(figure, "power", f"Conclusions of simulated studies: {said}.", "simulated for planning")


def _draw(axes: "Axes", result: "Power", repetitions: int, index: int) -> list[tuple[float, str]]:
    """The points and curves with so many repetitions; where their names belong."""
    points, curve = result.of(repetitions), result.curve(repetitions)
    shape, dash = _SHAPES[index % len(_SHAPES)], _DASHES[index % len(_DASHES)]
    sizes = [p.participants for p in points]
    if curve is not None:
        at = np.linspace(sizes[0], sizes[-1], 200)
        axes.fill_between(at, *curve.band(at), color=DATA_TINT, linewidth=0, alpha=0.75, zorder=1)
        axes.plot(at, curve.share(at), color=DATA, linewidth=1.4, linestyle=dash, zorder=2)
    axes.plot(sizes, [p.wrong_share for p in points], color=DATA_2, linewidth=1.0, linestyle=dash, zorder=2)
    # Intervals of several repetitions stand beside each other.
    step = 0.012 * (result.points[-1].participants - result.points[0].participants)
    for point in points:
        x = point.participants + step * (index - len(result.repetitions) // 2)
        axes.vlines(x, point.right_low, point.right_high, color=DATA, linewidth=1.15, zorder=3)
        axes.vlines(x, point.wrong_low, point.wrong_high, color=DATA_2, linewidth=1.15, zorder=3)
        for share, colour, face, size in (
            (point.right_share, DATA, SURFACE, 6.4),
            (point.wrong_share, DATA_2, DATA_2, 3.6),
        ):
            axes.plot(
                [x], [share], marker=shape, markersize=size, color=colour, markerfacecolor=face,
                markeredgewidth=size / 4, zorder=4, clip_on=False,
            )  # fmt: skip
    several = f", {showings(repetitions).lower()}" if len(result.repetitions) > 1 else ""
    names = [(points[-1].right_share, f"right{several}")]
    return names if index else [*names, (points[-1].wrong_share, "wrong")]
