"""The short pages around comparisons: before the first one, between two, and a break."""

import streamlit as st

from app.participant.instructions import comparisons_in_words, lead_on_to_next, questions_in_words
from app.participant.progress import Progress
from app.participant.text_page import head
from app.participant.texts import filled, texts
from app.server.desk import Desk


def show_ready(desk: Desk, progress: Progress) -> None:
    """Before the first comparison, for those who guide: what A and B are, and what is asked."""
    words = filled(texts()["ready"], questions=questions_in_words(len(desk.study.questions)))
    head(words["title"], progress)
    st.markdown(words["text"])
    st.markdown(comparisons_in_words(len(progress.comparisons)))
    lead_on_to_next(desk, progress, words["next"])


def show_between(desk: Desk, progress: Progress) -> None:
    """After a comparison: the answers are stored, the next A and B are new."""
    _show(desk, progress, "between")


def show_break(desk: Desk, progress: Progress) -> None:
    """The same after every few comparisons, and a word about resting."""
    _show(desk, progress, "break")


def _show(desk: Desk, progress: Progress, page: str) -> None:
    done, of = progress.answered, len(progress.comparisons)
    words = filled({**texts()["between"], **texts()[page]}, done=done, of=of, next=done + 1)
    head(words["title"], progress)
    st.markdown(words["text"])
    st.subheader(words["next_title"], anchor=False)
    st.markdown(words["next_text"])
    lead_on_to_next(desk, progress, words["next"])
