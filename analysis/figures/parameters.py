"""What else the model learnt: side effect, cut-points and how much people differ."""

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING

from analysis.figures.labels import fitted, one_line, width_px
from analysis.figures.style import (
    DATA,
    INK,
    INK_3,
    LINE,
    SURFACE,
    WIDTH_PX,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)
from analysis.results import Quantity, QuestionFit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("Side effect", ("side_effect",)),
    ("Side drift", ("side_drift",)),
    ("Cut-points", ("cut_1", "cut_2", "cut_3", "cut_4")),
    ("Ties", ("log_nu",)),
    ("Careless (share)", ("lapse",)),
    ("Between people", ("subject_sd",)),
    ("Own sides", ("side_sd",)),
    ("Own widths (log)", ("scale_sd",)),
)
"""The panels with the parameters they show; a panel no question has is left out. On the logit scale, where a
title names no other."""
MOST_ABREAST = 5
"""Panels side by side: of more, the rest stands in further rows of panels."""
_PITCH = 24
_ROOM_OF_A_TICK = 40
"""Width that the number at a tick takes, with its distance to the next [px]."""
_APART = 0.18
"""Rows between the cut-points of a question that has more than two."""
_MARKERS = {"cut_2": "s", "cut_3": "D", "cut_4": "^"}
"""Of cut-points beyond the first, filled."""


def draw_parameters(questions: Sequence[QuestionFit], tag: str = "") -> Drawing | None:
    """One panel a kind of parameter, one row a question; None if the model has no further parameter."""
    with house_style():
        shown = [q for q in questions if q.parameters]
        panels = [
            (t, names) for t, names in PANELS if any(p.name in names for q in shown for p in q.parameters)
        ]
        if not panels:
            return None
        longest = max(width_px(one_line(q.question.name)) for q in shown)
        left = min(190.0, max(44.0, 16 + longest))
        abreast = ceil(len(panels) / ceil(len(panels) / MOST_ABREAST))
        gap = 30
        width = (WIDTH_PX - left - gap * (abreast - 1) - 8) / abreast
        height = 30 + _PITCH * len(shown) + 42
        figure = new_figure(height * ceil(len(panels) / abreast))
        for k, (title, names) in enumerate(panels):
            row, column = divmod(k, abreast)
            top = height * row
            if column == 0:
                _name_rows(figure, left, top, shown)
            x = left + column * (width + gap)
            write_text(figure, x, top + 16, title, color=INK, weight="bold")
            axes = place_axes(figure, x, top + 30, width, _PITCH * len(shown))
            _draw_panel(axes, shown, names, max(2, min(4, int(width / _ROOM_OF_A_TICK))))
        return finish(figure, "parameters", _alt(shown), tag)


def _name_rows(figure: "Figure", left: float, top: float, shown: Sequence[QuestionFit]) -> None:
    """The questions beside their rows, and below them the scale of the ticks."""
    for row, question in enumerate(shown):
        name = fitted(question.question.name, left - 14)
        write_text(figure, left - 14, top + 30 + _PITCH * (row + 0.5) + 4, name, ha="right", color=INK)
    write_text(figure, left - 14, top + 30 + _PITCH * len(shown) + 17, "logit", ha="right", fontsize=8.4)


def _draw_panel(axes: "Axes", shown: Sequence[QuestionFit], names: tuple[str, ...], n_bins: int) -> None:
    """One kind of parameter of every question."""
    axes.set_ylim(len(shown), 0)
    axes.set_yticks([])
    values = [q for s in shown for q in s.parameters if q.name in names]
    low, high = min(0.0, *(q.hdi_low for q in values)), max(0.1, *(q.hdi_high for q in values))
    pad = 0.06 * (high - low)
    axes.set_xlim(low - pad if low < 0 else 0, high + pad)
    axes.locator_params(axis="x", nbins=n_bins)
    axes.grid(axis="x", color=LINE, linewidth=0.75)
    axes.set_axisbelow(True)
    axes.axvline(0, color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2)))
    for row, question in enumerate(shown):
        own = [quantity for quantity in question.parameters if quantity.name in names]
        # The intervals of more than two cut-points would cover each other.
        step = _APART if len(own) > 2 else 0.0
        for place, quantity in enumerate(own):
            _draw_quantity(axes, row + 0.5 + step * (place - (len(own) - 1) / 2), quantity)


def _draw_quantity(axes: "Axes", y: float, quantity: Quantity) -> None:
    axes.hlines(y, quantity.hdi_low, quantity.hdi_high, color=DATA, linewidth=1.15)
    marker = _MARKERS.get(quantity.name, "o")
    axes.plot(
        [quantity.mean],
        [y],
        linestyle="none",
        marker=marker,
        markersize=6,
        zorder=5,
        markerfacecolor=SURFACE if marker == "o" else DATA,
        markeredgecolor=DATA,
        markeredgewidth=1.6,
    )


def _alt(questions: Sequence[QuestionFit]) -> str:
    said = [
        f"{one_line(q.question.name)}: "
        + ", ".join(f"{p.name} {p.mean:.2f} [{p.hdi_low:.2f}, {p.hdi_high:.2f}]" for p in q.parameters)
        + "."
        for q in questions
    ]
    return "Parameters, mean [94 % interval]. " + " ".join(said)
