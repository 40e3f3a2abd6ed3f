"""What else the model learnt: side effect, cut-points and how much people differ."""

from collections.abc import Sequence
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

PANELS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("Side effect", ("side_effect",)),
    ("Side drift", ("side_drift",)),
    ("Cut-points", ("cut_1", "cut_2", "cut_3", "cut_4")),
    ("Ties", ("log_nu",)),
    ("Careless", ("lapse",)),
    ("Between people", ("subject_sd",)),
    ("Own sides", ("side_sd",)),
    ("Own widths", ("scale_sd",)),
)
"""The panels with the parameters they show; a panel no question has is left out."""
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
        pitch = 24
        longest = max(width_px(one_line(q.question.name)) for q in shown)
        left = min(190.0, max(44.0, 16 + longest))
        gap = 30 if len(panels) < 6 else 18
        width = (WIDTH_PX - left - gap * (len(panels) - 1) - 8) / len(panels)
        figure = new_figure(30 + pitch * len(shown) + 42)
        for row, question in enumerate(shown):
            name = fitted(question.question.name, left - 14)
            write_text(figure, left - 14, 30 + pitch * (row + 0.5) + 4, name, ha="right", color=INK)
        write_text(figure, left - 14, 30 + pitch * len(shown) + 17, "logit", ha="right", fontsize=8.4)
        for k, (title, names) in enumerate(panels):
            x = left + k * (width + gap)
            write_text(figure, x, 16, title, fontsize=9 if len(panels) < 6 else 8, color=INK, weight="bold")
            axes = place_axes(figure, x, 30, width, pitch * len(shown))
            axes.set_ylim(len(shown), 0)
            axes.set_yticks([])
            values = [q for s in shown for q in s.parameters if q.name in names]
            low, high = min(0.0, *(q.hdi_low for q in values)), max(0.1, *(q.hdi_high for q in values))
            pad = 0.06 * (high - low)
            axes.set_xlim(low - pad if low < 0 else 0, high + pad)
            axes.locator_params(axis="x", nbins=4)
            axes.grid(axis="x", color=LINE, linewidth=0.75)
            axes.set_axisbelow(True)
            axes.axvline(0, color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2)))
            for row, question in enumerate(shown):
                own = [quantity for quantity in question.parameters if quantity.name in names]
                # The intervals of more than two cut-points would cover each other.
                step = _APART if len(own) > 2 else 0.0
                for place, quantity in enumerate(own):
                    _draw_quantity(axes, row + 0.5 + step * (place - (len(own) - 1) / 2), quantity)
        return finish(figure, "parameters", _alt(shown), tag)


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
