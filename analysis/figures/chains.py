"""Whether the chains agree, drawn as the ranks of their draws."""

from collections.abc import Sequence

import numpy as np

from analysis.figures.labels import fitted, one_line
from analysis.figures.style import (
    DATA,
    DATA_TINT,
    INK,
    INK_3,
    WIDTH_PX,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)
from analysis.results import QuestionFit

_BINS = 20


def draw_chains(questions: Sequence[QuestionFit], tag: str = "") -> Drawing | None:
    """Rank histograms of the slowest quantity of each question, one a chain.

    Chains that sample the same distribution have flat histograms: each bin then holds one part in
    twenty of a chain's draws, give or take chance (the grey band, two standard deviations).

    References
    ----------
    Vehtari, Gelman, Simpson, Carpenter, Bürkner (2021), Bayesian Analysis 16(2), section 4.
    """
    sampled = [q for q in questions if q.draws is not None]
    if not sampled:
        return None
    with house_style():
        pitch, left, gap = 40, 190, 14
        chains = max(q.draws.ability.shape[0] for q in sampled if q.draws is not None)
        width = min(150.0, (WIDTH_PX - left) / chains - gap)
        figure = new_figure(30 + pitch * len(sampled) + 8)
        for c in range(chains):
            write_text(figure, left + c * (width + gap), 16, f"chain {c + 1}", fontsize=8.4)
        for row, question in enumerate(sampled):
            label, values = _slowest(question)
            top = 26 + row * pitch
            write_text(
                figure,
                0,
                top + 15,
                fitted(question.question.name, left - 16, 9, True),
                color=INK,
                weight="bold",
            )
            write_text(figure, 0, top + 29, fitted(label, left - 16, 8.4), fontsize=8.4)
            ranks = np.argsort(np.argsort(values, axis=None)).reshape(values.shape)
            expected = values.shape[1] / _BINS
            band = 2 * np.sqrt(expected * (1 - 1 / _BINS))
            for c in range(values.shape[0]):
                axes = place_axes(figure, left + c * (width + gap), top + 2, width, pitch - 10)
                counts, _ = np.histogram(ranks[c], bins=_BINS, range=(0, values.size))
                axes.axhspan(expected - band, expected + band, color=DATA_TINT, linewidth=0)
                axes.stairs(counts, np.arange(_BINS + 1), baseline=None, color=DATA, linewidth=1.1)
                axes.axhline(expected, color=INK_3, linewidth=0.7, linestyle=(0, (1.5, 2.2)))
                axes.set_ylim(0, max(2 * expected, float(counts.max()) * 1.05))
                axes.set_xlim(0, _BINS)
                axes.set_xticks([])
                axes.set_yticks([])
        alt = "Rank histograms by chain; flat is good. " + " ".join(
            f"{one_line(q.question.name)}: R-hat {q.rhat_max:.3f}, ESS {q.ess_min:.0f}." for q in sampled
        )
        return finish(figure, "chains", alt, tag)


def _slowest(question: QuestionFit) -> tuple[str, np.ndarray]:
    """The subject sd where there is one (always the bottleneck), else the first mode's ability."""
    assert question.draws is not None
    if "subject_sd" in question.draws.parameters:
        return "subject sd", np.asarray(question.draws.parameters["subject_sd"])
    mode = question.modes[0].mode if question.modes else "first mode"
    return f"ability of {one_line(mode)}", question.draws.ability[..., 0]
