"""The figures of the source documents, redrawn from the tables of their reproductions."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from analysis.figures.style import (
    DATA,
    DATA_2,
    INK_2,
    LINE,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)
from sim_trials.reproductions.mulumbwa.potential_field import OBSTACLE_RADIUS_M
from sim_trials.reproductions.verdict import Reproduction

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


def drawings(done: Reproduction) -> list[Drawing]:
    """All figures of one reproduction."""
    with house_style():
        draw = {"beaudoin2022": _beaudoin2022, "mulumbwa": _mulumbwa}
        return draw[done.name](done.tables)


def _beaudoin2022(tables: dict[str, pd.DataFrame]) -> list[Drawing]:
    courses = tables["courses"]
    found = []
    for number in (1, 2, 3):
        figure, panels = _panels(("no limits, λ² = 0.01", "limits on, λ² = 0.1, as printed"))
        for panel, reading in zip(panels, (0, 2), strict=True):
            part = courses[(courses["trajectory"] == number) & (courses["reading"] == reading)]
            for line, (strategy, rows) in zip(LINES, part.groupby("strategy", sort=False), strict=False):
                _draw(panel, rows["time_s"], rows["psi_deg"], line, str(strategy))
            _label(panel, "time [s]", "angle ψ [°]")
        _legend(panels[0])
        alt = (
            f"Angle between shell and link velocity over one period of trajectory {number}, three strategies."
        )
        found.append(finish(figure, f"figure_{number + 4}_trajectory_{number}", alt, f"as fig. {number + 4}"))
    return found


def _mulumbwa(tables: dict[str, pd.DataFrame]) -> list[Drawing]:
    table = tables["planar"]
    first = table[table["start_rad"] == table["start_rad"].iloc[0]]
    return [
        _by_method(
            first,
            "condition_number",
            "condition number",
            "figure_8_9_condition",
            "as figs. 8, 9",
            is_log=True,
        ),
        _by_method(first, "manipulability", "manipulability [m²]", "figure_10_manipulability", "as fig. 10"),
        _planar_joints(first),
        _humanoid_joints(tables["humanoid_angles"]),
        _obstacle(tables["obstacle_paths"], tables["obstacle"]),
    ]


def _by_method(
    table: pd.DataFrame, column: str, title: str, name: str, tag: str, is_log: bool = False
) -> Drawing:
    figure, panels = _panels(("target inside the workspace", "target outside the workspace"))
    for panel, where in zip(panels, ("inside", "outside"), strict=True):
        for line, (method, rows) in zip(
            LINES, table[table["target"] == where].groupby("method", sort=False), strict=False
        ):
            values = rows[column].replace([np.inf], np.nan)
            _draw(panel, rows["iteration"], values, line, str(method))
        if is_log:
            panel.set_yscale("log")
            panel.yaxis.set_major_formatter(lambda value, _: f"{value:.0e}".replace("e+0", "e"))
        _label(panel, "iteration", title)
    _legend(panels[0])
    return finish(figure, name, f"{title} by iteration, three methods, both targets, start stretched.", tag)


def _planar_joints(table: pd.DataFrame) -> Drawing:
    outside = table[table["target"] == "outside"]
    methods = tuple(outside["method"].unique())
    figure, panels = _panels(methods)
    for panel, method in zip(panels, methods, strict=True):
        _joints(panel, outside[outside["method"] == method], 3)
    _legend(panels[0])
    alt = "Joint angles of the planar arm by iteration for the target outside the workspace, by method."
    return finish(figure, "figure_11_13_planar_joints", alt, "as figs. 11 to 13")


def _humanoid_joints(table: pd.DataFrame) -> Drawing:
    runs = tuple(table["run"].unique())
    figure, panels = _panels(runs)
    for panel, run in zip(panels, runs, strict=True):
        _joints(panel, table[table["run"] == run], 7)
    _legend(panels[0])
    alt = "Joint angles of the humanoid arm by iteration, SVF+SDLS, target outside the workspace."
    return finish(figure, "figure_14_16_humanoid_joints", alt, "as figs. 14 to 16")


def _obstacle(paths: pd.DataFrame, ends: pd.DataFrame) -> Drawing:
    from matplotlib.patches import Circle

    figure = new_figure(480, 440)
    panel = place_axes(figure, LEFT, 24, 350, 350)
    panel.add_patch(Circle((0.0, 0.3), OBSTACLE_RADIUS_M, facecolor=LINE, edgecolor=INK_2))
    arrived = ends[~ends["as_printed"]].set_index("way")["has_arrived"]
    for line, (way, rows) in zip(LINES, paths.groupby("way"), strict=False):
        _draw(panel, rows["x_m"], rows["y_m"], line, f"{way} {'arrives' if arrived[way] else 'stays behind'}")
        panel.plot(rows["x_m"].iloc[:1], rows["y_m"].iloc[:1], "o", color=line[0], markersize=4)
    panel.set_aspect("equal")
    _label(panel, "x [m]", "y [m]")
    _legend(panel, columns=2)
    return finish(figure, "figure_17_obstacle", "Five ways past a round obstacle.", "as fig. 17")


def _panels(titles: tuple[str, ...]) -> "tuple[Figure, list[Axes]]":
    figure = new_figure(PANEL_TOP + PANEL_HEIGHT + 88)
    width = (666 - LEFT - 12 - GAP * (len(titles) - 1)) / len(titles)
    panels = []
    for k, title in enumerate(titles):
        left = LEFT + k * (width + GAP)
        panels.append(place_axes(figure, left, PANEL_TOP, width, PANEL_HEIGHT))
        write_text(figure, left, PANEL_TOP - 14, title, fontsize=9.6)
    return figure, panels


def _joints(panel: "Axes", rows: pd.DataFrame, n: int) -> None:
    for joint, line in zip(range(1, n + 1), LINES, strict=False):
        _draw(panel, rows["iteration"], np.degrees(rows[f"q{joint}_rad"]), line, f"joint {joint}")
    _label(panel, "iteration", "joint angle [°]")


def _draw(panel: "Axes", x: pd.Series, y: pd.Series, line: tuple[str, str], label: str) -> None:
    panel.plot(x, y, color=line[0], linestyle=line[1], linewidth=1.3, label=label)


def _label(panel: "Axes", x: str, y: str) -> None:
    panel.set_xlabel(x, fontsize=8.6, color=INK_2)
    panel.set_ylabel(y, fontsize=8.6, labelpad=2, color=INK_2)
    panel.grid(color=LINE, linewidth=0.6)
    panel.set_axisbelow(True)


def _legend(panel: "Axes", columns: int = 4) -> None:
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
