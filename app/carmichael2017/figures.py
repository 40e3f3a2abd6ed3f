"""Figure 5 of the 2017 paper, and what it gives no figure for: damping, force, stuck robots."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from analysis.figures.style import (
    DATA,
    DATA_2,
    DATA_TINT,
    INK,
    INK_2,
    INK_3,
    LINE,
    SURFACE,
    WIDTH_PX,
    Drawing,
    draw_point,
    finish,
    new_figure,
    place_axes,
    write_text,
)
from app.carmichael2017.claims import stuck_by_cohort
from app.carmichael2017.cohorts import OF_THE_STUDY
from app.reproduction_panels import PANEL_HEIGHT, PANEL_TOP, add_legend, label_axes, new_panels
from sim_trials.reproductions.carmichael2017.claims import STUCK_TIMES
from sim_trials.reproductions.carmichael2017.damping import SIGMA_T
from sim_trials.reproductions.carmichael2017.measures import MEASURES, PHASES
from sim_trials.reproductions.verdict import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODES = ("M1", "M2", "M3")
TAG = "simulated people, not those of the paper"
_DOTS = (0, (1.5, 2.2))


def drawings(tables: dict[str, pd.DataFrame]) -> list[Drawing]:
    """All figures, within the house style."""
    return [
        _worth(tables["worth"], tables["orders"]),
        _damping(tables["damping"]),
        _measured(tables["measured"]),
        _stuck(tables["stuck_surface"], tables["cohorts"]),
        _least_damping(tables["least_damping"]),
    ]


def _worth(worth: pd.DataFrame, orders: pd.DataFrame) -> Drawing:
    left, top, height = 74, 10, 190
    figure = new_figure(top + height + 108)
    panel = place_axes(figure, left, top, WIDTH_PX - left - 4, height)
    questions = list(dict.fromkeys(worth["question"]))
    group = (WIDTH_PX - left - 4) / len(questions)
    panel.set_xlim(0, len(questions))
    panel.set_ylim(0, 1)
    panel.set_xticks([])
    panel.grid(axis="y", color=LINE, linewidth=0.75)
    panel.axhline(1 / 3, color=INK_3, linewidth=0.9, linestyle=_DOTS)
    panel.set_ylabel("Bradley-Terry worth", fontsize=8.6, labelpad=4, color=INK_2)
    base = top + height
    for text, y in (("published", base + 62), ("came out in", base + 82)):
        write_text(figure, 0, y, text, fontsize=8.4)
    for k, question in enumerate(questions):
        rows = worth[worth["question"] == question].set_index("mode")
        for j, mode in enumerate(MODES):
            x = k + (j + 1.2) / 4.4
            panel.vlines(x, rows["worth_low"][mode], rows["worth_high"][mode], color=DATA, linewidth=1.15)
            draw_point(panel, x, rows["worth"][mode], j)
            place = left + group * x
            write_text(figure, place, base + 14, mode, ha="center", fontsize=7.8)
        order = orders[(orders["question"] == question) & (orders["raters"] == OF_THE_STUDY)].iloc[0]
        middle = left + group * (k + 0.5)
        write_text(figure, middle, base + 30, question, ha="center", fontsize=9.6, color=INK, weight="bold")
        write_text(figure, middle, base + 43, rows["short"].iloc[0], ha="center", fontsize=8.2)
        write_text(figure, middle, base + 62, order["published"], ha="center", fontsize=8.2, color=INK)
        said = f"{order['share'] * order['cohorts']:.0f} of {order['cohorts']}"
        write_text(figure, middle, base + 82, said, ha="center", fontsize=8.2, color=INK)
    for k in range(1, len(questions)):
        panel.axvline(k, color=LINE, linewidth=0.75)
    alt = (
        "Worth of the three modes by question in one simulated study, posterior mean with "
        "94 % interval, by the Gibbs sampler of Caron and Doucet as in figure 5; dotted: no preference. "
        "Below: what the text says of its figure 5, whose numbers it does not print, and in how many "
        "simulated studies that came out."
    )
    return finish(figure, "figure_5_worth", alt, f"redrawn after fig. 5; {TAG}")


def _damping(table: pd.DataFrame) -> Drawing:
    figure, panels = new_panels(("damping λ, eq. (2)", "share of the command carried out, eq. (1)"))
    for panel, (equation, measured) in zip(
        panels, (("damping_eq2", "damping"), ("gain_eq1", "gain")), strict=True
    ):
        for mode, dashes in (("M1", "-"), ("M2", "--")):
            rows = table[(table["mode"] == mode) & (table["way"] == "towards")]
            panel.plot(rows["sigma"], rows[equation], color=DATA, linestyle=dashes, linewidth=1.4, label=mode)
        for way, marker, face in (("towards", "^", DATA), ("away", "v", SURFACE)):
            rows = table[(table["mode"] == "M3") & (table["way"] == way)]
            shown = [int(np.argmin(np.abs(rows["sigma"] - s))) for s in np.arange(0.01, 0.31, 0.03)]
            panel.plot(
                rows["sigma"].iloc[shown],
                rows[measured].iloc[shown],
                marker,
                color=DATA,
                markerfacecolor=face,
                markersize=5.5,
                label=f"M3 {way}",
            )
        panel.axvline(SIGMA_T, color=INK_3, linewidth=0.9, linestyle=_DOTS)
        panel.set_xlim(0.32, 0.0)
        label_axes(panel, "smallest singular value σ; the lock is at the right", "")
    add_legend(panels[0])
    alt = (
        "Damping and gain along the direction that the elbow-lock takes away. Lines: equations (1) and (2) "
        "with λ₀ = 0.2 (M1) and 0.6 (M2); dotted: σ_t = 0.25. Triangles: what M3 did on the simulated UR10, "
        "M2's damping going in and M1's coming out."
    )
    return finish(figure, "figure_eq_1_2_damping", alt, "no figure in the paper")


def _measured(table: pd.DataFrame) -> Drawing:
    titles = ("mean force of the hand [N]", "velocity over command", "jerk, low-passed [m/s³]")
    figure = new_figure(PANEL_TOP + PANEL_HEIGHT + 62)
    left, gap = 28, 40
    width = (WIDTH_PX - left - 2 * gap - 4) / 3
    for column, (title, measure) in enumerate(zip(titles, MEASURES, strict=True)):
        start = left + column * (width + gap)
        write_text(figure, start, PANEL_TOP - 14, title, fontsize=9.6)
        panel = place_axes(figure, start, PANEL_TOP, width, PANEL_HEIGHT)
        cells = table[table["measure"] == measure.name].set_index(["phase", "mode"])
        for k, phase in enumerate(PHASES):
            for j, mode in enumerate(MODES):
                x = k + 0.24 * (j - 1)
                mean, sd = cells["mean"][phase, mode], cells["sd"][phase, mode]
                panel.vlines(x, mean - sd, mean + sd, color=DATA, linewidth=1.15)
                draw_point(panel, x, mean, j)
        panel.set_ylim(0, None)
        panel.set_xlim(-0.5, len(PHASES) - 0.5)
        panel.grid(axis="y", color=LINE, linewidth=0.6)
        panel.set_axisbelow(True)
        panel.set_xticks(range(len(PHASES)), PHASES)
        panel.tick_params(axis="x", labelsize=8.2)
    _key(figure, left, PANEL_TOP + PANEL_HEIGHT + 44)
    people = int(table["people"].max())
    alt = (
        "Force, responsiveness and jerk by mode, over the whole lap and by phase: mean and standard "
        f"deviation over {people} simulated people. Laps that got stuck under M1 have no exit."
    )
    return finish(figure, "figure_measured", alt, f"no figure in the paper; {TAG}")


def _stuck(surface: pd.DataFrame, cohorts: pd.DataFrame) -> Drawing:
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.ticker import MaxNLocator

    figure, panels = new_panels(
        ("M1: share of conditions with a stuck robot", "simulated studies, at -1.045 m and 5 s"), 66
    )
    m1 = surface[surface["mode"] == "M1"]
    edges, dwells = sorted(set(m1["right_y_m"]), reverse=True), sorted(set(m1["dwell_s"]))
    rate = m1.pivot(index="dwell_s", columns="right_y_m", values="rate").loc[dwells, edges].to_numpy()
    shades = LinearSegmentedColormap.from_list("data", (SURFACE, DATA_TINT, DATA))
    panels[0].pcolormesh(rate, cmap=shades, vmin=0, vmax=1, edgecolors=SURFACE, linewidth=1.5)
    for i, j in np.ndindex(rate.shape):
        ink, said = SURFACE if rate[i, j] > 0.85 else INK, percent(float(rate[i, j]))
        panels[0].text(j + 0.5, i + 0.5, said, ha="center", va="center", fontsize=8.2, color=ink)
    panels[0].set_xticks(np.arange(len(edges)) + 0.5, [f"{edge:g}" for edge in edges])
    panels[0].set_yticks(np.arange(len(dwells)) + 0.5, [f"{dwell:g}" for dwell in dwells])
    panels[0].set_xlabel("right edge of the maze, y [m]", fontsize=8.6, color=INK_2)
    panels[0].set_ylabel("dwell time [s]", fontsize=8.6, labelpad=2, color=INK_2)
    found = stuck_by_cohort(cohorts)["M1"]
    counts, total = found.value_counts(), int(cohorts.loc[cohorts["mode"] == "M1", "comparisons"].iloc[0])
    panels[1].bar(counts.index, counts.to_numpy(), width=0.84, color=DATA_2)
    panels[1].axvline(STUCK_TIMES, color=INK, linewidth=1.3)
    most = max(counts.max(), 1)
    panels[1].set_ylim(0, 1.18 * most)
    panels[1].text(STUCK_TIMES + 0.4, 1.1 * most, "published: 11", fontsize=8.4, color=INK)
    panels[1].set_xlim(-0.7, total + 0.7)
    panels[1].yaxis.set_major_locator(MaxNLocator(integer=True))
    label_axes(panels[1], f"comparisons with a stuck robot, of {total} with M1", "studies")
    people = int(m1["participants"].iloc[0])
    alt = (
        f"Left: how often {people} simulated operators got stuck under M1 in three laps, over two choices "
        "that the paper does not give; this project's are -1.045 m and 5 s. Right: stuck comparisons in "
        f"{len(found)} simulated studies with these; the choices were made to come near the "
        "published 11."
    )
    return finish(figure, "figure_stuck", alt, f"no figure in the paper; {TAG}")


def _least_damping(table: pd.DataFrame) -> Drawing:
    from matplotlib.ticker import MaxNLocator

    figure = new_figure(236)
    panel = place_axes(figure, 56, 34, WIDTH_PX - 68, 140)
    wild = table[["protective_stops", "elbow_inversions"]].max(axis=1)
    parts = (
        ("protective stop or elbow turned over", wild, "#9A5B2C", "///"),
        ("stuck", table["stuck"], DATA_2, ""),
        ("completed", table["completed"], DATA, ""),
    )
    below = np.zeros(len(table))
    for label, laps, colour, hatch in parts:
        shown = np.minimum(laps.to_numpy(), table["laps"].to_numpy() - below)
        panel.bar(
            range(len(table)),
            shown,
            bottom=below,
            width=0.6,
            color=colour,
            hatch=hatch,
            edgecolor=SURFACE,
            label=label,
        )
        below = below + shown
    panel.set_xticks(range(len(table)), [f"{d:g}" for d in table["lambda0"]])
    label_axes(panel, "λ₀; M1 has 0.2", "laps")
    panel.yaxis.set_major_locator(MaxNLocator(integer=True))
    panel.legend(
        loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncols=3, fontsize=8, frameon=False, labelcolor=INK_2
    )
    alt = (
        f"How the first laps of {int(table['laps'].iloc[0])} simulated operators ended under damped least "
        "squares, from next to no damping up to M1's."
    )
    return finish(figure, "figure_least_damping", alt, f"no figure in the paper; {TAG}")


def _key(figure: "Figure", left: float, y: float) -> None:
    """Which mark is which mode."""
    axes = place_axes(figure, left, y - 9, 180, 12)
    axes.set_xlim(0, 180)
    axes.set_ylim(0, 12)
    axes.set_xticks([])
    axes.set_yticks([])
    for j, mode in enumerate(MODES):
        draw_point(axes, 6 + 56 * j, 6, j)
        write_text(figure, left + 16 + 56 * j, y, mode, fontsize=8.6, color=INK)
