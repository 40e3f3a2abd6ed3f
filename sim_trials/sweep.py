"""How the stuck rate hangs on two choices nobody published: where the right edge is, and the dwell time.

Each edge is run once, with the largest dwell time. That is exact for the smaller ones: a lap is the
same up to the tick in which it halts, whatever the dwell time; laps don't depend on one another (what an
operator has learnt goes by the number of the lap); so a lap would have halted as stuck after a smaller
dwell time if and only if sigma_min ever stayed low for longer than that.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from pydantic import ValidationError

from data.errors import InputError
from data.locations import writing_folder
from data.study import Study
from sim_trials.batch import LapJob, Progress, condition_jobs, map_jobs
from sim_trials.events import dwell_ticks, ticks_below
from sim_trials.operators import draw_operator
from sim_trials.start import start_angles
from sim_trials.trial import mode_of, simulate

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SURFACE_TABLE = "stuck_surface.csv"
"""The table; it also tells an earlier sweep's folder, which may be replaced."""
_FIGURE_FORMATS = ("png", "svg")
_INK, _SHADES = "#1D2930", ("#F1F2EF", "#2F5566")


@dataclass(frozen=True)
class SweepResult:
    """The surface of stuck rates.

    Attributes
    ----------
    table : DataFrame
        One row per ``mode``, ``right_y_m`` and ``dwell_s``: ``participants``, ``stuck`` (how many of
        them had the robot stuck at least once in the laps of one condition) and ``rate``.
    laps_per_condition : int
    """

    table: pd.DataFrame
    laps_per_condition: int


def sweep(
    study: Study,
    edges: Sequence[float],
    dwells: Sequence[float],
    participants: int,
    *,
    seed: int | None = None,
    n_jobs: int = 1,
    progress: Progress | None = None,
    modes: Sequence[str] | None = None,
) -> SweepResult:
    """Stuck rates of a study's modes over the right edge and the dwell time.

    Parameters
    ----------
    study : Study
        All but ``maze.right_y_m`` and ``stuck.dwell_s`` stays as it says.
    edges, dwells : sequence of float
        Values of ``maze.right_y_m`` [m] and of ``stuck.dwell_s`` [s].
    participants : int
        How many simulated operators; the same ones at every edge and under every mode.
    seed : int, optional
        Of the operators and their hands; the study's by default.
    n_jobs : int
        Processes; the result does not depend on it.
    progress : callable, optional
        Called as ``progress(done, total, what)``, counting laps.
    modes : sequence of str, optional
        Names of the modes; all of the study's by default.

    Raises
    ------
    InputError
        If an edge or a dwell time is not valid in a study, or there is nothing to sweep over.
    """
    if not len(edges) or not len(dwells) or participants < 1:
        raise InputError("sweep: at least one edge, one dwell time and one participant are needed")
    names = [mode_of(study, name).name for name in modes or study.mode_names]
    varied = [_with(study, edge, dwell) for edge in edges for dwell in dwells]
    start_angles(varied[0].maze)
    first = study.seed if seed is None else seed
    operators = [draw_operator(first + number) for number in range(participants)]
    jobs: list[LapJob] = []
    for edge in edges:
        longest = _with(study, edge, max(dwells))
        for name in names:
            for number, operator in enumerate(operators):
                jobs.extend(condition_jobs(longest, name, operator, first + number))
    ticks = []
    for job, low in zip(jobs, map_jobs(_longest_low_ticks, jobs, n_jobs), strict=True):
        ticks.append(low)
        if progress is not None:
            progress(len(ticks), len(jobs), f"{job.mode}, right edge {job.study.maze.right_y_m:g} m")
    # Per edge, mode and participant: the worst of the laps of the condition.
    worst = np.array(ticks).reshape(len(edges), len(names), participants, -1).max(axis=3)
    rows = []
    for (i, edge), (j, name), dwell in product(enumerate(edges), enumerate(names), dwells):
        stuck = int((worst[i, j] > dwell_ticks(dwell)).sum())
        rows.append((name, float(edge), float(dwell), participants, stuck, stuck / participants))
    columns = ["mode", "right_y_m", "dwell_s", "participants", "stuck", "rate"]
    return SweepResult(pd.DataFrame(rows, columns=columns), study.protocol.laps_per_condition)


