"""Overview: how far the study has come, how the modes stand under their labels, how good the data are."""

import streamlit as st

from app.console.charts import stuck_chart, worth_chart
from app.console.evidence import Evidence, evidence, includes_simulated, reliability, simulated_switch
from app.console.findings import ONLY_THESE
from app.console.labels import shown_labels
from app.console.people import Seat, seats
from app.console.quality import quality
from app.console.sessions_page import sessions_table
from app.console.style import Mark, card, heading, headline, key_figures, table
from app.console.trial_rows import trial_rows
from app.console.unblinding import unblind_button
from app.planning import expectation
from app.server.desk import Desk
from data.errors import InputError

_REFRESH_S = 10
_COLUMNS = 3


def show(desk: Desk) -> None:
    """The page; its figures are read anew every few seconds."""
    stored = desk.stored_study
    lock = Mark("good", "locked") if is_locked(desk) else Mark("off", "not locked: nobody has taken part")
    headline(desk.study.title, (stored.label, lock, stored.sha256[:8]))
    unblind_button(desk)
    simulated_switch(desk)
    _figures(desk)
    st.caption(f"{expectation(desk.study)} The page Planning simulates this with assumptions of your own.")


def is_locked(desk: Desk) -> bool:
    """Whether the revision that is served is final."""
    return any(study.id == desk.stored_study.id and study.locked for study in desk.store.studies())


@st.fragment(run_every=_REFRESH_S)
def _figures(desk: Desk) -> None:
    found, seated, now = evidence(desk), seats(desk), desk.clock()
    counts, planned = found.counts, desk.study.protocol.planned_participants
    per_person = (
        len(desk.study.pairs) * desk.study.protocol.repetitions + desk.study.protocol.attention_checks
    )
    key_figures(
        (
            (str(counts.finished), f"of {planned}", "participants finished"),
            (str(sum(seat.is_present(now) for seat in seated)), "", "in a session now"),
            (str(counts.answered), f"of {planned * per_person}", "comparisons answered"),
            (str(counts.trials), "", "trials"),
            (str(counts.stuck), f"of {counts.trials}", "ended stuck"),
        )
    )
    wide, narrow = st.columns([0.69, 0.31], gap="small")
    with card("ranking", wide):
        _ranking(desk, found)
    with card("stuck", narrow):
        _stuck(found)
    with card("quality", narrow):
        _quality(desk)
    with card("participants"):
        heading("In a session now", f"updates every {_REFRESH_S} s")
        _sessions(desk, seated)


def _ranking(desk: Desk, found: Evidence) -> None:
    heading("How the modes rank")
    if not found.questions:
        st.caption(found.why_none)
        return
    st.caption(
        "Quick estimate, pooled over participants: worth with its 94 % interval; dotted: no preference; "
        "right: chance to rank first. The report fits the full model."
        + (" **Includes simulated participants.**" if includes_simulated() else "")
    )
    for first in range(0, len(found.questions), _COLUMNS):
        for column, question in zip(
            st.columns(_COLUMNS), found.questions[first : first + _COLUMNS], strict=False
        ):
            column.markdown(f"**{question.name}**  {question.short}")
            if question.standings:
                column.altair_chart(worth_chart(question), width="stretch")
            else:
                column.caption(question.reason)
    reliability(desk, found)


def _stuck(found: Evidence) -> None:
    heading("Robot stuck, per comparison")
    if not found.stuck:
        st.caption("No trials are stored yet.")
        return
    st.altair_chart(stuck_chart(found.stuck), width="stretch")
    st.caption(
        "Share of comparisons with the mode in which the robot got stuck under it, 94 % interval. "
        + ONLY_THESE
    )


def _sessions(desk: Desk, seated: tuple[Seat, ...]) -> None:
    now = desk.clock()
    present = [seat for seat in seated if seat.is_present(now)]
    if present:
        sessions_table(present, now)
    elif seated:
        st.caption("Nobody at the moment.")
    else:
        st.caption("Nobody has joined yet. Links are on the page Links.")


def _quality(desk: Desk) -> None:
    heading("Data quality")
    try:
        answers = desk.store.responses_table(desk.stored_study, includes_simulated()).rows
    except InputError:
        answers = None
    trials = [row.trial for row in trial_rows(desk)]
    lines = quality(answers, trials, shown_labels(desk))
    if not lines:
        st.caption("There is nothing to judge yet.")
        return
    table(("What", "So far"), [(line.what, line.mark) for line in lines])
