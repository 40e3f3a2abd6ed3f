"""The atlas of a study's modes: one page from which a researcher chooses what to compare."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from data.study import Study

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes

    from analysis.figures.style import Drawing
    from sim_trials.batch import Progress
    from sim_trials.mode_atlas import ModeCurves
    from sim_trials.mode_laps import ModeLaps

PAGE = "atlas.html"
"""What `write_atlas` calls the page."""
OPERATORS = 6
"""How many simulated operators do a lap under each mode, if nobody says otherwise."""

_ROW_PX, _TOP_PX, _LEFT_PX, _GAP_PX = 96, 44, 118, 26
_MOST_SIGMA, _MOST_DAMPING = 0.32, 1.0


@dataclass(frozen=True, eq=False)
class Atlas:
    """A study's modes beside each other, in the order of the study.

    Attributes
    ----------
    curves, laps : tuple
        One entry a mode; no laps if none were run.
    drawing : Drawing
        Gain, damping and joint speed against sigma, a row a mode.
    """

    study: Study
    curves: "tuple[ModeCurves, ...]"
    laps: "tuple[ModeLaps, ...]"
    drawing: "Drawing"


def study_atlas(
    study: Study, where: str, operators: int = OPERATORS, n_jobs: int = 1, progress: "Progress | None" = None
) -> Atlas:
    """Work out the atlas of a study.

    Parameters
    ----------
    study : Study
    where : str
        What an error calls the study, e.g. its file.
    operators : int
        How many simulated operators do a lap under each mode; 0 for curves alone.
    n_jobs : int
        How many processes run laps.
    progress : callable, optional
        Called as ``progress(done, total, what)`` after each mode.

    Raises
    ------
    InputError
        If a mode has no method, or the mode or the maze can't be had.
    """
    from app.studies import resolved_modes
    from sim_trials.mode_atlas import mode_curves
    from sim_trials.mode_laps import mode_laps

    curves, laps = [], []
    resolved = resolved_modes(study, where)
    for done, mode in enumerate(resolved, start=1):
        curves.append(mode_curves(mode, study.maze))
        if operators:
            laps.append(mode_laps(study, mode.name, range(operators), n_jobs))
        if progress is not None:
            progress(done, len(resolved), mode.name)
    return Atlas(study, tuple(curves), tuple(laps), draw_curves(curves))


def write_atlas(atlas: Atlas, folder: Path) -> list[Path]:
    """Write the page and its figure (SVG and PNG) into a folder; their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    atlas.drawing.write(folder)
    (folder / PAGE).write_text(atlas_page(atlas), encoding="utf-8", newline="\n")
    return [folder / PAGE, *(folder / f"{atlas.drawing.name}.{kind}" for kind in ("svg", "png"))]


def draw_curves(curves: "Sequence[ModeCurves]") -> "Drawing":
    """Gain, damping and joint speed against sigma: a row a mode, all others faint behind it."""
    from analysis.figures.labels import fitted
    from analysis.figures.style import INK, INK_2, WIDTH_PX, finish, house_style, new_figure, write_text

    titles = ("gain", "damping \u03bb it amounts to", "fastest joint, share of its limit")
    width = (WIDTH_PX - _LEFT_PX - 2 * _GAP_PX - 8) / 3
    with house_style():
        figure = new_figure(_TOP_PX + len(curves) * _ROW_PX + 34)
        for column, title in enumerate(titles):
            left = _LEFT_PX + column * (width + _GAP_PX)
            write_text(figure, left, 16, title, fontsize=9, color=INK)
            most = (1.08, _MOST_DAMPING, _most_speed(curves))[column]
            for row, shown in enumerate(curves):
                axes = _panel(figure, left, _TOP_PX + row * _ROW_PX, width, most, row == len(curves) - 1)
                for other in curves:
                    _draw_pair(axes, other, column, most, is_shown=False)
                _draw_pair(axes, shown, column, most, is_shown=True)
        write_text(figure, 0, 16, "solid: towards the lock", fontsize=7.8, color=INK_2)
        write_text(figure, 0, 29, "dashed: out of it", fontsize=7.8, color=INK_2)
        for row, shown in enumerate(curves):
            middle = _TOP_PX + row * _ROW_PX + 0.4 * _ROW_PX
            name = fitted(shown.mode.name, _LEFT_PX - 24, 9.6, bold=True)
            write_text(figure, 0, middle, name, fontsize=9.6, color=INK, weight="bold")
            method = fitted(shown.mode.method.name, _LEFT_PX - 24, 7.8)
            write_text(figure, 0, middle + 14, method, fontsize=7.8)
        bottom = _TOP_PX + len(curves) * _ROW_PX + 22
        write_text(
            figure, _LEFT_PX, bottom, "smallest singular value \u03c3; the lock is at the right", fontsize=8.2
        )
        names = ", ".join(shown.mode.name for shown in curves)
        alt = f"Gain, equivalent damping and fastest joint against the smallest singular value for {names}"
        return finish(figure, "mode_atlas", alt)


def _most_speed(curves: "Sequence[ModeCurves]") -> float:
    return max(0.2, 1.1 * max(float(c.joint_speed.max()) for m in curves for c in (m.towards, m.away)))


