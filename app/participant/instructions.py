"""What there will be to see, with a picture; and the short page between two comparisons."""

import streamlit as st

from app.participant.blinding import picture_data
from app.participant.progress import Progress
from app.participant.texts import filled, texts
from app.server.desk import Desk
from app.stage.stage import picture


def show(desk: Desk, progress: Progress) -> None:
    """The instructions, before the first comparison."""
    of = len(progress.comparisons)
    words = filled(texts()["instructions"], comparisons=of, questions=len(desk.study.questions))
    st.title(words["title"], anchor=False)
    st.markdown(words["watch"])
    picture(picture_data(desk.study))
    st.markdown(words["look"])
    st.markdown(words["stuck"] + " " + words["comparisons_one" if of == 1 else "comparisons"])
    st.button(words["next"], type="primary", on_click=begin_next, args=(desk, progress))
    prepare_next(desk, progress)


def show_between(desk: Desk, progress: Progress) -> None:
    """A rest after a comparison: the answers are stored, the next A and B are new."""
    done, of = progress.answered, len(progress.comparisons)
    words = filled(texts()["between"], done=done, of=of, next=done + 1)
    st.title(words["title"], anchor=False)
    st.markdown(words["text"])
    st.subheader(words["next_title"], anchor=False)
    st.markdown(words["next_text"])
    st.button(words["next"], type="primary", on_click=begin_next, args=(desk, progress))
    prepare_next(desk, progress)


def begin_next(desk: Desk, progress: Progress) -> None:
    """Start the next comparison."""
    if progress.next is not None:
        desk.store.start_comparison(progress.next.id, desk.clock())


def prepare_next(desk: Desk, progress: Progress) -> None:
    """Run the laps of the next comparison while the participant reads."""
    if progress.next is not None:
        desk.laps.prepare(progress.lap_keys(desk.study, progress.next))
