"""The first page: what taking part means, and agreeing to it."""

import streamlit as st

from app.participant.texts import texts
from app.participant.trouble import attempt
from app.server.desk import Desk
from app.server.visitors import Visitor, admit


def show(desk: Desk, here: Visitor) -> None:
    """The study's own consent text, and one button."""
    words = texts()["consent"]
    st.title(words["title"], anchor=False)
    st.markdown(desk.study.consent.text)
    st.button(words["agree"], type="primary", on_click=attempt, args=(lambda: admit(desk, here.cookie),))
    st.caption(words["decline"])