def _panel(figure: object, left: float, top: float, width: float, most: float, is_last: bool) -> "Axes":
    from analysis.figures.style import LINE_STRONG, place_axes

    axes = place_axes(figure, left, top, width, _ROW_PX - 22)  # type: ignore[arg-type]
    axes.set_xlim(_MOST_SIGMA, 0.0)
    axes.set_ylim(0.0, most)
    axes.set_yticks([0.0, round(most / 2.16, 1), round(most / 1.08, 1)])
    axes.set_xticks([0.3, 0.2, 0.1, 0.0], ["0.3", "0.2", "0.1", "0"] if is_last else [""] * 4)
    axes.tick_params(labelsize=7.6)
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(True)
        axes.spines[side].set_color(LINE_STRONG)
        axes.spines[side].set_linewidth(0.8)
    return axes


def _draw_pair(axes: "Axes", curves: "ModeCurves", column: int, most: float, is_shown: bool) -> None:
    from analysis.figures.style import DATA, LINE

    for curve, dashes in ((curves.towards, "-"), (curves.away, (0, (3.5, 2)))):
        values = (curve.gain, curve.damping, curve.joint_speed)[column]
        axes.plot(
            curves.sigma,
            _cut(values, most),
            linestyle=dashes,
            color=DATA if is_shown else LINE,
            linewidth=1.7 if is_shown else 0.8,
            zorder=3 if is_shown else 1,
        )


def _cut(values: "np.ndarray", most: float) -> "np.ndarray":
    """What lies beyond the panel runs along its edge: a mode that stands still is damped without bound."""
    import numpy as np

    return np.minimum(values, most)


def atlas_page(atlas: Atlas) -> str:
    """The atlas as one HTML page that needs no other file."""
    study = atlas.study
    laps = ""
    if atlas.laps:
        laps = (
            f"<h2>On the maze</h2><p>First laps of {len(atlas.laps[0].laps)} simulated operators, and one "
            "live lap of the scripted hand. Joint speed is the fastest joint's, as a share of its limit: the "
            "robot stops itself at 0.98. Chatter counts jumps of the command to and fro that the robot "
            f"cannot follow. Simulated people, not real ones.</p>{_lap_table(atlas.laps)}"
        )
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Modes of {escape(study.name)}</title>
<style>{_CSS}</style></head><body>
<h1>Modes of {escape(study.name)}</h1><p>{escape(study.title)}</p>
<h2>Into the lock and out of it</h2>
<p>The arm is stretched step by step from the start of the lap, and each mode is asked for 0.1 m/s along the
one direction that the elbow-lock takes away. Its gain is what it gives of that. Every gain is also said as
the damping of damped least squares that would give the same, so that filters and limits can be compared
with dampings.</p>
{atlas.drawing.svg}
{laps}
<h2>Rules</h2>{"".join(_rule(curves) for curves in atlas.curves)}
</body></html>
"""


def _lap_table(laps: "Sequence[ModeLaps]") -> str:
    heads = (
        "Mode",
        "Done",
        "Stuck",
        "Stopped",
        "Joint speed",
        "Edge force [N]",
        "Exit gain",
        "Chatter [1/s]",
    )
    rows = "".join(
        f"<tr><th>{escape(lap.name)}</th><td>{lap.share('completed'):.2f}</td><td>{lap.share('stuck'):.2f}</td>"
        f"<td>{lap.share('failed'):.2f}</td><td>{lap.peak_joint_speed:.2f}</td>"
        f"<td>{_number(lap.mean('force_edge_n'), 1)}</td><td>{_number(lap.mean('gain_exit'), 2)}</td>"
        f"<td>{lap.mean('chatter_hz'):.2f}</td>"
        f"<td>{escape(lap.live_outcome)}, {lap.live_duration_s:.0f} s</td>"
        f"<td class=words>{escape(lap.verdict)}</td></tr>"
        for lap in laps
    )
    head = "".join(f"<th>{text}</th>" for text in (*heads, "Live", "Verdict"))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if value == value else "\u2013"


def _rule(curves: "ModeCurves") -> str:
    mode, method = curves.mode, curves.mode.method
    rows = "".join(
        f"<tr><th>{escape(p.name)}</th><td>{value:g} {escape(p.unit)}</td><td>{p.low:g} to {p.high:g}</td>"
        f"<td class=words>{escape(p.meaning)}</td></tr>"
        for p, value in zip(method.parameters, mode.values, strict=True)
    )
    claims = ", ".join(sorted(str(claim).replace("_", " ") for claim in method.properties)) or "none"
    return (
        f"<section><h3>{escape(mode.name)} <small>{escape(method.name)}</small></h3>"
        f"<p>{escape(method.summary)}.</p><p class=equation>{escape(method.equation)}</p>"
        f"<table><tbody>{rows}</tbody></table>"
        f"<p class=source>{escape(method.source)}. Tested claims: {escape(claims)}. One call takes "
        f"{curves.cost_ns / 1000:.1f} \u00b5s on this machine.</p></section>"
    )


_CSS = """
body{font:15px/1.5 system-ui,sans-serif;color:#1D2930;background:#fff;
 max-width:1060px;margin:32px auto;padding:0 24px}
h1{font-size:25px;margin:0}h2{font-size:18px;margin:34px 0 6px}h3{font-size:15px;margin:24px 0 2px}
small{font-weight:400;color:#66747D}p{margin:4px 0 10px;color:#4C5B65;max-width:72ch}
svg{max-width:100%;height:auto}
table{border-collapse:collapse;font-size:13.5px;font-variant-numeric:tabular-nums}
th,td{text-align:right;padding:4px 10px;border-bottom:1px solid #DDE1DE;vertical-align:baseline}
th:first-child,.words{text-align:left}thead th{color:#66747D;font-weight:400}
.equation{font-family:ui-monospace,monospace;font-size:13px;color:#1D2930;max-width:none}.source{font-size:13px}
section{break-inside:avoid}
"""
