"""The participant's pages as a small state machine: the store says where someone is, each page leads on."""

import streamlit as st

from app.participant import background, between, closed, comparison, consent, instructions, practice, thanks
from app.participant.progress import progress_of
from app.participant.text_page import head
from app.participant.texts import texts
from app.participant.trouble import show_or_say_trouble
from app.server.desk import desk
from app.server.visitors import visitor
from app.stage.stage import bare_page


def show_study() -> None:
    """Show the page that the visitor's progress asks for."""
    words = texts()["page"]
    st.set_page_config(page_title=words["browser_title"], page_icon=None, layout="wide")
    show_or_say_trouble(_show_page)


def _show_page() -> None:
    words = texts()["page"]
    here = visitor(desk(), st.context.cookies)
    if here is None:
        head(words["no_link_title"])
        st.markdown(words["no_link"])
        return
    if here.participant is None:
        consent.show(desk(), here)
        return
    progress = progress_of(desk().store, here.participant)
    match progress.place_in(desk().study, desk().clock()):
        case "withdrawn":
            closed.show_withdrawn()
        case "closed":
            closed.show_closed()
        case "background":
            background.show(desk(), progress)
        case "instructions":
            instructions.show(desk(), progress)
        case "practice":
            bare_page()
            practice.show(desk(), progress)
        case "ready":
            between.show_ready(desk(), progress)
        case "comparison":
            bare_page()
            comparison.show(desk(), progress)
        case "between":
            between.show_between(desk(), progress)
        case "break":
            between.show_break(desk(), progress)
        case "thanks":
            thanks.show(desk(), progress)
