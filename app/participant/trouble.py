"""What a participant sees when the store can't be written or read: a full disk, a store kept busy."""

from collections.abc import Callable

import streamlit as st

from app.participant.texts import texts
from app.server.access_log import LOG
from app.stage.stage import text_page
from data.errors import ElbowroomError

_FAILED = "trouble"


def attempt(act: Callable[[], object]) -> None:
    """Do what a button asks for, in its callback; if it fails, the page that follows says so."""
    try:
        act()
    except ElbowroomError as error:
        LOG.error("participant's page: %s", error)
        st.session_state[_FAILED] = True


def show_or_say_trouble(show: Callable[[], None]) -> None:
    """Show a page, or that something went wrong; a reload tries again."""
    if not st.session_state.pop(_FAILED, False):
        try:
            show()
            return
        except ElbowroomError as error:
            LOG.error("participant's page: %s", error)
    words = texts()["page"]
    text_page()
    st.title(words["trouble_title"], anchor=False)
    st.markdown(words["trouble"])
