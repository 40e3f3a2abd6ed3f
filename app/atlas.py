"""The atlas of modes: one page from which a researcher chooses what to compare."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from app.atlas_tables import (
    CURVES_SAY,
    LAPS_SAY,
    Cells,
    by_method,
    claims,
    curves_table,
    laps_table,
    names,
    parameters_table,
    verdicts,
)
from data.study import Mode, Study

if TYPE_CHECKING:
    from analysis.figures.style import Drawing
    from sim_trials.batch import Progress
    from sim_trials.mode_atlas import ModeCurves
    from sim_trials.mode_laps import ModeLaps
    from sim_trials.modes.method import ResolvedMode

PAGE = "atlas.html"
"""What `write_atlas` calls the page."""
OPERATORS = 6
"""How many simulated operators do a lap under each mode, if nobody says otherwise."""


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


def with_every_method(study: Study) -> Study:
    """The study whose modes can be simulated, and behind them every known method at its defaults.

    A method bears its own name as a mode, with an ending if the study calls a mode so.
    """
    from sim_trials.modes.registry import METHODS

    modes = tuple(mode for mode in study.modes if mode.method in METHODS)
    taken = {mode.name for mode in study.modes}
    known = (Mode(name=f"{name}.default" if name in taken else name, method=name) for name in METHODS)
    return study.model_copy(update={"modes": (*modes, *known)})


def with_modes(study: Study, names: Sequence[str]) -> Study:
    """The study with those of its modes alone, in its own order."""
    return study.model_copy(update={"modes": tuple(mode for mode in study.modes if mode.name in names)})


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
    from app.atlas_drawing import draw_curves
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


def atlas_page(atlas: Atlas) -> str:
    """The atlas as one HTML page that needs no other file."""
    study = atlas.study
    laps = ""
    if atlas.laps:
        said = LAPS_SAY.format(n=len(atlas.laps[0].laps))
        laps = f"<h2>On the maze</h2><p>{escape(said)}</p>{_table(laps_table(atlas.laps))}"
        laps += f"<ul>{''.join(f'<li>{escape(said)}</li>' for said in verdicts(atlas.laps))}</ul>"
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Modes of {escape(study.name)}</title>
<style>{_CSS}</style></head><body>
<h1>Modes of {escape(study.name)}</h1><p>{escape(study.title)}</p>
<h2>Into the lock and out of it</h2>
<p>{escape(CURVES_SAY)}</p>
{atlas.drawing.svg}
{_table(curves_table(atlas.curves))}
{laps}
<h2>Rules</h2>{"".join(map(_rule, by_method([curves.mode for curves in atlas.curves])))}
</body></html>
"""


def _table(cells: Cells) -> str:
    def cell(k: int, text: str, tag: str = "td") -> str:
        kind = "" if k in cells.numbers else " class=words"
        return f"<{tag}{kind}>{escape(text)}</{tag.split()[0]}>"

    head = "".join(cell(k, text, "th scope=col") for k, text in enumerate(cells.head))
    body = "".join(
        f"<tr>{cell(0, row[0], 'th scope=row')}{''.join(cell(k, row[k]) for k in range(1, len(row)))}</tr>"
        for row in cells.rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _rule(modes: "Sequence[ResolvedMode]") -> str:
    method = modes[0].method
    return (
        f"<section><h3>{escape(method.name)} <small>{escape(names(modes))}</small></h3>"
        f"<p>{escape(method.summary)}.</p><p class=equation>{escape(method.equation)}</p>"
        f"{_table(parameters_table(modes))}"
        f"<p class=source>{escape(method.source)}. Tested claims: {escape(claims(method))}.</p></section>"
    )


_CSS = """
body{font:15px/1.5 system-ui,sans-serif;color:#1D2930;background:#fff;
 max-width:1060px;margin:32px auto;padding:0 24px}
h1{font-size:25px;margin:0}h2{font-size:18px;margin:34px 0 6px}h3{font-size:15px;margin:24px 0 2px}
small{font-weight:400;color:#66747D}p,li{color:#4C5B65;max-width:80ch}p{margin:4px 0 10px}
svg{max-width:100%;height:auto}
table{border-collapse:collapse;font-size:13.5px;font-variant-numeric:tabular-nums}
th,td{text-align:right;padding:4px 10px;border-bottom:1px solid #DDE1DE;vertical-align:baseline}
.words{text-align:left}thead th{color:#66747D;font-weight:400}
.equation{font-family:ui-monospace,monospace;font-size:13px;color:#1D2930;max-width:none}.source{font-size:13px}
section{break-inside:avoid}
"""
