"""The first page: what taking part means, and agreeing to it."""

import streamlit as st

from app.participant.text_page import head, lead_on
from app.participant.texts import texts
from app.server.desk import Desk
from app.server.visitors import Visitor, admit


def show(desk: Desk, here: Visitor) -> None:
    """The study's own consent text, and one button."""
    words = texts()["consent"]
    head(words["title"])
    st.markdown(desk.study.consent.text)
    lead_on(words["agree"], lambda: admit(desk, here.cookie))
    st.caption(words["decline"])
