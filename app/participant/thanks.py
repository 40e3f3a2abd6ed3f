"""The last page."""

import hashlib

import streamlit as st

from app.participant.texts import texts
from data.records import Participant


def show(participant: Participant) -> None:
    """Thanks, and a code that proves taking part without saying who it was."""
    words = texts()["thanks"]
    st.title(words["title"], anchor=False)
    st.markdown(words["text"])
    st.subheader(words["code"], anchor=False)
    st.code(completion_code(participant), language=None)
    st.caption(words["code_hint"])
    st.markdown(words["close"])


def completion_code(participant: Participant) -> str:
    """Eight characters in two groups; the same participant has the same code."""
    digest = hashlib.sha256(f"completion {participant.id}".encode()).hexdigest().upper()
    return f"{digest[:4]}-{digest[4:8]}"
