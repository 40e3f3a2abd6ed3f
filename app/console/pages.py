"""The console's pages, behind the researcher's cookie."""

from collections.abc import Callable
from functools import partial

import streamlit as st

from app.console import (
    data_page,
    links_page,
    overview,
    planning_page,
    results,
    sessions_page,
    study_page,
    trials_page,
)
from app.console.style import LOGO, console_page
from app.operator import page as operator_page
from app.participant.pages import show_study
from app.participant.texts import texts
from app.server.desk import Desk, desk
from app.server.passphrase import has_passphrase
from app.server.visitors import is_researcher
from data.errors import ElbowroomError


def _modes(desk: Desk) -> None:
    # With it comes the simulator, of which a server for a robot in the lab knows nothing until somebody asks.
    from app.console import modes_page

    modes_page.show(desk)


_PAGES: dict[str, tuple[str, Callable[[Desk], None]]] = {
    "overview": ("Overview", overview.show),
    "sessions": ("Sessions", sessions_page.show),
    "trials": ("Trials", trials_page.show),
    "modes": ("Modes", _modes),
    "results": ("Results", results.show),
    "data": ("Data", data_page.show),
    "study-file": ("Study file", study_page.show),
    "links": ("Links", links_page.show),
    "planning": ("Planning", planning_page.show),
}
_LAB_PAGES: dict[str, tuple[str, Callable[[Desk], None]]] = {"operator": ("Operator", operator_page.show)}
"""Only for studies with a robot in the lab."""
PATHS = frozenset(_PAGES) | frozenset(_LAB_PAGES)
"""The addresses that belong to the console."""


def show_console() -> None:
    """Show the page of the address, or that a link is needed."""
    st.set_page_config(page_title="Elbowroom", layout="wide")
    if not is_researcher(desk(), st.context.cookies):
        words = texts()["page"]
        st.title(words["no_link_title"], anchor=False)
        st.markdown(words["no_link"])
        if has_passphrase():
            st.markdown("Researchers can also [sign in with the passphrase](/researcher).")
        return
    console_page()
    st.logo(LOGO, size="large")
    shown = _PAGES | (_LAB_PAGES if desk().study.protocol.trial_source == "external" else {})
    pages = [
        st.Page(partial(_show, show), title=title, url_path=path) for path, (title, show) in shown.items()
    ]
    # Streamlit serves its default page at the root, which belongs to participants.
    home = st.Page(show_study, title=texts()["page"]["browser_title"], default=True, visibility="hidden")
    st.navigation([home, *pages], position="sidebar").run()


def _show(show: Callable[[Desk], None]) -> None:
    """One page; what the store or the study has against it is said in a line, not in a stack of calls."""
    try:
        show(desk())
    except ElbowroomError as error:
        st.error(str(error))
