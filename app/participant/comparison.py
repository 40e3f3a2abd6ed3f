"""A comparison: the robot under A and B, and the questions, as often to and fro as wanted."""

import streamlit as st

from app.participant.blinding import guide_data, questions_data, watch_data
from app.participant.coming_back import anew_if_back
from app.participant.progress import Progress
from app.participant.watching import watched_s
from app.server.desk import Desk
from app.stage.stage import ask, guide, watch
from data.records import Comparison

_STEP = "step"
_QUESTIONS = "questions"


def show(desk: Desk, progress: Progress) -> None:
    """The robot page, or the questions if they are asked for and open already.

    Which of the two is in the address, so that a reload stays where it was.
    """
    assert progress.comparison is not None
    comparison = anew_if_back(desk.study, desk.store, progress.comparison, desk.clock())
    wanted = st.query_params.get(_STEP) == f"{_QUESTIONS}-{comparison.position}"
    if wanted and progress.may_answer(desk.study, watched_s(desk.store, comparison)):
        ask(
            questions_data(desk.study, progress, comparison),
            key=f"questions-{comparison.position}",
            on_back=to_robot,
            on_submitted=to_robot,
        )
    else:
        _show_robot(desk, progress, comparison)


def _show_robot(desk: Desk, progress: Progress, comparison: Comparison) -> None:
    source = desk.study.protocol.trial_source
    if source == "external":
        from app.participant import external

        external.show(desk, progress)
    elif source == "guided":
        guide(
            guide_data(desk.study, desk.store, progress, comparison),
            key=f"guide-{comparison.position}",
            on_answer=lambda: to_questions(comparison.position),
            on_moved=to_robot,
            on_practised=to_robot,
        )
    else:
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
