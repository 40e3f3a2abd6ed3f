"""Figures that set one list of modes out for all questions, for questions that have modes of their own."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from analysis.figures.style import Drawing
from analysis.results import QuestionFit

Draw = Callable[[Sequence[QuestionFit], tuple[str, ...]], tuple[Drawing, ...]]
"""Draws questions that are all about the given modes."""


def draw_by_modes(questions: Sequence[QuestionFit], draw: Draw) -> tuple[Drawing, ...]:
    """Drawings of the questions about the same modes together, in the order of their first questions."""
    by_modes: dict[tuple[str, ...], list[QuestionFit]] = {}
    for question in questions:
        by_modes.setdefault(question.mode_names, []).append(question)
    if len(by_modes) == 1:
        return draw(questions, questions[0].mode_names)
    return tuple(
        replace(drawing, name=f"{drawing.name}_modes_{number}")
        for number, (modes, own) in enumerate(by_modes.items(), start=1)
        for drawing in draw(own, modes)
    )
