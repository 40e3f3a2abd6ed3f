"""The first page: what taking part means, and agreeing to it."""

import streamlit as st

from app.participant.text_page import head, lead_on
from app.participant.texts import texts
from app.server.access_log import LOG
from app.server.desk import Desk
from app.server.visitors import Visitor, admit
from data.store import LinkRefused


def show(desk: Desk, here: Visitor) -> None:
    """The study's own consent text, and one button."""
    words = texts()["consent"]
    head(words["title"])
    st.markdown(desk.study.consent.text)
    lead_on(words["agree"], lambda: _agree(desk, here))
    st.caption(words["decline"])


def _agree(desk: Desk, here: Visitor) -> None:
    """Begin; if the link is over or its participant withdrew meanwhile, the page that follows says so."""
    try:
        admit(desk, here.cookie)
    except LinkRefused as error:
        LOG.info("agreed too late: %s", error)
