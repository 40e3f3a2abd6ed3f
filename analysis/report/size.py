"""What a study of this size cannot tell: a likely first among several questions, or after early looks.

Each sentence rests on a quick estimate for the study's own schedule and people; see `analysis.looks`.
"""

from collections.abc import Sequence

from analysis.figures.labels import LIKELY, percent_in_words
from analysis.looks import look_errors, looks_sentence
from analysis.observed_design import ObservedDesign, observed_design
from analysis.report.findings import Finding
from analysis.results import Fit
from data.records import Look


def size_cautions(fit: Fit, found: Sequence[Finding], looks: Sequence[Look], shown: Look) -> list[str]:
    """Sentences for the list "Before you quote this".

    Parameters
    ----------
    looks : sequence of Look
        When the results were shown before, at other answers; empty also where nobody kept that.
    shown : Look
        The answers of people behind this report.
    """
    design = observed_design(fit)
    said = _among_several(found, design)
    if looks:
        said.append(looks_sentence(looks, shown, design, "before this report"))
    return said


def _among_several(found: Sequence[Finding], design: ObservedDesign | None) -> list[str]:
    """How often studies without any preference have a likely first, where there are several questions."""
    ranked = sum(f.reading != "not ranked" for f in found)
    if design is None or ranked < 2 or not any(f.reading == "likely" for f in found):
        return []
    one = look_errors(design, (design.people,), LIKELY).once
    chance = percent_in_words(1.0 - (1.0 - one) ** ranked)
    return [
        f"If nobody preferred any mode, at least one of {ranked} questions would still have a likely first "
        f"place in about {chance} of studies of this size."
    ]