def surface_figure(result: SweepResult) -> "Figure":
    """The stuck rate over edge and dwell time, one panel per mode, every cell with its number."""
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.figure import Figure

    names = list(dict.fromkeys(result.table["mode"]))
    edges = sorted(set(result.table["right_y_m"]), reverse=True)
    dwells = sorted(set(result.table["dwell_s"]))
    width = max(1.2 + len(names) * (0.4 + 0.55 * len(edges)), 6.5)
    figure = Figure(figsize=(width, 1.6 + 0.42 * len(dwells)), layout="constrained")
    panels = figure.subplots(1, len(names), sharey=True, squeeze=False)[0]
    for panel, name in zip(panels, names, strict=True):
        rows = result.table[result.table["mode"] == name]
        rate = rows.pivot(index="dwell_s", columns="right_y_m", values="rate").loc[dwells, edges].to_numpy()
        panel.imshow(
            rate,
            vmin=0.0,
            vmax=1.0,
            cmap=LinearSegmentedColormap.from_list("data", _SHADES),
            origin="lower",
            aspect="auto",
        )
        for i, j in np.ndindex(rate.shape):
            ink = "white" if rate[i, j] > 0.5 else _INK
            panel.text(
                j, i, f"{rate[i, j]:.2f}".lstrip("0") or "0", ha="center", va="center", color=ink, fontsize=8
            )
        panel.set_xticks(range(len(edges)), [f"{edge:.4g}" for edge in edges], rotation=45, ha="right")
        panel.set_yticks(range(len(dwells)), [f"{dwell:.3g}" for dwell in dwells])
        panel.set_title(name, fontsize=10)
        panel.set_xlabel("right edge y [m]")
    panels[0].set_ylabel("dwell time [s]")
    people = int(result.table["participants"].iloc[0])
    figure.suptitle(
        f"Share of conditions with a stuck robot (simulated: {people} operators,"
        f" {result.laps_per_condition} laps each)",
        fontsize=10,
    )
    return figure


def write_sweep(result: SweepResult, out: Path) -> tuple[Path, ...]:
    """Write ``stuck_surface.csv`` and the figure as PNG and SVG into a folder; the paths are returned."""
    from matplotlib import rc_context

    names = (SURFACE_TABLE, *(f"stuck_surface.{kind}" for kind in _FIGURE_FORMATS))
    with writing_folder(out, marker=SURFACE_TABLE, owns=names) as folder:
        result.table.to_csv(folder / SURFACE_TABLE, index=False)
        with rc_context({"svg.hashsalt": "elbowroom"}):
            figure = surface_figure(result)
            for kind in _FIGURE_FORMATS:
                metadata = {"Date": None} if kind == "svg" else None
                figure.savefig(folder / f"stuck_surface.{kind}", dpi=200, metadata=metadata)
    return tuple(out / name for name in names)


def _with(study: Study, edge: float, dwell: float) -> Study:
    """The study with another right edge and dwell time, validated."""
    content = study.model_dump()
    content["maze"]["right_y_m"] = edge
    content["stuck"]["dwell_s"] = dwell
    try:
        return Study.model_validate(content)
    except ValidationError as error:
        reason = error.errors()[0]["msg"]
        raise InputError(f"sweep: right edge {edge:g} m, dwell {dwell:g} s: {reason}") from None


def _longest_low_ticks(job: LapJob) -> int:
    """The most ticks on end of a lap with sigma_min below the study's threshold."""
    trace = simulate(job.study, job.mode, job.operator, seed=job.seed, lap=job.lap)
    return int(ticks_below(trace.ticks["sigma"], job.study.stuck.sigma_below).max())
