"""Names from outside made fit for a drawing: one line, no control characters, short enough."""

import unicodedata
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from math import isnan

LIKELY = 0.8
"""A first place is called likely, and its chance printed bold, from here on; below it is open."""
ELLIPSIS = "…"
_PREFERRED_FONTS = ("Arial", "Helvetica", "Liberation Sans", "DejaVu Sans")
"""The last comes with matplotlib, so there is always one; it also has the signs that the others lack."""
_BIDI_CONTROLS = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\u200e\u200f")


def one_line(text: str) -> str:
    """A name with every run of white space or control characters as one space.

    Marks that reverse the direction of the text around them are dropped, so that a name cannot
    turn round what stands beside it.
    """
    kept = (
        " " if unicodedata.category(c) in ("Cc", "Zl", "Zp", "Cs") else c
        for c in text
        if c not in _BIDI_CONTROLS
    )
    return " ".join("".join(kept).split()) or "(no name)"


def isolated(text: str) -> str:
    """A name for the middle of a sentence: one written from right to left cannot turn its neighbours."""
    text = one_line(text)
    if any(unicodedata.bidirectional(c) in ("R", "AL", "AN") for c in text):
        return f"\u2068{text}\u2069"
    return text


def shortened(text: str, length: int) -> str:
    """A name of at most ``length`` characters, cut in the middle so that both ends stay legible."""
    text = one_line(text)
    if len(text) <= length:
        return text
    tail = (length - 1) // 3
    return text[: length - 1 - tail].rstrip() + ELLIPSIS + text[len(text) - tail :].lstrip()


def distinct(names: tuple[str, ...], length: int) -> tuple[str, ...]:
    """Shortened names that still differ: those that would collide get a number."""
    short = [shortened(name, length) for name in names]
    if len(set(short)) == len(short):
        return tuple(short)
    room = length - len(str(len(names))) - 1
    return tuple(
        name if short.count(name) == 1 else f"{shortened(names[k], room)} {k + 1}"
        for k, name in enumerate(short)
    )


@lru_cache(maxsize=1)
def font_families() -> tuple[str, ...]:
    """The fonts of a drawing, best first: those of the design that this machine has."""
    from matplotlib import font_manager

    installed = {font.name for font in font_manager.fontManager.ttflist}
    return tuple(name for name in _PREFERRED_FONTS if name in installed)


@contextmanager
def any_sign() -> Iterator[None]:
    """Names come from files: a sign that no font has is measured and drawn as a box, without a warning."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*Glyph .* missing from.*")
        warnings.filterwarnings("ignore", message="Matplotlib currently does not support .* natively")
        yield


@lru_cache(maxsize=4096)
def width_px(text: str, size_pt: float = 9, bold: bool = False) -> float:
    """Width of a line of text as it will be drawn [CSS px]."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextToPath

    font = FontProperties(family=list(font_families()), size=size_pt, weight="bold" if bold else "normal")
    with any_sign():
        width, _, _ = TextToPath().get_text_width_height_descent(text, font, ismath=False)
    return float(width) * 96 / 72


def fitted(text: str, room_px: float, size_pt: float = 9, bold: bool = False) -> str:
    """A name shortened until it fits a width."""
    whole = one_line(text)
    if width_px(whole, size_pt, bold) <= room_px:
        return whole
    fits, too_long = 2, min(len(whole), 400)
    while too_long - fits > 1:
        middle = (fits + too_long) // 2
        if width_px(shortened(whole, middle), size_pt, bold) <= room_px:
            fits = middle
        else:
            too_long = middle
    return shortened(whole, fits)


def apart(heights: Sequence[tuple[float, str]], least: float) -> list[tuple[float, str]]:
    """Names by the heights where they belong, lowest first, moved up where two would stand closer."""
    placed: list[tuple[float, str]] = []
    for height, name in sorted(heights):
        placed.append((max(height, placed[-1][0] + least) if placed else height, name))
    return placed


def fitted_pair(first: str, second: str, room_px: float, size_pt: float = 9) -> str:
    """``first over second`` in a width: where it is too long, both names are shortened alike."""
    whole = f"{one_line(first)} over {one_line(second)}"
    if width_px(whole, size_pt) <= room_px:
        return whole
    half = (room_px - width_px(" over ", size_pt)) / 2
    spare = max(0.0, half - width_px(one_line(first), size_pt), half - width_px(one_line(second), size_pt))
    return f"{fitted(first, half + spare, size_pt)} over {fitted(second, half + spare, size_pt)}"


def p_value(p: float) -> str:
    """A p value with three digits after the point, never 0; empty if it is not known."""
    if isnan(p):
        return ""
    return "<0.001" if p < 0.0005 else f"{p:.3f}"


def percent_in_words(probability: float) -> str:
    """A chance for the middle of a sentence, with its sign."""
    return f"{percent(probability)} %".replace("<", "under ").replace(">", "over ")


def percent(probability: float) -> str:
    """A chance as whole per cent, never rounded to certainty."""
    if probability < 0.005:
        return "<1"
    if probability >= 0.995:
        return ">99"
    return str(int(100 * probability + 0.5))
