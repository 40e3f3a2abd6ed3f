"""Slopes of ability on metrics: a row a metric, a column a question, what the prior allowed beside them."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from analysis.covariates import CovariateEffect
from analysis.figures.labels import fitted, one_line
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
from data.responses import QuestionScale

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_COLUMNS = 6
_LABEL_PX, _GAP_PX, _ROW_PX, _HEAD_PX, _TICKS_PX = 192, 10, 20, 36, 46


def draw_slopes(
    questions: Sequence[QuestionScale],
    found: Sequence[CovariateEffect],
    words: Mapping[str, str],
    prior_reach: float,
    tag: str = "",
) -> tuple[Drawing, ...]:
    """Every slope with its interval; as many drawings as the questions need.

    Parameters
    ----------
    words : mapping of str to str
        What each metric is called.
    prior_reach : float
        Half the interval of the prior [logit], drawn dotted.
    """
    metrics = list(dict.fromkeys(e.metric for e in found))
    shown = [q for q in questions if any(e.question == q.name for e in found)]
    reach = 1.08 * max(prior_reach, *(max(-e.slope_hdi_low, e.slope_hdi_high) for e in found))
    parts = [shown[k : k + MOST_COLUMNS] for k in range(0, len(shown), MOST_COLUMNS)]
    drawings = []
    with house_style():
        for number, part in enumerate(parts):
            height = _ROW_PX * len(metrics)
            figure = new_figure(_HEAD_PX + height + _TICKS_PX)
            for row, metric in enumerate(metrics):
                name = fitted(words.get(metric, metric), _LABEL_PX - 10)
                y = _HEAD_PX + _ROW_PX * (row + 0.5) + 4
                write_text(figure, _LABEL_PX - 8, y, name, ha="right", color=INK)
            below = _HEAD_PX + height + 14
            write_text(figure, _LABEL_PX - 8, below, "slope [logit]", ha="right", fontsize=8.4)
            width = min(240.0, (WIDTH_PX - _LABEL_PX) / len(part) - _GAP_PX)
            for column, question in enumerate(part):
                left = _LABEL_PX + column * (width + _GAP_PX)
                _write_head(figure, question, left + width / 2, width)
                own = [e for e in found if e.question == question.name]
                _draw_column(figure, own, metrics, (left, width, height), reach, prior_reach)
            name = "slopes" if len(parts) == 1 else f"slopes_{number + 1}"
            drawings.append(finish(figure, name, _alt(found, words), tag))
    return tuple(drawings)


def _write_head(figure: "Figure", question: QuestionScale, middle: float, room: float) -> None:
    name = fitted(one_line(question.name), room, 9.6, bold=True)
    write_text(figure, middle, 14, name, ha="center", weight="bold", fontsize=9.6, color=INK)
    short = fitted(one_line(question.short or question.name), room + 8, 7.8)
    if short != name:
        write_text(figure, middle, 27, short, ha="center", fontsize=7.8)


def _draw_column(
    figure: "Figure",
    own: Sequence[CovariateEffect],
    metrics: Sequence[str],
    place: tuple[float, float, float],
    reach: float,
    prior_reach: float,
) -> None:
    left, width, height = place
    axes = place_axes(figure, left, _HEAD_PX, width, height)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(len(metrics), 0)
    axes.set_yticks([])
    step = 1.0 if reach < 3 else 2.0
    axes.set_xticks((-step, 0, step), (f"\u2212{step:g}", "0", f"+{step:g}"))
    axes.vlines((-step, step), 0, len(metrics), color=LINE, linewidth=0.75, zorder=0)
    prior = (-prior_reach, prior_reach)
    axes.vlines(prior, 0, len(metrics), color=INK_3, linewidth=0.9, linestyle=(0, (1.5, 2.2)), zorder=1)
    axes.axvline(0, color=INK_3, linewidth=0.9, zorder=1)
    for e in own:
        y = metrics.index(e.metric) + 0.5
        axes.hlines(y, e.slope_hdi_low, e.slope_hdi_high, color=DATA, linewidth=1.15, zorder=3)
        axes.plot(
            [e.slope_mean],
            [y],
            "o",
            markersize=5.6,
            markerfacecolor=DATA if e.is_clear else SURFACE,
            markeredgecolor=DATA,
            markeredgewidth=1.4,
            zorder=4,
        )


def _alt(found: Sequence[CovariateEffect], words: Mapping[str, str]) -> str:
    said = [
        f"{one_line(e.question)}, {words.get(e.metric, e.metric)}: {e.slope_mean:+.2f} "
        f"[{e.slope_hdi_low:+.2f}, {e.slope_hdi_high:+.2f}]"
        for e in found[:24]
    ]
    return f"Slope of ability on each metric, mean [94 % interval]. {'; '.join(said)}."
