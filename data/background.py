"""Answers to the background questions: what may be kept of them."""

import re
from collections.abc import Mapping

from data.errors import InputError, one_of
from data.study import BackgroundQuestion, Study

LONGEST_TEXT = 200
"""Characters of an answer in words."""
_NUMBER = re.compile(r"-?\d{1,15}(\.\d{1,15})?", re.ASCII)


def checked_background(study: Study, answers: Mapping[str, str]) -> dict[str, str]:
    """The answers that were given, in the order of the questions; an empty one is none.

    Raises
    ------
    InputError
        If a question is unknown, a required one has no answer, or an answer is none that the question takes.
    """
    names = [question.name for question in study.background]
    for name in answers:
        if name not in names:
            raise one_of("background question", name, names)
    given: dict[str, str] = {}
    for question in study.background:
        answer = answers.get(question.name, "").strip()
        if answer:
            _check(question, answer)
            given[question.name] = answer
        elif question.required:
            raise InputError(f"background question {question.name} has no answer")
    return given


def _check(question: BackgroundQuestion, answer: str) -> None:
    where = f"answer to {question.name}"
    match question.kind:
        case "choice":
            if answer not in question.choices:
                raise one_of(where, answer, question.choices)
        case "number":
            if not _NUMBER.fullmatch(answer) or not question.lowest <= float(answer) <= question.highest:
                within = f"{question.lowest:g} to {question.highest:g}"
                raise InputError(f"{where}: {answer[:40]!r} is no number from {within}")
        case "text":
            if len(answer) > LONGEST_TEXT:
                raise InputError(f"{where}: {len(answer)} characters; at most {LONGEST_TEXT} are kept")
