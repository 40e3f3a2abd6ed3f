"""The last page: it is shown once everything is stored."""

import hashlib
from html import escape

import streamlit as st

from app.participant.progress import Progress
from app.participant.text_page import head
from app.participant.texts import texts
from app.server.desk import Desk
from data.records import Participant


def show(desk: Desk, progress: Progress) -> None:
    """Thanks, a code that proves taking part without saying who it was, and the way on if there is one."""
    words = texts()["thanks"]
    code = completion_code(progress.participant)
    onward = finish_address(desk.study.protocol.finish_url, code)
    head(words["title"], progress)
    st.markdown(words["text"])
    st.subheader(words["code"], anchor=False)
    st.code(code, language=None)
    st.caption(words["code_hint"])
    if onward:
        st.markdown(words["leave"])
        # Streamlit's own link button opens another window.
        st.html(f'<a class="onward" href="{escape(onward)}">{escape(words["next"])}</a>')
    else:
        st.markdown(words["close"])


def completion_code(participant: Participant) -> str:
    """Eight characters in two groups; the same participant has the same code."""
    digest = hashlib.sha256(f"completion {participant.id}".encode()).hexdigest().upper()
    return f"{digest[:4]}-{digest[4:8]}"


def finish_address(finish_url: str, code: str) -> str:
    """Where the participant goes from here, with the code filled in; empty if nowhere."""
    return finish_url.replace("{code}", code)
