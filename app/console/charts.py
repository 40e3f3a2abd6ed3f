"""The console's charts: one data colour, modes by row, an interval on every estimate."""

import base64
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from html import escape
from typing import TYPE_CHECKING, Literal

import altair as alt
import pandas as pd
import streamlit as st

from analysis.figures.labels import LIKELY
from app.console.findings import QuestionAtAGlance, StuckAtAGlance

if TYPE_CHECKING:
    from analysis.figures.style import Drawing

_ROW_PX = 28
_AXIS_PX = 44


@dataclass(frozen=True)
class _Palette:
    ink: str
    ink_2: str
    ink_3: str
    line: str
    line_strong: str
    data: str
    data_2: str
    surface: str


_LIGHT = _Palette("#1D2930", "#4C5B65", "#66747D", "#DDE1DE", "#B9C1C2", "#2F5566", "#7C95A1", "#FFFFFF")
_DARK = _Palette("#E8EDEF", "#AEBBC3", "#8C9BA5", "#313D45", "#4C5A63", "#9FC3D3", "#66818E", "#1A2228")


def palette() -> _Palette:
    """Colours of the theme that the browser shows."""
    return _DARK if st.context.theme.type == "dark" else _LIGHT


def drawing(drawn: "Drawing") -> None:
    """A figure as the report draws them, in the colours of the theme that the browser shows."""
    from analysis.figures.style import DATA, INK, INK_2, INK_3, LINE, LINE_STRONG, SURFACE

    svg, to = drawn.svg, palette()
    if to is _DARK:
        colours = (DATA, INK, INK_2, INK_3, LINE, LINE_STRONG, SURFACE)
        dark = (to.data, to.ink, to.ink_2, to.ink_3, to.line, to.line_strong, to.surface)
        painted = dict(zip(map(str.lower, colours), map(str.lower, dark), strict=True))
        svg = re.sub("#[0-9a-f]{6}", lambda found: painted.get(found[0], found[0]), svg)
    # As an image: Streamlit takes drawings out of what it is given as HTML.
    content = base64.b64encode(svg.encode()).decode()
    alt = escape(drawn.alt, quote=True)
    st.html(f'<img class="drawing" alt="{alt}" src="data:image/svg+xml;base64,{content}">')


def percent(share: float) -> str:
    """A chance as text: never a bare 0 or 100."""
    if share < 0.005:
        return "<1 %"
    return ">99 %" if share > 0.995 else f"{round(100 * share)} %"


def worth_chart(question: QuestionAtAGlance) -> alt.Chart:
    """Worth of every mode with its 94 % interval; dotted: no preference; right: the chance to rank first."""
    rows = pd.DataFrame([asdict(standing) for standing in question.standings])
    rows["first"] = rows["p_best"].map(percent)
    rows["likely"] = rows["p_best"] >= LIKELY
    # The same axis for every question, so that they can be compared at a glance.
    return _intervals(rows, "worth", 1.0, len(rows), "~g", rule_at=1 / len(rows), text="first")


def stuck_chart(rates: Sequence[StuckAtAGlance]) -> alt.Chart:
    """Stuck rate of every mode with its 94 % interval; right: how many of how many comparisons."""
    rows = pd.DataFrame([asdict(rate) for rate in rates])
    rows["of"] = [f"{rate.stuck} of {rate.comparisons}" for rate in rates]
    rows["likely"] = False
    top = next(end for end in (0.4, 0.6, 0.8, 1.0) if rows["high"].max() <= end or end == 1.0)
    return _intervals(rows, "rate", top, len(rows), ".0%", rule_at=None, text="of")


def _intervals(
    rows: pd.DataFrame, value: str, top: float, n: int, axis_format: str, rule_at: float | None, text: str
) -> alt.Chart:
    colours = palette()
    scale = alt.Scale(domain=[0, top], nice=False)
    axis = alt.Axis(
        format=axis_format, values=[0, top / 2, top], labelFlush=False, grid=True,
        gridColor=colours.line, domain=False, ticks=False,
        labelColor=colours.ink_3, labelFontSize=12, title=None,
    )  # fmt: skip
    y = alt.Y(
        "label:N", sort=None, title=None, axis=alt.Axis(
            domain=False, ticks=False, labelColor=colours.ink, labelFontSize=12, labelPadding=8,
            labelBaseline="middle",
            labelLimit=120,
        ),
    )  # fmt: skip
    base = alt.Chart(rows).encode(y=y)
    layers = []
    if rule_at is not None:
        rule = alt.Chart(pd.DataFrame({"at": [rule_at]})).mark_rule(strokeDash=[2, 3], color=colours.ink_3)
        layers.append(rule.encode(x=alt.X("at:Q", scale=scale, axis=axis)))
    layers.append(
        base.mark_rule(strokeWidth=2, color=colours.data_2).encode(
            x=alt.X("low:Q", scale=scale, axis=axis), x2="high:Q"
        )
    )
    dots = base.mark_point(
        size=70, filled=True, fill=colours.surface, stroke=colours.data, strokeWidth=2.5, opacity=1
    )
    layers.append(dots.encode(x=alt.X(f"{value}:Q", scale=scale, axis=axis)))
    for is_likely in (False, True):
        colour = colours.ink if is_likely else colours.ink_2
        weight: Literal["normal", "bold"] = "bold" if is_likely else "normal"
        words = base.mark_text(align="right", fontSize=12, dx=56, fontWeight=weight, color=colour)
        layers.append(
            words.encode(x=alt.value("width"), text=f"{text}:N").transform_filter(
                alt.FieldEqualPredicate(field="likely", equal=is_likely)
            )
        )
    return (
        alt.layer(*layers)
        .properties(
            height=_ROW_PX * n + _AXIS_PX,
            padding={"left": 4, "right": 4, "top": 4, "bottom": 4},
            background="transparent",
        )
        .configure_view(strokeWidth=0)
    )
