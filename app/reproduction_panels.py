"""What the figures of all reproductions share: panels side by side, lines that differ by dash and hue."""

from typing import TYPE_CHECKING

import pandas as pd

from analysis.figures.style import (
    DATA,
    DATA_2,
    INK_2,
    LINE,
    WIDTH_PX,
    new_figure,
    place_axes,
    write_text,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LINES: tuple[tuple[str, str], ...] = (
    (DATA, "-"),
    (DATA_2, "--"),
    ("#9A5B2C", "-."),
    (INK_2, ":"),
    ("#5D7A3A", "-"),
    ("#8C4A6B", "--"),
    ("#3F3F3F", "-."),
)
PANEL_TOP, PANEL_HEIGHT, LEFT, GAP = 40, 190, 56, 62


def new_panels(titles: tuple[str, ...], room_px: float = 88) -> "tuple[Figure, list[Axes]]":
    """A figure with titled panels in a row, and so much room below them."""
    figure = new_figure(PANEL_TOP + PANEL_HEIGHT + room_px)
    width = (WIDTH_PX - LEFT - 12 - GAP * (len(titles) - 1)) / len(titles)
    panels = []
    for k, title in enumerate(titles):
        left = LEFT + k * (width + GAP)
        panels.append(place_axes(figure, left, PANEL_TOP, width, PANEL_HEIGHT))
        write_text(figure, left, PANEL_TOP - 14, title, fontsize=9.6)
    return figure, panels


def draw_line(panel: "Axes", x: pd.Series, y: pd.Series, line: tuple[str, str], label: str) -> None:
    """One curve; NaN leaves a gap."""
    panel.plot(x, y, color=line[0], linestyle=line[1], linewidth=1.3, label=label)


def label_axes(panel: "Axes", x: str, y: str) -> None:
    """What the axes are, with a faint grid."""
    panel.set_xlabel(x, fontsize=8.6, color=INK_2)
    panel.set_ylabel(y, fontsize=8.6, labelpad=2, color=INK_2)
    panel.grid(color=LINE, linewidth=0.6)
    panel.set_axisbelow(True)


def add_legend(panel: "Axes", columns: int = 4) -> None:
    """The key, below the panel and its axis."""
    figure = panel.get_figure(root=True)
    assert figure is not None
    below = -0.52 / (panel.get_position().height * float(figure.get_size_inches()[1]))
    panel.legend(
        loc="upper left",
        bbox_to_anchor=(-0.02, below),
        ncols=columns,
        fontsize=8,
        frameon=False,
        borderaxespad=0.0,
        labelcolor=INK_2,
    )


def share_heights(panels: "list[Axes]") -> None:
    """The same vertical axis for all panels, so that they can be compared by eye."""
    ends = [panel.get_ylim() for panel in panels]
    for panel in panels:
        panel.set_ylim(min(low for low, _ in ends), max(high for _, high in ends))
