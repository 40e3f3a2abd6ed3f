"""A square of shaded cells for each question: what pairs and ranks are drawn with."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from analysis.figures.labels import LIKELY, distinct, fitted, width_px
from analysis.figures.style import (
    DATA,
    INK,
    INK_2,
    LINE_STRONG,
    PAGE_HEIGHT_PX,
    PART_HEIGHT_PX,
    SUNKEN,
    SURFACE,
    WIDTH_PX,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_heading,
    write_text,
)
from analysis.results import QuestionFit

if TYPE_CHECKING:
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

IN_ORDER_UP_TO = 8
"""More modes are sorted by their mean rank, and their cells hold no second line."""
NUMBERED_UP_TO = 20
"""With more modes cells carry no numbers: a key says what their shades mean."""
_GAP_PX = 26
_KEY_PX = 30
_NOTE_PT = 7.4


@dataclass(frozen=True)
class Grid:
    """The cells of one question.

    Attributes
    ----------
    shares : ndarray, shape (rows, columns)
        Chances in 0..1 that shade the cells; NaN leaves a cell empty.
    rows, columns : tuple of str
        What the cells' rows and columns are called.
    notes : sequence of sequences of str
        Small second line of each cell, or empty.
    """

    shares: np.ndarray
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    notes: Sequence[Sequence[str]]


def draw_grids(
    questions: Sequence[QuestionFit],
    modes: tuple[str, ...],
    grid_of: Callable[[QuestionFit], Grid | None],
    *,
    name: str,
    alt: str,
    text_of: Callable[[float], str],
    column_title: str,
    middle: str,
    tag: str,
    darkest: float = 1.0,
) -> tuple[Drawing, ...]:
    """One grid a question, as many beside each other as are legible, in as many drawings as it takes.

    ``middle`` is the colour of an even chance: light where that means ignorance, darker where it is much.
    ``darkest`` is the chance that is drawn darkest: where no cell comes near 1, a lower one lets differences
    show, and shades then follow its square root. A question without a grid (``grid_of`` gives None) is named
    and said to be not ranked.
    """
    with house_style():
        size = len(modes)
        label_px = _label_room(modes)
        grids = [grid_of(question) for question in questions]
        cell = _cell_px(size, label_px, grids)
        panel_width = label_px + cell * size + _GAP_PX
        per_row = max(1, min(int((WIDTH_PX + _GAP_PX) / panel_width), len(questions)))
        turned = max(width_px(m) for m in distinct(modes, 24)) > cell - 4 and column_title == ""
        head = 26 + (min(label_px, 110) + 6 if turned else 20)
        panel_height = head + cell * _height_ratio(size) * size + 22
        key = _KEY_PX if size > NUMBERED_UP_TO else 0
        rows_per_part = max(1, int(PART_HEIGHT_PX / panel_height))
        per_part = rows_per_part * per_row
        parts = math.ceil(len(questions) / per_part)
        drawings = []
        for part in range(parts):
            shown = list(zip(questions, grids, strict=True))[part * per_part : (part + 1) * per_part]
            height = panel_height * math.ceil(len(shown) / per_row)
            figure = new_figure(height + key)
            for k, (question, grid) in enumerate(shown):
                left = (k % per_row) * panel_width
                top = (k // per_row) * panel_height
                _draw_panel(
                    figure,
                    question,
                    grid,
                    modes,
                    left,
                    top,
                    head,
                    label_px,
                    cell,
                    turned,
                    text_of,
                    column_title,
                    middle,
                    darkest,
                )
            if key:
                _write_key(figure, label_px, height + 8, middle, darkest)
            drawings.append(finish(figure, name if parts == 1 else f"{name}_{part + 1}", alt, tag))
        return tuple(drawings)


def _label_room(modes: tuple[str, ...]) -> float:
    return min(150.0, 14 + max(width_px(m) for m in distinct(modes, 24)))


def _cell_px(size: int, label_px: float, grids: Sequence[Grid | None]) -> float:
    if size <= IN_ORDER_UP_TO:
        notes = {note for grid in grids if grid for row in grid.notes for note in row}
        wanted = 8 + max((width_px(note, _NOTE_PT) for note in notes), default=0.0)
        return min(max(56.0 if size <= 3 else 48.0, wanted), (WIDTH_PX - label_px) / size)
    widest = 46.0 if size <= NUMBERED_UP_TO else 30.0
    return min(widest, (WIDTH_PX - label_px) / size, (PAGE_HEIGHT_PX - 220) / size)


def _height_ratio(size: int) -> float:
    return 0.68 if size <= NUMBERED_UP_TO else 1.0


def _draw_panel(
    figure: "Figure",
    question: QuestionFit,
    grid: Grid | None,
    modes: tuple[str, ...],
    left: float,
    top: float,
    head: float,
    label_px: float,
    cell: float,
    turned: bool,
    text_of: Callable[[float], str],
    column_title: str,
    middle: str,
    darkest: float,
) -> None:
    size = len(modes)
    write_heading(figure, left, top + 16, question.question, label_px + cell * size)
    if grid is None:
        write_text(figure, left, top + head + 16, "not ranked")
        return
    height = cell * _height_ratio(size)
    axes = place_axes(figure, left + label_px, top + head, cell * size, height * size)
    axes.set_xlim(0, size)
    axes.set_ylim(size, 0)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.pcolormesh(
        np.arange(size + 1),
        np.arange(size + 1),
        np.ma.masked_invalid(grid.shares),
        cmap=_shades(middle, darkest),
        norm=_norm(darkest),
        edgecolors=SURFACE,
        linewidth=1.5 if size <= NUMBERED_UP_TO else 0.2,
        rasterized=size > NUMBERED_UP_TO,
    )
    axes.add_patch(_frame(size))
    small = 9.0 if cell >= 13 else 0.6 * cell
    every = 1 if size <= 20 or turned else 5
    for k, label in enumerate(distinct(grid.rows, 24)):
        y = top + head + height * (k + 0.5) + small * 0.45
        write_text(
            figure,
            left + label_px - 8,
            y,
            fitted(label, label_px - 8, small),
            ha="right",
            color=INK,
            fontsize=small,
        )
    for k, label in enumerate(distinct(grid.columns, 24)):
        x = left + label_px + cell * (k + 0.5)
        if turned:
            shown = fitted(label, head - 32, small)
            write_text(
                figure,
                x + small * 0.13,  # the centre of a line has room for letters that hang below it
                top + head - 6,
                shown,
                rotation=90,
                ha="center",
                va="bottom",
                color=INK,
                fontsize=small,
                rotation_mode="default",
            )
        elif every == 1 or k == 0 or (k + 1) % every == 0:
            write_text(
                figure, x, top + head - 6, label, ha="center", color=INK if not column_title else INK_2
            )
    if column_title:
        write_text(figure, left + label_px - 8, top + head - 6, column_title, ha="right", fontsize=8.4)
    if size <= NUMBERED_UP_TO:
        _write_cells(figure, grid, left + label_px, top + head, cell, height, text_of)


def _write_cells(
    figure: "Figure",
    grid: Grid,
    left: float,
    top: float,
    cell: float,
    height: float,
    text_of: Callable[[float], str],
) -> None:
    for i in range(len(grid.rows)):
        for j in range(len(grid.columns)):
            share = float(grid.shares[i, j])
            if math.isnan(share):
                continue
            x, y = left + cell * (j + 0.5), top + height * (i + 0.5)
            dark = share >= LIKELY
            note = grid.notes[i][j] if grid.notes else ""
            weight = "bold" if share >= LIKELY else "normal"
            write_text(
                figure,
                x,
                y + (0 if note else 4.5),
                text_of(share),
                ha="center",
                weight=weight,
                fontsize=9.0 if cell >= 32 else 8.0,
                color=SURFACE if dark else INK,
            )
            if note:
                write_text(
                    figure,
                    x,
                    y + 12.5,
                    note,
                    ha="center",
                    fontsize=_NOTE_PT,
                    color=SURFACE if dark else INK_2,
                )


def _write_key(figure: "Figure", left: float, top: float, middle: str, darkest: float) -> None:
    """What the shades of cells without numbers mean."""
    left = max(left, width_px("chance", 8.4) + 8)
    write_text(figure, left - 8, top + 9, "chance", ha="right", fontsize=8.4)
    for k in range(5):
        chance = darkest * (k / 4 if darkest == 1.0 else (k / 4) ** 2)
        x = left + 74.0 * k
        swatch = place_axes(figure, x, top, 22, 11)
        swatch.set_xticks([])
        swatch.set_yticks([])
        swatch.set_facecolor(_shades(middle, darkest)(float(_norm(darkest)(chance))))
        for spine in swatch.spines.values():
            spine.set(visible=True, color=LINE_STRONG, linewidth=0.6)
        write_text(figure, x + 27, top + 9, f"{100 * chance:.0f} %", fontsize=8.4)


def _norm(darkest: float) -> "Normalize":
    from matplotlib.colors import Normalize, PowerNorm

    return Normalize(0.0, 1.0) if darkest == 1.0 else PowerNorm(0.5, 0.0, darkest)


def _shades(middle: str, darkest: float) -> "Colormap":
    """White to the data colour through that of an even chance.

    It steps where a chance becomes likely, so that text is legible on both sides; not where the scale ends
    below certainty.
    """
    from matplotlib.colors import LinearSegmentedColormap

    if darkest < 1.0:
        return LinearSegmentedColormap.from_list("part", [SURFACE, DATA], N=512).with_extremes(bad=SUNKEN)
    stops = [(0.0, SURFACE), (0.5, middle), (0.79, "#9DB1BB"), (0.81, "#577686"), (1.0, DATA)]
    return LinearSegmentedColormap.from_list("data", stops, N=512).with_extremes(bad=SUNKEN)


def _frame(size: int) -> "Rectangle":
    from matplotlib.patches import Rectangle

    return Rectangle((0, 0), size, size, fill=False, edgecolor=LINE_STRONG, linewidth=0.75)
