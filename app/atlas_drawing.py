"""The atlas drawn: gain, damping and joint speed of every mode against sigma."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from analysis.figures.style import Drawing
    from sim_trials.mode_atlas import ModeCurves

_ROW_PX, _TOP_PX, _LEFT_PX, _GAP_PX = 96, 44, 118, 26
_MOST_SIGMA, _MOST_DAMPING = 0.32, 1.0
_ROOM = 1.08
"""How much higher a panel is than its highest number."""
_TITLES = ("gain", "damping \u03bb it amounts to", "fastest joint, share of its limit")


def draw_curves(curves: "Sequence[ModeCurves]") -> "Drawing":
    """A row a mode, all others faint behind it; lines differ by dashes, never by hue."""
    from analysis.figures.style import INK, INK_2, WIDTH_PX, finish, house_style, new_figure, write_text

    width = (WIDTH_PX - _LEFT_PX - 2 * _GAP_PX - 8) / 3
    with house_style():
        figure = new_figure(_TOP_PX + len(curves) * _ROW_PX + 34)
        for column, title in enumerate(_TITLES):
            left = _LEFT_PX + column * (width + _GAP_PX)
            write_text(figure, left, 16, title, fontsize=9, color=INK)
            most = (1.0, _MOST_DAMPING, _most_speed(curves))[column]
            for row, shown in enumerate(curves):
                axes = _panel(figure, left, _TOP_PX + row * _ROW_PX, width, most, row == len(curves) - 1)
                for other in curves:
                    _draw_pair(axes, other, column, most, is_shown=False)
                _draw_pair(axes, shown, column, most, is_shown=True)
        for k, line in enumerate(("solid: towards the lock", "dashed: out of it,", "where it differs")):
            write_text(figure, 0, 14 + 11 * k, line, fontsize=7.8, color=INK_2)
        for row, shown in enumerate(curves):
            middle = _TOP_PX + row * _ROW_PX + 0.4 * _ROW_PX
            for line in _lines(shown.mode.name, 9.6, bold=True):
                write_text(figure, 0, middle, line, fontsize=9.6, color=INK, weight="bold")
                middle += 14
            if shown.mode.method.name != shown.mode.name:
                for line in _lines(shown.mode.method.name, 7.8):
                    write_text(figure, 0, middle, line, fontsize=7.8)
                    middle += 11
        bottom = _TOP_PX + len(curves) * _ROW_PX + 22
        write_text(
            figure, _LEFT_PX, bottom, "smallest singular value \u03c3; the lock is at the right", fontsize=8.2
        )
        return finish(figure, "mode_atlas", _alt(curves))


def _lines(name: str, size_pt: float, bold: bool = False) -> list[str]:
    """A name in as many lines as it needs, parted after underscores."""
    from analysis.figures.labels import fitted, width_px

    room, lines = _LEFT_PX - 24, [""]
    for part in re.findall("[^_]*_?", name):
        if lines[-1] and width_px(lines[-1] + part, size_pt, bold) > room:
            lines.append("")
        lines[-1] += part
    return [fitted(line, room, size_pt, bold) for line in lines]


def _alt(curves: "Sequence[ModeCurves]") -> str:
    """The figure for those who do not see it; the numbers stand in the table beside it."""
    said = [
        f"{shown.mode.name} falls to {shown.towards.gain.min():.2f} towards the lock and"
        f" {shown.away.gain.min():.2f} out of it"
        for shown in curves
    ]
    return (
        "Gain, the damping it amounts to and the fastest joint against the smallest singular value."
        f" Gain: {'; '.join(said)}."
    )


def _most_speed(curves: "Sequence[ModeCurves]") -> float:
    fastest = max(float(c.joint_speed.max()) for m in curves for c in (m.towards, m.away))
    return next((top for top in (0.2, 0.4, 0.6) if fastest <= top), 1.0)


def _panel(figure: "Figure", left: float, top: float, width: float, most: float, is_last: bool) -> "Axes":
    from analysis.figures.style import LINE_STRONG, place_axes

    axes = place_axes(figure, left, top, width, _ROW_PX - 22)
    axes.set_xlim(_MOST_SIGMA, 0.0)
    axes.set_ylim(0.0, _ROOM * most)
    axes.set_yticks([0.0, most / 2.0, most], ["0", f"{most / 2.0:g}", f"{most:g}"])
    axes.set_xticks([0.3, 0.2, 0.1, 0.0], ["0.3", "0.2", "0.1", "0"] if is_last else [""] * 4)
    axes.tick_params(labelsize=7.6)
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(True)
        axes.spines[side].set_color(LINE_STRONG)
        axes.spines[side].set_linewidth(0.8)
    return axes


def _draw_pair(axes: "Axes", curves: "ModeCurves", column: int, most: float, is_shown: bool) -> None:
    """Both ways as lines; as one where they are the same. What lies beyond the panel runs along its edge."""
    from analysis.figures.style import DATA, LINE

    ways = [(curve.gain, curve.damping, curve.joint_speed)[column] for curve in (curves.towards, curves.away)]
    # Lines behind the shown one need few points: a drawing of all methods has over a thousand of them.
    every = slice(None) if is_shown else slice(None, None, 4)
    for values, dashes in zip(ways, ("-", (0, (3.5, 2))), strict=True):
        if values is ways[1] and np.allclose(ways[0], ways[1], rtol=1e-6):
            continue
        axes.plot(
            curves.sigma[every],
            np.minimum(values, _ROOM * most)[every],
            linestyle=dashes,
            color=DATA if is_shown else LINE,
            linewidth=1.7 if is_shown else 0.8,
            zorder=3 if is_shown else 1,
        )
