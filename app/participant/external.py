"""A comparison on a robot in the lab: the participant turns to A or B, and sees what the operator is doing.

What happens at the robot stands in the store (`app.operator.session`) and is read anew every second.
"""

from datetime import datetime

import streamlit as st

from app.operator import session
from app.participant.comparison import to_questions
from app.participant.progress import SLOTS, Progress, progress_of
from app.participant.texts import filled, texts, texts_with_parts
from app.participant.trouble import attempt
from app.server.access_log import LOG
from app.server.desk import Desk
from app.stage.stage import lab
from data.errors import ElbowroomError
from data.records import Comparison
from data.store import Store
from data.study import Study

_REFRESH_S = 1.0
_STEADY = '[data-testid="stMain"] [data-stale="true"] { opacity: 1 !important; transition: none !important; }'
_SHOWN = "external-shown"
_LEAVES = "external-leaves"


def show(desk: Desk, progress: Progress) -> None:
    """A and B, what happens at the robot, and the way to the questions."""
    assert progress.comparison is not None
    # Drawn anew every second, the page must not pale each time the server takes a moment longer.
    st.html(f"<style>{_STEADY}</style>")
    _robot(desk, progress.participant.id, progress.comparison)


@st.fragment(run_every=_REFRESH_S)
def _robot(desk: Desk, participant: str, comparison: Comparison) -> None:
    try:
        progress = progress_of(desk.store, desk.store.participant(participant))
        place = progress.place_in(desk.study, desk.clock())
        now_open = progress.comparison
        is_elsewhere = place != "comparison" or now_open is None or now_open.id != comparison.id
        if st.session_state.pop(_LEAVES, False) or is_elsewhere:
            # On to the questions; or they were answered in another window, or the study is over.
            st.rerun()
        assert now_open is not None
        data = lab_data(desk.study, desk.store, progress, now_open, desk.clock())
        st.session_state[_SHOWN] = data
    except ElbowroomError as error:
        # The store is busy or full: what was seen last stays, and the next second tries again.
        LOG.error("participant's page: %s", error)
        data = st.session_state.get(_SHOWN, {})
        if data.get("comparison") != comparison.position:
            raise
        data = {**data, "trouble": True}
    lab(
        data,
        key=f"lab-{comparison.position}",
        on_turned=lambda slot: attempt(lambda: _turn(desk, comparison, slot)),
        on_answer=lambda: attempt(lambda: _leave(desk, participant, comparison)),
    )


def lab_data(
    study: Study, store: Store, progress: Progress, comparison: Comparison, now: datetime
) -> dict[str, object]:
    """All that the participant's browser is told; it says A and B and nothing of what is behind them."""
    standing = session.standing(store, comparison)
    of, done = len(progress.comparisons), progress.answered
    words = texts()["external"]
    own = {name: words[name] for name in ("title", "done")}
    return {
        "texts": {
            **texts_with_parts("external"),
            **filled(own, comparison=comparison.position, of=of, done=done),
        },
        "comparison": comparison.position,
        "comparisons": of,
        "required_s": study.protocol.minimum_exposure_s,
        "wanted": standing.run.wanted,
        "step": standing.step,
        "exposure": standing.exposure_by(now),
        "trouble": False,
    }


def _turn(desk: Desk, comparison: Comparison, wanted: object) -> None:
    slot = next((slot for slot in SLOTS if slot == wanted), None)
    if slot is not None:
        session.turn_to(desk.store, comparison, slot, desk.clock())


def _leave(desk: Desk, participant: str, comparison: Comparison) -> None:
    """End the run under way and go on to the questions, if they are open."""
    now = desk.clock()
    with desk.store.transaction():
        progress = progress_of(desk.store, desk.store.participant(participant))
        exposure = session.standing(desk.store, desk.store.comparison(comparison.id)).exposure_by(now)
        if not progress.may_answer(desk.study, exposure):
            return
        session.finish(desk.store, comparison.id, now)
    to_questions(comparison.position)
    st.session_state[_LEAVES] = True
