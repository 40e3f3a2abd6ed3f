"""Coming back to a comparison that is under way, in a study that then begins it anew.

A participant comes back to a comparison with a page that didn't begin it: a page opened or reloaded, in the
same or another window, browser or device, for a comparison that has a trial already or was begun more than
`GRACE_S` ago. Turning to the questions and back, and a connection that was lost for a while, stay on the same
page, so they don't count: Streamlit keeps the page's session for two minutes without a connection. After
that, or after the server was started again, what the page tells us cannot be told from a page opened anew,
and it counts as one.
"""

from collections.abc import Collection
from datetime import datetime

import streamlit as st

from app.participant.watching import counting_trials
from data.records import Comparison
from data.store import Store
from data.study import Study

GRACE_S = 5.0
"""A page reloaded right after the beginning, before the robot has moved, has lost nothing."""
_HERE = "comparisons-of-this-page"


def note_begun(comparison: Comparison) -> None:
    """Remember that this page began a comparison, or began it anew."""
    st.session_state[_HERE] = {*_begun_here(), comparison.id}


def anew_if_back(study: Study, store: Store, comparison: Comparison, now: datetime) -> Comparison:
    """The open comparison; begun anew if the study wants that and the participant came back to it."""
    has_trials = bool(counting_trials(store, comparison))
    if is_coming_back(study, comparison, _begun_here(), has_trials, now):
        comparison = store.restart_comparison(comparison.id, now)
    note_begun(comparison)
    return comparison


def is_coming_back(
    study: Study, comparison: Comparison, begun_here: Collection[str], has_trials: bool, now: datetime
) -> bool:
    """Whether a page that began the comparisons ``begun_here`` has to begin an open one anew."""
    if study.protocol.returning != "restart_comparison" or comparison.id in begun_here:
        return False
    begun = comparison.restarted_at or comparison.started_at
    return has_trials or begun is None or (now - begun).total_seconds() > GRACE_S


def _begun_here() -> frozenset[str]:
    return frozenset(st.session_state.get(_HERE, ()))
