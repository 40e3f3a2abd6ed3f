"""The figures of the source documents, redrawn from the tables of their reproductions."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from analysis.figures.style import (
    INK,
    INK_2,
    INK_3,
    LINE,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
)
from app.carmichael2017 import figures as carmichael2017
from app.reproduction_panels import (
    LEFT,
    LINES,
    add_legend,
    draw_line,
    label_axes,
    new_panels,
    share_heights,
)
from sim_trials.reproductions.mulumbwa.potential_field import OBSTACLE_RADIUS_M
from sim_trials.reproductions.verdict import Reproduction

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def drawings(done: Reproduction) -> list[Drawing]:
    """All figures of one reproduction."""
    draw = {"beaudoin2022": _beaudoin2022, "carmichael2017": carmichael2017.drawings, "mulumbwa": _mulumbwa}
    with house_style():
        return draw[done.name](done.tables)


PUBLISHED_PSI_DEG = (13.0, 25.0)
"""Largest psi in figure 6, as the text reads it off: two strategies, and the transpose."""


def _beaudoin2022(tables: dict[str, pd.DataFrame]) -> list[Drawing]:
    courses = tables["courses"]
    found = []
    for number in (1, 2, 3):
        figure, panels = new_panels(
            ("λ² = 0.01, no limits: fits its figures best", "λ² = 0.1, limits on: as its text says")
        )
        for panel, reading in zip(panels, (0, 2), strict=True):
            part = courses[(courses["trajectory"] == number) & (courses["reading"] == reading)]
            for line, (strategy, rows) in zip(LINES, part.groupby("strategy", sort=False), strict=False):
                draw_line(panel, rows["time_s"], rows["psi_deg"], line, str(strategy))
            label_axes(panel, "time [s]", "angle ψ [°]")
            if number == 2:
                for value in PUBLISHED_PSI_DEG:
                    panel.axhline(value, color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2)), zorder=1)
        share_heights(panels)
        add_legend(panels[0])
        alt = (
            "Angle ψ between the motion of the shell and the velocity of the link over one period of "
            f"trajectory {number}, three strategies, two of the readings tried. Gaps: shell or link turns "
            "back, and ψ means nothing."
        )
        if number == 2:
            alt += " Dotted: the largest ψ that the text gives, 13° and, for the transpose, 25°."
        tag = f"redrawn after fig. {number + 4}"
        found.append(finish(figure, f"figure_{number + 4}_trajectory_{number}", alt, tag))
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
            "redrawn after figs. 8, 9",
            "JP starts at infinity, which has no place here.",
            is_log=True,
        ),
        _by_method(
            first,
            "manipulability",
            "manipulability [m²]",
            "figure_10_manipulability",
            "redrawn after fig. 10",
            "Of each method's own (filtered) Jacobian. The thesis shows the target outside alone.",
        ),
        _planar_joints(first),
        _humanoid_joints(tables["humanoid_angles"]),
        _obstacle(tables["obstacle_paths"], tables["obstacle"]),
    ]


def _by_method(
    table: pd.DataFrame, column: str, title: str, name: str, tag: str, note: str, is_log: bool = False
) -> Drawing:
    figure, panels = new_panels(("target inside the workspace", "target outside the workspace"))
    for panel, where in zip(panels, ("inside", "outside"), strict=True):
        for line, (method, rows) in zip(
            LINES, table[table["target"] == where].groupby("method", sort=False), strict=False
        ):
            values = rows[column].replace([np.inf], np.nan)
            draw_line(panel, rows["iteration"], values, line, str(method))
        if is_log:
            panel.set_yscale("log")
            panel.yaxis.set_major_formatter(lambda value, _: f"{value:.0e}".replace("e+0", "e"))
        label_axes(panel, "iteration", title)
    share_heights(panels)
    add_legend(panels[0])
    alt = (
        f"{title[0].upper()}{title[1:]} by iteration, three methods, both targets, from q = 0 (stretched; "
        f"the thesis names no start). {note}"
    )
    return finish(figure, name, alt, tag)


def _planar_joints(table: pd.DataFrame) -> Drawing:
    outside = table[table["target"] == "outside"]
    methods = tuple(outside["method"].unique())
    figure, panels = new_panels(methods)
    for panel, method in zip(panels, methods, strict=True):
        _joints(panel, outside[outside["method"] == method], 3)
    add_legend(panels[0])
    alt = (
        "Joint angles of the planar arm by iteration, target outside the workspace, from q = 0. The "
        "vertical axes differ: JP and DLS turn by hundreds of degrees, SVF+SDLS by less than 50."
    )
    return finish(figure, "figure_11_13_planar_joints", alt, "redrawn after figs. 11 to 13")


def _humanoid_joints(table: pd.DataFrame) -> Drawing:
    runs = tuple(table["run"].unique())
    figure, panels = new_panels(runs)
    for panel, run in zip(panels, runs, strict=True):
        _joints(panel, table[table["run"] == run], 7)
    share_heights(panels)
    add_legend(panels[0])
    alt = (
        "Joint angles of the humanoid arm by iteration, SVF+SDLS, target outside the workspace: with one "
        "Euler set, with switching, and with joint limits in the null space. The first two are the same "
        "here: the set never comes near its gimbal lock."
    )
    return finish(figure, "figure_14_16_humanoid_joints", alt, "redrawn after figs. 14 to 16")


def _obstacle(paths: pd.DataFrame, ends: pd.DataFrame) -> Drawing:
    from matplotlib.patches import Circle

    figure = new_figure(420, 520)
    panel = place_axes(figure, LEFT, 14, 440, 300)
    panel.add_patch(Circle((0.0, 0.3), OBSTACLE_RADIUS_M, facecolor=LINE, edgecolor=INK_2))
    arrived = ends[~ends["as_printed"]].set_index("way")
    for line, way in zip(LINES, arrived.index, strict=False):
        rows = paths[paths["way"] == way]
        goal = (arrived.loc[way, "goal_x_m"], arrived.loc[way, "goal_y_m"])
        draw_line(
            panel,
            rows["x_m"],
            rows["y_m"],
            line,
            f"{way} {'arrives' if arrived.loc[way, 'has_arrived'] else 'does not arrive'}",
        )
        panel.plot(rows["x_m"].iloc[:1], rows["y_m"].iloc[:1], "o", color=line[0], markersize=4)
        panel.plot(*[[c] for c in goal], "x", color=line[0], markersize=6, markeredgewidth=1.6, zorder=6)
        panel.annotate(
            str(way),
            (rows["x_m"].iloc[0], rows["y_m"].iloc[0]),
            xytext=(-10, -3),
            textcoords="offset points",
            fontsize=8.6,
            color=INK,
        )
    panel.set_aspect("equal")
    label_axes(panel, "x [m]", "y [m]")
    add_legend(panel, columns=3)
    alt = (
        "Five ways past a round obstacle, from the dots to the crosses, by the gradient of eq. (43). "
        "Starts, goals and obstacle are this project's: the thesis prints no positions."
    )
    return finish(figure, "figure_17_obstacle", alt, "redrawn after fig. 17")


def _joints(panel: "Axes", rows: pd.DataFrame, n: int) -> None:
    for joint, line in zip(range(1, n + 1), LINES, strict=False):
        draw_line(panel, rows["iteration"], np.degrees(rows[f"q{joint}_rad"]), line, f"joint {joint}")
    label_axes(panel, "iteration", "joint angle [°]")
