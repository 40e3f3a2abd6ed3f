"""Withdrawing a participant's data: says what is deleted, asks once more, leaves a line in the audit log."""

from collections.abc import Sequence

import streamlit as st

from app.console.people import Seat
from app.console.style import card, heading
from app.server.desk import Desk
from data.errors import ElbowroomError


def withdraw_button(desk: Desk, everyone: Sequence[Seat]) -> None:
    """Choose somebody, and withdraw."""
    there = {seat.name: seat for seat in everyone if seat.participant.withdrawn_at is None}
    if not there:
        return
    with card("withdraw"):
        heading("Withdraw a participant")
        chosen, button = st.columns([0.75, 0.25], vertical_alignment="bottom")
        name = chosen.selectbox("Participant", list(there), index=None, placeholder="Choose a participant")
        if button.button("Withdraw…", disabled=name is None, width="stretch") and name is not None:
            _confirm(desk, there[name])


@st.dialog("Withdraw this participant's data?")
def _confirm(desk: Desk, seat: Seat) -> None:
    st.markdown(
        f"**{seat.name}** gave {_counted(seat.answered, 'answered comparison')} and "
        f"{_counted(seat.trials, 'trial')}. These are deleted for good: comparisons, answers, trials with "
        "their recordings, the answers about the person, and their link. Their number and the times of "
        "joining and withdrawing stay, and the audit log keeps that it was done. Exports that were made "
        "before still hold the data: delete them yourself."
    )
    if seat.live is not None and seat.live.is_connected:
        st.markdown("They are at the robot right now; their page ends.")
    yes, no = st.columns(2)
    if yes.button("Delete their data", type="primary", width="stretch"):
        try:
            desk.store.withdraw(seat.participant.id, "researcher", desk.clock())
        except ElbowroomError as error:
            st.error(str(error))
            return
        st.rerun()
    if no.button("Keep them", width="stretch"):
        st.rerun()


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
