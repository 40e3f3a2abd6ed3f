"""What the console reads of the store, under the labels that are shown now."""

from dataclasses import dataclass

import streamlit as st

from app.console.findings import (
    QuestionAtAGlance,
    StuckAtAGlance,
    firsts_at_a_glance,
    ranking_at_a_glance,
    stuck_at_a_glance,
)
from app.console.labels import shown_labels
from app.looking import console_sentence
from app.server.desk import Desk
from data.errors import InputError
from data.records import Look
from data.store import Counts

_SIMULATED = "include-simulated"
_SWITCH = "include-simulated-switch"


@dataclass(frozen=True)
class Evidence:
    """The study's data at a glance; ``why_none`` says why there is no ranking.

    Whoever sees it has had the ``look`` at the answers of people, where there are any.
    """

    counts: Counts
    questions: tuple[QuestionAtAGlance, ...]
    stuck: tuple[StuckAtAGlance, ...]
    why_none: str
    look: Look


def includes_simulated() -> bool:
    """Whether the researcher asked for simulated participants too."""
    return bool(st.session_state.get(_SIMULATED, False))


def simulated_switch(desk: Desk) -> None:
    """A switch for simulated participants, where there are any; it holds for all pages."""
    if desk.store.participants(desk.stored_study, source="simulated"):
        # Streamlit forgets a widget's state on another page, so the choice is kept beside it.
        st.session_state[_SWITCH] = includes_simulated()
        st.toggle("Include simulated participants", key=_SWITCH, on_change=_take_choice)


def _take_choice() -> None:
    st.session_state[_SIMULATED] = st.session_state[_SWITCH]


def evidence(desk: Desk) -> Evidence:
    """Everything the charts need."""
    simulated = includes_simulated()
    labels = shown_labels(desk)
    counts = desk.store.counts(desk.stored_study, simulated)
    questions: tuple[QuestionAtAGlance, ...] = ()
    why_none, look = "", Look(0, 0)
    try:
        answers = desk.store.responses_table(desk.stored_study, simulated)
        questions, look = ranking_at_a_glance(answers, labels), answers.look
    except InputError:
        why_none = "There are no answers of people yet."
    stuck: tuple[StuckAtAGlance, ...] = ()
    try:
        table = desk.store.stuck_table(desk.stored_study, simulated)
        stuck = stuck_at_a_glance(table, labels) if table is not None else ()
    except InputError:
        pass
    return Evidence(counts, questions, stuck, why_none, look)


def reliability(desk: Desk, found: Evidence) -> None:
    """What several likely firsts are worth together, and what looking early does; this look is kept."""
    if any(question.standings for question in found.questions):
        looks = console_sentence(desk.store, desk.stored_study, found.look, desk.clock())
        if said := " ".join(filter(None, (firsts_at_a_glance(found.questions), looks))):
            st.caption(said)
