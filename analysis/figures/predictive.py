"""How far what the answers show lies from what the fitted model predicts of new people."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from scipy.special import ndtri

from analysis.figures.labels import fitted, one_line, width_px
from analysis.figures.panels import draw_panels
from analysis.figures.style import (
    DATA,
    DATA_TINT,
    INK,
    INK_2,
    LINE_STRONG,
    Drawing,
    place_axes,
    write_heading,
    write_text,
)
from analysis.predictive import UNLIKELY, Kind, PredictiveCheck
from data.responses import QuestionScale

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_PAIRS = 10
"""Of more pairs those that the model predicts worst are drawn."""
_ROW_PX, _HEAD_PX, _FOOT_PX = 16, 40, 30
_LONG_PX = 170
"""Checks whose names need more room have panels of the whole width."""
NAMES: dict[Kind, str] = {
    "ties": "ties",
    "spread": "people apart",
    "lapse": "careless answers",
    "width_by_person": "use of the scale",
    "side_by_person": "own sides",
    "one_line": "one direction",
    "camps": "camps",
    "repeats": "repeats",
    "side": "sides",
    "side_drift": "side over time",
    "width_drift": "scale over time",
}
"""What checks are called that are about no pair and no answer."""
_EDGE = float(-ndtri(UNLIKELY / 2))
_WIDEST_Z = 3.6
"""Beyond what some hundred new sets of answers can tell."""


def draw_predictive(
    questions: Sequence[QuestionScale], checks: Sequence[PredictiveCheck], tag: str = ""
) -> tuple[Drawing, ...]:
    """One panel a question: how far every quantity lies from what the model predicts, as a normal z."""
    of = {q.name: _shown([c for c in checks if c.question == q.name]) for q in questions}
    shown = [q for q in questions if of[q.name]]
    longest = max(width_px(_name(c), 8.4) for own in of.values() for c in own)

    def draw(figure: "Figure", k: int, left: float, top: float, width: float) -> None:
        rows = of[shown[k].name]
        write_heading(figure, left, top + 16, shown[k], width)
        label, right = min(max(0.36 * width, 12 + longest), 0.55 * width), 36.0
        write_text(figure, left + width, top + _HEAD_PX - 6, "p", ha="right", fontsize=8.4)
        axes = place_axes(figure, left + label, top + _HEAD_PX, width - label - right, _ROW_PX * len(rows))
        axes.set_xlim(-_WIDEST_Z, _WIDEST_Z)
        axes.set_ylim(len(rows), 0)
        axes.set_yticks([])
        axes.set_xticks((-3, 0, 3), ("\u22123", "0", "3"))
        axes.axvspan(-_EDGE, _EDGE, color=DATA_TINT, linewidth=0, zorder=0)
        axes.vlines(0, 0, len(rows), color=LINE_STRONG, linewidth=0.75, zorder=1)
        for row, check in enumerate(rows):
            axes.plot(
                [max(-_WIDEST_Z, min(_WIDEST_Z, check.z))],
                [row + 0.5],
                "D" if check.is_unlikely else "o",
                color=DATA,
                markersize=4.6,
                markeredgewidth=0,
                clip_on=False,
                zorder=3,
            )
            y = top + _HEAD_PX + _ROW_PX * (row + 0.5) + 4
            name = fitted(_name(check), label - 8, 8.4)
            write_text(figure, left + label - 8, y, name, ha="right", color=INK, fontsize=8.4)
            write_text(
                figure,
                left + width,
                y,
                (f"{check.p:.2f}" if check.p >= 0.095 else f"{check.p:.3f}").lstrip("0"),
                ha="right",
                fontsize=8.4,
                weight="bold" if check.is_unlikely else "normal",
                color=INK if check.is_unlikely else INK_2,
            )

    far = [f"{one_line(c.question)} {_name(c)}" for c in checks if c.is_unlikely]
    alt = (
        f"{len(checks)} quantities of the answers, each as far as it lies from what the model predicts. "
        f"Hardly predicted: {', '.join(far[:12]) if far else 'none'}."
    )
    heights = [_HEAD_PX + _ROW_PX * len(of[q.name]) + _FOOT_PX for q in shown]
    per_row = 1 if len(shown) == 1 or longest > _LONG_PX else 2
    return draw_panels(heights, draw, per_row=per_row, name="predictive", alt=alt, tag=tag)


def _name(check: PredictiveCheck) -> str:
    return NAMES.get(check.kind) or one_line(check.what)


def _shown(checks: list[PredictiveCheck]) -> list[PredictiveCheck]:
    """All but pairs beyond the most that fit, in their order."""
    pairs = [c for c in checks if c.kind == "wins"]
    kept = sorted(pairs, key=lambda c: c.p)[:MOST_PAIRS]
    return [c for c in checks if c.kind != "wins" or c in kept]
