"""Showing the modes' names: asked twice, kept in the audit log, not to be undone."""

import streamlit as st

from app.server.desk import Desk


def unblind_button(desk: Desk) -> None:
    """A button while the study is blinded; afterwards, that it isn't."""
    if desk.store.is_unblinded(desk.stored_study):
        st.caption("Unblinded: modes are shown by name. The audit log says when.")
        return
    text, button = st.columns([0.84, 0.16], vertical_alignment="center")
    text.caption("Blinded: modes are shown as letters in an order that tells nothing.")
    if button.button("Unblind", width="stretch"):
        _confirm(desk)


@st.dialog("Show the modes' names?")
def _confirm(desk: Desk) -> None:
    st.markdown(
        "From now on everyone who opens this console sees which mode is which. The audit log keeps the time. "
        "**This can't be undone.** Wait until all participants have finished, if you can."
    )
    yes, no = st.columns(2)
    if yes.button("Unblind now", type="primary", width="stretch"):
        desk.store.unblind(desk.stored_study, "researcher", desk.clock())
        st.rerun()
    if no.button("Stay blinded", width="stretch"):
        st.rerun()
