"""The answers people gave, pair by pair, beside what the model expects."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from analysis.answer_shares import PairShares
from analysis.figures.labels import distinct, fitted, one_line, width_px
from analysis.figures.style import (
    DATA,
    DATA_2,
    INK,
    INK_2,
    INK_3,
    LINE,
    LINE_STRONG,
    PALE,
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
from analysis.level_names import SAME, strength_names
from data.responses import QuestionScale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_PAIRS = 28
"""More pairs than these are not all drawn."""
STANDING_FOR_ALL = 12
"""So many of the most compared stand for the rest then."""
_STRENGTHS = {1: (DATA_2,), 2: (DATA_2, DATA), 3: (PALE, DATA_2, DATA), 4: (PALE, DATA_2, DATA, INK)}
"""Colours of the strengths of preference, from the weakest, by how many there are."""
_ROW_PX, _HEAD_PX, _FOOT_PX = 25, 30, 14


def draw_answers(
    questions: Sequence[QuestionScale],
    shares: Sequence[Sequence[PairShares]],
    modes: tuple[str, ...],
    tag: str = "",
) -> tuple[Drawing, ...]:
    """Stacked shares around the ties: to the left those for the mode named left, to the right for the other.

    Darker is stronger. A mark under a bar, where there is one, is what the fitted model expects
    for the same boundary. All bars share one scale, so that their offsets can be compared.
    """
    with house_style():
        shown = [
            sorted(pairs, key=lambda p: -p.n)[: MOST_PAIRS if len(pairs) <= MOST_PAIRS else STANDING_FOR_ALL]
            for pairs in shares
        ]
        shown = [[p for p in pairs if p in kept] for pairs, kept in zip(shares, shown, strict=True)]
        two = len(questions) > 1 and len(modes) <= 8 and all(width_px(one_line(m)) < 60 for m in modes)
        width = (WIDTH_PX - 36) / 2 if two else WIDTH_PX
        most = max((question.levels // 2 for question in questions), default=1)
        rows = [shown[k : k + 2] for k in range(0, len(shown), 2)] if two else [[pairs] for pairs in shown]
        heights = [_HEAD_PX + _FOOT_PX + _ROW_PX * max(1, *(len(pairs) for pairs in row)) for row in rows]
        reach = min(1.02, 1.06 * max((_reach(pair) for pairs in shown for pair in pairs), default=1.0))
        parts = _packed(heights)
        drawings = []
        for number, part in enumerate(parts):
            figure = new_figure(sum(heights[r] for r in part) + 26)
            top = 0.0
            names = []
            for r in part:
                for c, pairs in enumerate(rows[r]):
                    k = r * (2 if two else 1) + c
                    names.append(k)
                    _draw_question(
                        figure, questions[k], pairs, modes, c * (width + 36), top, width, reach, most
                    )
                top += heights[r]
            _draw_key(figure, top + 16, {questions[k].levels for k in names}, most, shown)
            name = "answers" if len(parts) == 1 else f"answers_{number + 1}"
            alt = _alt([questions[k] for k in names], [shown[k] for k in names])
            drawings.append(finish(figure, name, alt, tag))
        return tuple(drawings)


def _packed(heights: Sequence[float]) -> list[list[int]]:
    parts: list[list[int]] = [[]]
    used = 0.0
    for k, height in enumerate(heights):
        if parts[-1] and used + height > PART_HEIGHT_PX:
            parts.append([])
            used = 0.0
        parts[-1].append(k)
        used += height
    return parts


def _draw_question(
    figure: "Figure",
    question: QuestionScale,
    pairs: Sequence[PairShares],
    modes: tuple[str, ...],
    left: float,
    top: float,
    width: float,
    reach: float,
    most: int,
) -> None:
    write_heading(figure, left, top + 16, question, width)
    if not pairs:
        write_text(figure, left, top + _HEAD_PX + 14, "no answers")
        return
    names = dict(zip(modes, distinct(modes, 24), strict=True))
    side = min(140.0, 10 + max(width_px(names[m]) for m in modes))
    count = 8 + max(width_px(f"{p.n}", 8.4) for p in pairs)
    room = width - 2 * side - count
    height = _ROW_PX * len(pairs)
    axes = place_axes(figure, left + side, top + _HEAD_PX, room, height)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(len(pairs), 0)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.vlines(0, 0, len(pairs), color=LINE_STRONG, linewidth=0.75, zorder=0)
    axes.vlines((-reach, reach), 0, len(pairs), color=LINE, linewidth=0.75, zorder=0)
    for row, pair in enumerate(pairs):
        y = top + _HEAD_PX + _ROW_PX * row + 15
        write_text(figure, left + side - 8, y, fitted(names[pair.mode_i], side - 8), ha="right", color=INK)
        write_text(figure, left + side + room + 8, y, fitted(names[pair.mode_j], side - 8), color=INK)
        write_text(figure, left + width, y, f"{pair.n}", ha="right", fontsize=8.4, color=INK_2)
        if pair.n:
            _draw_bar(axes, row, [c / pair.n for c in pair.counts], most)
            if pair.expected:
                _draw_expected(axes, row, list(pair.expected))


def _left_edge(shares: list[float]) -> float:
    """Where the bar starts so that the middle of its ties lies at 0."""
    half = len(shares) // 2
    tie = shares[half] / 2 if len(shares) % 2 else 0.0
    return -(math.fsum(shares[:half]) + tie)


def _reach(pair: PairShares) -> float:
    """How far a pair's bar or its expected shares extend from the middle of the ties."""
    drawn = [[c / pair.n for c in pair.counts], *([list(pair.expected)] if pair.expected else [])]
    return max(max(-_left_edge(shares), 1 + _left_edge(shares)) for shares in drawn)


