"""Small panels side by side, one a question, in as many drawings as it takes."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from analysis.figures.style import PART_HEIGHT_PX, WIDTH_PX, Drawing, finish, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GAP_PX = 30
DrawPanel = Callable[["Figure", int, float, float, float], None]
"""Draws panel ``k`` at (left, top) with a width, all [px]."""


def draw_panels(
    heights: Sequence[float],
    draw: DrawPanel,
    *,
    per_row: int,
    name: str,
    alt: str,
    tag: str,
    foot: float = 0.0,
    draw_foot: "Callable[[Figure, float], None] | None" = None,
) -> tuple[Drawing, ...]:
    """Panels in reading order; a row is as high as its highest panel.

    Parameters
    ----------
    heights : sequence of float
        Of every panel [px].
    foot : float
        Room for a key below the panels of every drawing [px], drawn by ``draw_foot(figure, top)``.
    """
    width = (WIDTH_PX - GAP_PX * (per_row - 1)) / per_row
    rows = [list(range(k, min(k + per_row, len(heights)))) for k in range(0, len(heights), per_row)]
    parts: list[list[list[int]]] = [[]]
    used = 0.0
    for row in rows:
        height = max(heights[k] for k in row)
        if parts[-1] and used + height > PART_HEIGHT_PX:
            parts.append([])
            used = 0.0
        parts[-1].append(row)
        used += height
    drawings = []
    with house_style():
        for number, part in enumerate(parts):
            total = sum(max(heights[k] for k in row) for row in part)
            figure = new_figure(total + foot + 12)
            top = 0.0
            for row in part:
                for column, k in enumerate(row):
                    draw(figure, k, column * (width + GAP_PX), top, width)
                top += max(heights[k] for k in row)
            if draw_foot is not None:
                draw_foot(figure, top)
            drawings.append(finish(figure, name if len(parts) == 1 else f"{name}_{number + 1}", alt, tag))
    return tuple(drawings)
