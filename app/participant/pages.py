"""The participant's pages as a small state machine: the store says where someone is, each page leads on."""

import streamlit as st

from app.participant import comparison, consent, instructions, thanks
from app.participant.progress import progress_of
from app.participant.texts import texts
from app.participant.trouble import show_or_say_trouble
from app.server.desk import desk
from app.server.visitors import visitor
from app.stage.stage import bare_page, text_page


def show_study() -> None:
    """Show the page that the visitor's progress asks for."""
    words = texts()["page"]
    st.set_page_config(page_title=words["browser_title"], page_icon=None, layout="wide")
    show_or_say_trouble(_show_page)


def _show_page() -> None:
    words = texts()["page"]
    here = visitor(desk(), st.context.cookies)
    if here is None:
        text_page()
        st.title(words["no_link_title"], anchor=False)
        st.markdown(words["no_link"])
        return
    if here.participant is None:
        text_page()
        consent.show(desk(), here)
        return
    progress = progress_of(desk().store, here.participant)
    if progress.place == "comparison":
        bare_page()
        comparison.show(desk(), progress)
        return
    text_page()
    if progress.place == "instructions":
        instructions.show(desk(), progress)
    elif progress.place == "between":
        instructions.show_between(desk(), progress)
    else:
        thanks.show(progress.participant)