def _colours(levels: int, most: int) -> tuple[str, ...]:
    """Colours of the answers, where the longest scale of the figure has so many strengths of preference."""
    by_strength = _STRENGTHS[most][: levels // 2]
    return (*reversed(by_strength), *(SUNKEN,) * (levels % 2), *by_strength)


def _draw_bar(axes: "Axes", row: int, shares: list[float], most: int) -> None:
    start = _left_edge(shares)
    for share, colour in zip(shares, _colours(len(shares), most), strict=True):
        if share > 0:
            edge = LINE_STRONG if colour == SUNKEN else SURFACE
            axes.barh(
                row + 0.42,
                share,
                left=start,
                height=0.52,
                color=colour,
                edgecolor=edge,
                linewidth=0.6,
                zorder=2,
            )
        start += share


def _draw_expected(axes: "Axes", row: int, shares: list[float]) -> None:
    start = _left_edge(shares)
    edges = [start + math.fsum(shares[:k]) for k in range(len(shares) + 1)]
    axes.hlines(row + 0.82, edges[0], edges[-1], color=INK_3, linewidth=0.75, zorder=3)
    axes.vlines(edges, row + 0.74, row + 0.90, color=INK, linewidth=1.0, zorder=4)


def _draw_key(
    figure: "Figure", y: float, levels: set[int], most: int, shown: Sequence[Sequence[PairShares]]
) -> None:
    strengths = list(zip(_STRENGTHS[most], strength_names(most), strict=True))
    entries = strengths[: max(levels) // 2][::-1]
    if any(n % 2 for n in levels):
        entries.append((SUNKEN, SAME))
    x = 0.0
    for colour, text in entries:
        swatch = place_axes(figure, x, y - 9, 14, 10)
        swatch.set_xticks([])
        swatch.set_yticks([])
        swatch.set_facecolor(colour)
        if colour == SUNKEN:
            for spine in swatch.spines.values():
                spine.set(visible=True, color=LINE_STRONG, linewidth=0.6)
        write_text(figure, x + 19, y, text, fontsize=8.4)
        x += 19 + width_px(text, 8.4) + 18
    if any(pair.expected for pairs in shown for pair in pairs):
        mark = place_axes(figure, x, y - 9, 26, 10)
        mark.set_xlim(-0.1, 2.1)
        mark.set_ylim(0, 1)
        mark.set_xticks([])
        mark.set_yticks([])
        mark.hlines(0.5, 0, 2, color=INK_3, linewidth=0.75)
        mark.vlines((0, 0.8, 2), 0.2, 0.8, color=INK, linewidth=1.0)
        write_text(figure, x + 31, y, "expected by the model", fontsize=8.4)


def _alt(questions: Sequence[QuestionScale], shown: Sequence[Sequence[PairShares]]) -> str:
    said = []
    for question, pairs in zip(questions, shown, strict=True):
        rows = [
            f"{one_line(p.mode_i)} against {one_line(p.mode_j)} {'-'.join(map(str, p.counts))}"
            for p in pairs[:12]
        ]
        said.append(f"{one_line(question.name)}: {'; '.join(rows)}.")
    return "Answers by pair, from most for the first to most for the second. " + " ".join(said)
