"""Overview: how far the study has come, how the modes stand under their labels, who is where."""

from collections import Counter

import streamlit as st

from app.console.charts import stuck_chart, worth_chart
from app.console.evidence import Evidence, evidence, includes_simulated, simulated_switch
from app.console.style import card, headline, key_figures, table
from app.console.unblinding import unblind_button
from app.participant.progress import Progress
from app.server.desk import Desk
from data.records import Comparison

_REFRESH_S = 10
_COLUMNS = 3
_PLACES = {
    "instructions": "reading",
    "comparison": "watching and answering",
    "between": "between comparisons",
    "thanks": "finished",
}


def show(desk: Desk) -> None:
    """The page; its figures are read anew every few seconds."""
    stored = desk.stored_study
    lock = "locked: people have taken part" if _is_locked(desk) else "not locked: nobody has taken part"
    headline(desk.study.title, (f"{stored.label}", f"{lock}", stored.sha256[:8]))
    unblind_button(desk)
    simulated_switch(desk)
    _figures(desk)


def _is_locked(desk: Desk) -> bool:
    return any(study.id == desk.stored_study.id and study.locked for study in desk.store.studies())


@st.fragment(run_every=_REFRESH_S)
def _figures(desk: Desk) -> None:
    found = evidence(desk)
    counts, planned = found.counts, desk.study.protocol.planned_participants
    per_person = (
        len(desk.study.pairs) * desk.study.protocol.repetitions + desk.study.protocol.attention_checks
    )
    key_figures(
        (
            (str(counts.finished), f"of {planned}", "participants finished"),
            (str(counts.consented - counts.finished), "", "started and not finished"),
            (str(counts.answered), f"of {planned * per_person}", "comparisons answered"),
            (str(counts.trials), "", "laps watched or begun"),
            (str(counts.stuck), "", "of them ended stuck"),
        )
    )
    wide, narrow = st.columns([0.69, 0.31], gap="small")
    with card("ranking", wide):
        _ranking(found)
    with card("stuck", narrow):
        _stuck(found)
    with card("participants"):
        st.subheader("Participants", anchor=False)
        _participants(desk)


def _ranking(found: Evidence) -> None:
    st.subheader("How the modes rank", anchor=False)
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


def _stuck(found: Evidence) -> None:
    st.subheader("Robot stuck, per comparison", anchor=False)
    if not found.stuck:
        st.caption("No laps were watched yet.")
        return
    st.altair_chart(stuck_chart(found.stuck), width="stretch")
    st.caption("Share of comparisons with the mode in which the robot got stuck under it, 94 % interval.")


def _participants(desk: Desk) -> None:
    people = desk.store.participants(desk.stored_study, source="human")
    if not people:
        st.caption("Nobody has joined yet. Links are on the page Links.")
        return
    planned: dict[str, list[Comparison]] = {}
    for comparison in desk.store.comparisons(desk.stored_study):
        planned.setdefault(comparison.participant, []).append(comparison)
    stuck = Counter(
        trial.comparison.rpartition(".")[0]
        for trial in desk.store.trials(desk.stored_study)
        if trial.outcome == "stuck"
    )
    rows = []
    for person in people:
        progress = Progress(person, tuple(planned.get(person.id, ())))
        rows.append(
            (
                f"P{person.number}",
                _PLACES[progress.place],
                f"{progress.answered} of {len(progress.comparisons)}",
                str(stuck[person.id]),
                person.joined_at.strftime("%Y-%m-%d %H:%M UTC"),
            )
        )
    table(("Participant", "Where", "Answered", "Stuck", "Joined"), rows, numbers=(2, 3))
