"""How likely each mode ranks above each other one, and on how many answers that rests."""

from collections.abc import Sequence

import numpy as np

from analysis.figures.grid import IN_ORDER_UP_TO, Grid, draw_grids
from analysis.figures.labels import one_line, percent
from analysis.figures.style import DATA_TINT, Drawing
from analysis.results import QuestionFit


def draw_pairwise(
    questions: Sequence[QuestionFit], modes: tuple[str, ...], tag: str = ""
) -> tuple[Drawing, ...]:
    """A matrix a question: the chance that the row's mode ranks above the column's.

    Below each chance stand the answers behind it as wins-ties-losses of the row's mode.
    More than eight modes are sorted by their mean rank.
    """

    def grid_of(question: QuestionFit) -> Grid | None:
        if not question.ranked:
            return None
        shown = modes
        if len(modes) > IN_ORDER_UP_TO:
            shown = tuple(m.mode for m in sorted(question.modes, key=lambda m: m.rank_mean))
        place = {mode: k for k, mode in enumerate(shown)}
        shares = np.full((len(modes), len(modes)), np.nan)
        notes = [[""] * len(modes) for _ in modes]
        for pair in question.pairs:
            i, j = place[pair.mode_i], place[pair.mode_j]
            shares[i, j], shares[j, i] = pair.p_i_above_j, 1 - pair.p_i_above_j
            if len(modes) <= IN_ORDER_UP_TO:
                notes[i][j] = f"{pair.wins_i}-{pair.ties}-{pair.wins_j}"
                notes[j][i] = f"{pair.wins_j}-{pair.ties}-{pair.wins_i}"
        return Grid(shares, shown, shown, notes)

    return draw_grids(
        questions,
        modes,
        grid_of,
        name="pairwise",
        alt=_alt(questions),
        text_of=lambda share: f"{percent(share)}",
        column_title="",
        middle=DATA_TINT,
        tag=tag,
    )


def _alt(questions: Sequence[QuestionFit]) -> str:
    said = []
    for question in questions:
        if not question.ranked:
            said.append(f"{one_line(question.question.name)}: not ranked.")
            continue
        clear = sorted(
            {
                (one_line(p.mode_i), one_line(p.mode_j), p.p_i_above_j)
                if p.p_i_above_j >= 0.5
                else (one_line(p.mode_j), one_line(p.mode_i), 1 - p.p_i_above_j)
                for p in question.pairs
            },
            key=lambda pair: -pair[2],
        )
        best = "; ".join(f"{i} above {j} {percent(p)} %" for i, j, p in clear[:6])
        said.append(f"{one_line(question.question.name)}: {best}.")
    return "Chance that one mode ranks above another. " + " ".join(said)
