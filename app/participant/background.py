"""The study's questions about the participant: one short form, once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

import streamlit as st

from app.participant.progress import Progress
from app.participant.text_page import head
from app.participant.texts import filled, texts
from app.participant.trouble import attempt
from app.server.desk import Desk
from data.study import BackgroundQuestion

MOST_LETTERS = 200
_OPEN = "background-open"
_MOST_CHOICES_IN_A_ROW = 5


@dataclass(frozen=True)
class Filled:
    """A form as it was submitted.

    Attributes
    ----------
    answers : mapping
        By the question's name; what was left out is not in it.
    open : tuple of str
        Names of the questions that still need an answer.
    """

    answers: Mapping[str, str]
    open: tuple[str, ...]


def show(desk: Desk, progress: Progress) -> None:
    """The form; a question that needs an answer and has none says so."""
    questions = desk.study.background
    words = texts()["background"]
    head(words["title"], progress)
    has_required = any(question.required for question in questions)
    st.markdown(words["text"] + ("" if has_required else " " + words["text_all_free"]))
    missing = st.session_state.get(_OPEN, ())
    with st.form("background", border=False, enter_to_submit=False):
        for i, question in enumerate(questions):
            is_marked = has_required and not question.required
            label = filled(words, wording=question.wording)["optional"] if is_marked else question.wording
            _field(question, label, _key(i))
            if question.name in missing:
                st.html(f'<p class="missing" role="alert">{escape(_what_is_missing(question))}</p>')
        st.form_submit_button(words["next"], type="primary", on_click=_submit, args=(desk, progress))


def read_form(questions: Sequence[BackgroundQuestion], given: Mapping[str, object]) -> Filled:
    """What a form holds, checked.

    Parameters
    ----------
    given : mapping
        What stands in each question's field, by the question's name; None or empty for nothing.
    """
    answers, still_open = {}, []
    for question in questions:
        value = given.get(question.name)
        answer = _answer(question, value)
        if answer is not None:
            answers[question.name] = answer
        elif question.required or value not in (None, ""):
            still_open.append(question.name)
    return Filled(answers, tuple(still_open))


def _answer(question: BackgroundQuestion, value: object) -> str | None:
    """The answer as it is stored; None if there is none, or none that the question allows."""
    if question.kind == "choice":
        return next((choice for choice in question.choices if choice == value), None)
    if question.kind == "number":
        if isinstance(value, bool) or not isinstance(value, int | float):
            return None
        return f"{value:.12g}" if question.lowest <= value <= question.highest else None
    return (value.strip()[:MOST_LETTERS] or None) if isinstance(value, str) else None


def _field(question: BackgroundQuestion, label: str, key: str) -> None:
    if question.kind == "choice":
        choices = question.choices
        is_row = len(choices) <= _MOST_CHOICES_IN_A_ROW
        st.radio(label, choices, index=None, horizontal=is_row, key=key)
    elif question.kind == "number":
        # The bounds are checked at the end: a field that corrects what is typed is hard to follow.
        st.number_input(label, value=None, step=1.0, format="%g", key=key)
    else:
        st.text_input(label, max_chars=MOST_LETTERS, key=key, autocomplete="off")


def _what_is_missing(question: BackgroundQuestion) -> str:
    words = texts()["background"]
    if question.kind != "number":
        return words["missing"]
    return filled(words, lowest=f"{question.lowest:g}", highest=f"{question.highest:g}")["number"]


def _submit(desk: Desk, progress: Progress) -> None:
    questions = desk.study.background
    given = {question.name: st.session_state.get(_key(i)) for i, question in enumerate(questions)}
    form = read_form(questions, given)
    st.session_state[_OPEN] = form.open
    if not form.open:
        attempt(lambda: desk.store.record_background(progress.participant.id, form.answers, desk.clock()))


def _key(i: int) -> str:
    # A number and not the question's name: keys are seen by the browser.
    return f"background-{i + 1}"
