"""The console's pages, behind the researcher's cookie."""

from collections.abc import Callable
from functools import partial

import streamlit as st

from app.console import data_page, links_page, overview, results, study_page
from app.console.style import LOGO, console_page
from app.participant.pages import show_study
from app.participant.texts import texts
from app.server.desk import Desk, desk
from app.server.visitors import is_researcher

_PAGES: dict[str, tuple[str, Callable[[Desk], None]]] = {
    "overview": ("Overview", overview.show),
    "results": ("Results", results.show),
    "data": ("Data", data_page.show),
    "study-file": ("Study file", study_page.show),
    "links": ("Links", links_page.show),
}
PATHS = frozenset(_PAGES)
"""The addresses that belong to the console."""


def show_console() -> None:
    """Show the page of the address, or that a link is needed."""
    st.set_page_config(page_title="Elbowroom", layout="wide")
    if not is_researcher(desk(), st.context.cookies):
        words = texts()["page"]
        st.title(words["no_link_title"], anchor=False)
        st.markdown(words["no_link"])
        return
    console_page()
    st.logo(LOGO, size="large")
    pages = [
        st.Page(partial(show, desk()), title=title, url_path=path) for path, (title, show) in _PAGES.items()
    ]
    # Streamlit serves its default page at the root, which belongs to participants.
    home = st.Page(show_study, title=texts()["page"]["browser_title"], default=True, visibility="hidden")
    st.navigation([home, *pages], position="sidebar").run()
