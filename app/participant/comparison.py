"""A comparison: the robot under A and B, and the questions, as often to and fro as wanted."""

import streamlit as st

from app.participant.blinding import questions_data, watch_data
from app.participant.progress import Progress
from app.participant.watching import watched_s
from app.server.desk import Desk
from app.stage.stage import ask, watch

_STEP = "step"
_QUESTIONS = "questions"


def show(desk: Desk, progress: Progress) -> None:
    """The robot page, or the questions if they are asked for and open already.

    Which of the two is in the address, so that a reload stays where it was.
    """
    comparison = progress.comparison
    assert comparison is not None
    wanted = st.query_params.get(_STEP) == f"{_QUESTIONS}-{comparison.position}"
    if wanted and progress.may_answer(desk.study, watched_s(desk.store, comparison)):
        ask(
            questions_data(desk.study, progress, comparison),
            key=f"questions-{comparison.position}",
            on_back=to_robot,
            on_submitted=to_robot,
        )
        return
    watch(
        watch_data(desk.study, desk.store, progress, comparison),
        key=f"watch-{comparison.position}",
        on_answer=lambda: to_questions(comparison.position),
        on_moved=to_robot,
    )


def to_questions(position: int) -> None:
    """Turn to the questions."""
    st.query_params[_STEP] = f"{_QUESTIONS}-{position}"


def to_robot() -> None:
    """Turn to the robot, or to whatever the store says comes now."""
    st.query_params.clear()
