"""The curve of a power analysis: right and wrong conclusions over the number of participants."""

from collections.abc import Sequence

import altair as alt
import numpy as np
import pandas as pd

from analysis.figures.labels import apart
from analysis.power.outcome import Power
from analysis.power.sentences import showings
from app.console.charts import palette

_HEIGHT_PX = 250
_STEPS = 60
_DASHES: tuple[list[float], ...] = ([1, 0], [6, 3], [2, 2], [8, 3, 2, 3])
_SHAPES = ("circle", "square", "diamond", "triangle-up")


def power_chart(result: Power) -> alt.LayerChart:
    """Points with 94 % intervals, a smooth curve with its band through those of right conclusions."""
    colours = palette()
    points, curves, names = _points(result), _curves(result), _names(result)
    series = list(dict.fromkeys(points["series"]))
    looks = [_look(k, len(result.repetitions)) for k in range(len(series))]
    # On both sides of the sizes there is room for their points.
    sizes = sorted(set(points["participants"]))
    margin = 0.04 * (sizes[-1] - sizes[0] or 1)
    x = alt.X(
        "participants:Q", title="participants",
        axis=alt.Axis(values=sizes, grid=False, ticks=False, domainColor=colours.line, format="d"),
        scale=alt.Scale(domain=[sizes[0] - margin, sizes[-1] + margin], nice=False, zero=False),
    )  # fmt: skip
    y_axis = alt.Axis(
        values=[0, 0.2, 0.4, 0.6, 0.8, 1], labelExpr="round(100 * datum.value) + ' %'", labelFlush=False,
        gridColor=colours.line, domain=False, ticks=False,
    )  # fmt: skip

    def height(field: str) -> alt.Y:
        return alt.Y(f"{field}:Q", title=None, axis=y_axis, scale=alt.Scale(domain=[0, 1]))

    def by_series(range_: Sequence[str] | Sequence[list[float]]) -> alt.Scale:
        return alt.Scale(domain=series, range=range_)

    hues = [colours.data if right else colours.data_2 for _, _, right in looks]
    colour = alt.Color("series:N", scale=by_series(hues), legend=None)
    dash = alt.StrokeDash("series:N", scale=by_series([d for d, _, _ in looks]), legend=None)
    shape = alt.Shape("series:N", scale=by_series([s for _, s, _ in looks]), legend=None)
    wanted = alt.Chart(pd.DataFrame({"wanted": [result.plan.wanted]}))
    layers: list[alt.Chart] = [
        wanted.mark_rule(strokeDash=[2, 3], color=colours.ink_3).encode(y=height("wanted"))
    ]
    if len(curves):
        smooth = alt.Chart(curves)
        band = smooth.mark_area(opacity=0.14, color=colours.data, line=False)
        layers.append(band.encode(x=x, y=height("low"), y2="high:Q", detail="series:N"))
        layers.append(
            smooth.mark_line(strokeWidth=1.8).encode(x=x, y=height("share"), color=colour, strokeDash=dash)
        )
    base = alt.Chart(points)
    wrong = base.transform_filter("!datum.is_right").mark_line(strokeWidth=1.2)
    layers.append(wrong.encode(x=x, y=height("share"), color=colour, strokeDash=dash))
    beside = x.copy()
    beside.shorthand = "beside:Q"
    rules = base.mark_rule(strokeWidth=1.6)
    layers.append(rules.encode(x=beside, y=height("low"), y2="high:Q", color=colour))
    dots = base.mark_point(size=60, filled=True, opacity=1, stroke=colours.surface, strokeWidth=1)
    layers.append(dots.encode(x=beside, y=height("share"), color=colour, shape=shape))
    words = alt.Chart(names).mark_text(
        align="left", baseline="middle", dx=10, fontSize=12, color=colours.ink_2
    )
    layers.append(words.encode(x=alt.value("width"), y=height("at"), text="name:N"))
    return (
        alt.layer(*layers)
        .properties(
            height=_HEIGHT_PX,
            background="transparent",
            padding={"left": 4, "right": 8, "top": 8, "bottom": 4},
            description="Share of right and wrong conclusions by the number of participants; the table has "
            "the numbers.",
        )
        .configure_view(strokeWidth=0)
        .configure_axis(
            labelColor=colours.ink_3, labelFontSize=12, titleColor=colours.ink_2, titleFontSize=12,
            titleFontWeight="normal",
        )
    )  # fmt: skip


def _names(result: Power) -> pd.DataFrame:
    """The lines' names at their right ends."""
    ends = [(result.plan.wanted, "wanted")]
    for k, repetitions in enumerate(result.repetitions):
        last = result.of(repetitions)[-1]
        ends.append((last.right_share, _name(result, repetitions, "right")))
        if k == 0:
            ends.append((last.wrong_share, "wrong"))
    return pd.DataFrame(apart(ends, 15 / _HEIGHT_PX), columns=["at", "name"])


def _points(result: Power) -> pd.DataFrame:
    rows = []
    sizes = [p.participants for p in result.points]
    # Intervals of several repetitions stand beside each other.
    step = 0.012 * (max(sizes) - min(sizes))
    for p in result.points:
        beside = p.participants + step * (
            result.repetitions.index(p.repetitions) - len(result.repetitions) // 2
        )
        for verdict, share, low, high in (
            ("right", p.right_share, p.right_low, p.right_high),
            ("wrong", p.wrong_share, p.wrong_low, p.wrong_high),
        ):
            name = _name(result, p.repetitions, verdict)
            rows.append((name, p.participants, beside, share, low, high, verdict == "right"))
    columns = ["series", "participants", "beside", "share", "low", "high", "is_right"]
    # Right before wrong, as the table has them.
    return pd.DataFrame(rows, columns=columns).sort_values("is_right", ascending=False, kind="stable")


def _curves(result: Power) -> pd.DataFrame:
    found = []
    for repetitions in result.repetitions:
        curve, sizes = result.curve(repetitions), [p.participants for p in result.of(repetitions)]
        if curve is None:
            continue
        at = np.linspace(min(sizes), max(sizes), _STEPS)
        low, high = curve.band(at)
        name = _name(result, repetitions, "right")
        found.append(
            pd.DataFrame(
                {"series": name, "participants": at, "share": curve.share(at), "low": low, "high": high}
            )
        )
    return pd.concat(found) if found else pd.DataFrame()


def _name(result: Power, repetitions: int, verdict: str) -> str:
    return f"{verdict}, {showings(repetitions).lower()}" if len(result.repetitions) > 1 else verdict


def _look(place: int, n_right: int) -> tuple[list[float], str, bool]:
    """Dash, shape and whether it is right conclusions: those come first."""
    k = (place % n_right) % len(_DASHES)
    return _DASHES[k], _SHAPES[k], place < n_right
