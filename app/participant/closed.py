"""The pages of those who take part no longer: the study's hours are over, or their data were withdrawn."""

import streamlit as st

from app.participant.text_page import head
from app.participant.texts import texts


def show_closed() -> None:
    """The time to come back has passed."""
    _show("closed")


def show_withdrawn() -> None:
    """The participant's data were deleted."""
    _show("withdrawn")


def _show(page: str) -> None:
    words = texts()[page]
    head(words["title"])
    st.markdown(words["text"])
    st.markdown(words["close"])
