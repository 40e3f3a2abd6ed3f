"""How the console looks: its sheet, and the few pieces Streamlit has none of."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Literal

import streamlit as st
from streamlit.delta_generator import DeltaGenerator

_HERE = Path(__file__).resolve().parent
LOGO = _HERE / "logo.svg"


def console_page() -> None:
    """The console's own style."""
    st.html(f"<style>{(_HERE / 'console.css').read_text(encoding='utf-8')}</style>")


Sign = Literal["good", "warn", "bad", "off"]
"""A tick, a triangle, an octagon, a ring (``console.css`` draws them)."""


@dataclass(frozen=True)
class Mark:
    """A text with the sign of a state before it: a shape as well as a colour, and the word says it too."""

    sign: Sign
    text: str

    @property
    def html(self) -> str:
        """As it stands in the page."""
        return f'<span class="mark {self.sign}">{escape(self.text)}</span>'


Cell = str | Mark


def headline(title: str, chips: Sequence[Cell] = ()) -> None:
    """The page's title with small facts beside it."""
    shown = "".join(f'<span class="chip">{_html(chip)}</span>' for chip in chips)
    st.html(f'<div class="headline"><h1>{escape(title)}</h1>{shown}</div>')


def heading(text: str, note: str = "") -> None:
    """The title of a part of the page, one level below the page's own; ``note`` stands at its right."""
    beside = f"<span>{escape(note)}</span>" if note else ""
    st.html(f'<div class="heading"><h2>{escape(text)}</h2>{beside}</div>')


def _html(cell: Cell) -> str:
    # Names of methods are long, and a line may be broken after an underscore.
    return cell.html if isinstance(cell, Mark) else escape(cell).replace("_", "_<wbr>")


def card(name: str, place: DeltaGenerator | None = None) -> DeltaGenerator:
    """A bordered surface to write on; ``name`` is unique on the page, ``place`` a column to put it in."""
    key = f"card-{name}"
    return place.container(border=True, key=key) if place else st.container(border=True, key=key)


def key_figures(figures: Sequence[tuple[str, str, str]]) -> None:
    """A row of figures: (figure, of how many, what)."""
    cells = "".join(
        f"<div><b>{escape(figure)}</b> <span>{escape(of)}</span><p>{escape(what)}</p></div>"
        for figure, of, what in figures
    )
    st.html(f'<div class="figures">{cells}</div>')


def table(head: Sequence[str], rows: Sequence[Sequence[Cell]], numbers: Sequence[int] = ()) -> None:
    """A plain table; ``numbers`` are the columns that align to the right."""

    def line(tag: str, cells: Sequence[Cell]) -> str:
        kind = ["number" if i in numbers else "" for i in range(len(cells))]
        inner = "".join(f'<{tag} class="{k}">{_html(c)}</{tag}>' for c, k in zip(cells, kind, strict=True))
        return f"<tr>{inner}</tr>"

    body = "".join(line("td", row) for row in rows)
    inner = f"<thead>{line('th', head)}</thead><tbody>{body}</tbody>"
    st.html(f'<div class="scroll"><table class="plain">{inner}</table></div>')
