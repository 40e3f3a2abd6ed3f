"""How every figure looks, and how it becomes bytes: the design's colours, one width, PNG and SVG."""

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from analysis.figures.labels import any_sign, fitted, font_families, one_line, width_px
from data.responses import QuestionScale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Text

INK, INK_2, INK_3 = "#1D2930", "#4C5B65", "#66747D"
LINE, LINE_STRONG = "#DDE1DE", "#B9C1C2"
DATA, DATA_2, DATA_TINT, SUNKEN, SURFACE = "#2F5566", "#7C95A1", "#DCE5E9", "#F1F2EF", "#FFFFFF"
PALE = "#B9C9D1"

WIDTH_PX = 666
"""Width of every figure: the text width of the A4 page, at 96 px to the inch."""
PAGE_HEIGHT_PX = 860
"""A drawing taller than this would not fit on one page with its caption."""
PART_HEIGHT_PX = 600
"""Panels are gathered into drawings up to this height: taller ones leave large gaps between pages."""

MARKERS = ("o", "s", "D", "^", "v", "P", "X", "h")
_FACES = (SURFACE, DATA, DATA_2, DATA, SURFACE, DATA_2, DATA, SURFACE)


@dataclass(frozen=True)
class Drawing:
    """One drawing, ready to be put in the page and into files.

    Attributes
    ----------
    name : str
        Stem of its files, e.g. ``worth``; the report puts its number before it.
    alt : str
        What someone who cannot see it must know.
    svg : str
        The SVG element alone, without XML declaration, fit to be inlined in HTML.
    png : bytes
        At 200 dots per inch.
    """

    name: str
    alt: str
    height_px: float
    svg: str
    png: bytes

    def write(self, folder: Path) -> None:
        """Write ``<name>.svg`` and ``<name>.png`` into a folder."""
        (folder / f"{self.name}.svg").write_text(
            f'<?xml version="1.0" encoding="utf-8"?>\n{self.svg}', encoding="utf-8", newline="\n"
        )
        (folder / f"{self.name}.png").write_bytes(self.png)


def draw_point(axes: "Axes", x: float, y: float, index: int, many: bool = False) -> None:
    """The marker of a mode by its place in the study: shape and fill differ, never the hue.

    Where there are more modes than shapes (``many``) all have the same one: the name stands beside it.
    """
    if many or index >= len(MARKERS):
        shape, face, size, edge = "o", DATA, 4.0, 1.0
    else:
        shape, face, edge = MARKERS[index], _FACES[index], 1.7
        size = {"o": 7.0, "s": 6.4, "D": 6.6}.get(shape, 7.4)
    axes.plot(
        [x],
        [y],
        linestyle="none",
        marker=shape,
        markersize=size,
        markerfacecolor=face,
        markeredgecolor=DATA,
        markeredgewidth=edge,
        clip_on=False,
        zorder=5,
    )


def new_figure(height_px: float, width_px: float = WIDTH_PX) -> "Figure":
    """An empty figure without any global state, sized in CSS pixels."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_px / 96, height_px / 96), facecolor=SURFACE)
    FigureCanvasAgg(figure)
    return figure


def place_axes(figure: "Figure", left: float, top: float, width: float, height: float) -> "Axes":
    """Axes by their place on the page [px], from the top left corner, without frame or ticks."""
    w, h = (float(x) * 96 for x in figure.get_size_inches())
    axes = figure.add_axes((left / w, 1 - (top + height) / h, width / w, height / h))
    axes.set_facecolor("none")
    for spine in axes.spines.values():
        spine.set_visible(False)
    axes.tick_params(length=0, pad=4, labelsize=8.6, labelcolor=INK_2)
    return axes


def write_text(figure: "Figure", x: float, y: float, text: str, **style: object) -> "Text":
    """Text at a place on the page [px] from the top left corner; y is the baseline."""
    w, h = (float(size) * 96 for size in figure.get_size_inches())
    defaults: dict[str, object] = {"fontsize": 9, "color": INK_2, "va": "baseline"}
    return figure.text(x / w, 1 - y / h, text, **(defaults | style))  # type: ignore[arg-type]


def write_heading(figure: "Figure", x: float, y: float, question: "QuestionScale", room: float) -> None:
    """A question's name in bold and its short form after it, together no wider than ``room`` [px]."""
    name, short = one_line(question.name), one_line(question.short or question.name)
    shown = fitted(name, room, 9.6, bold=True)
    write_text(figure, x, y, shown, fontsize=9.6, color=INK, weight="bold")
    left = width_px(shown, 9.6, bold=True) + 7
    if short != name and room - left > 30:
        write_text(figure, x + left, y, fitted(short, room - left), fontsize=9)


@contextmanager
def house_style() -> Iterator[None]:
    """The settings figures are drawn and saved under; they are put back afterwards.

    Names of modes and questions come from files, so text is never read as mathematics. A glyph no
    font has is drawn as a box in the PNG and left to the reader's fonts in the SVG.
    """
    from matplotlib import rc_context

    with (
        rc_context(
            {
                "font.family": list(font_families()),
                "font.size": 9,
                "text.color": INK_2,
                "text.parse_math": False,
                "text.usetex": False,
                "axes.unicode_minus": True,
                "svg.fonttype": "none",
                "svg.hashsalt": "elbowroom",
                "path.simplify": False,
            }
        ),
        any_sign(),
    ):
        yield


def finish(figure: "Figure", name: str, alt: str, tag: str = "") -> Drawing:
    """Turn a figure into a drawing; ``tag`` (e.g. "simulated data") is printed in its lower corner.

    Must be called within `house_style`.
    """
    w, h = (float(size) * 96 for size in figure.get_size_inches())
    if tag:
        write_text(figure, w, h - 1.5, tag, ha="right", va="bottom", fontsize=7.5, color=INK_3)
    svg, png = io.StringIO(), io.BytesIO()
    empty = {"Date": None, "Creator": None, "Format": None, "Type": None}
    figure.savefig(svg, format="svg", metadata=empty, dpi=200)
    figure.savefig(png, format="png", dpi=200, metadata={"Software": None})
    return Drawing(name, alt, h, _inlinable(svg.getvalue(), name, alt), png.getvalue())


def _inlinable(svg: str, name: str, alt: str) -> str:
    """The SVG element with ids of its own and no rule that would reach the page around it."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>\s*", "", svg, count=1, flags=re.DOTALL)
    svg = re.sub(r'(\bid="|url\(#|href="#)', rf"\g<1>{name}-", svg)
    label = quoteattr(alt, {"\n": " "})
    return svg.replace("<svg ", f'<svg role="img" stroke-linejoin="round" aria-label={label} ', 1)
