"""What a participant sees when something doesn't work: a full disk, a store kept busy, a fault of ours."""

from collections.abc import Callable

import streamlit as st

from app.participant.texts import texts
from app.server.access_log import LOG
from app.stage.stage import text_page
from data.errors import ElbowroomError

_FAILED = "trouble"


def attempt(act: Callable[[], object]) -> None:
    """Do what a button asks for, in its callback; if it fails, the page that follows says so."""
    if not _succeeds(act):
        st.session_state[_FAILED] = True


def show_or_say_trouble(show: Callable[[], None]) -> None:
    """Show a page, or that something doesn't work; a reload tries again."""
    if not st.session_state.pop(_FAILED, False) and _succeeds(show):
        return
    words = texts()["page"]
    text_page()
    st.title(words["trouble_title"], anchor=False)
    st.markdown(words["trouble"])


def _succeeds(act: Callable[[], object]) -> bool:
    """Whether it was done; what went wrong is in the log, whatever it was: Streamlit would show it in red."""
    try:
        act()
    except ElbowroomError as error:
        LOG.error("participant's page: %s", error)
    except Exception:
        LOG.exception("participant's page")
    else:
        return True
    return False
