"""What there will be to see, with a picture; and the short page between two comparisons."""

import streamlit as st

from app.participant.blinding import picture_data
from app.participant.progress import Progress
from app.participant.texts import filled, texts
from app.participant.trouble import attempt
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
    _lead_on(desk, progress, words["next"])


def show_between(desk: Desk, progress: Progress) -> None:
    """A rest after a comparison: the answers are stored, the next A and B are new."""
    done, of = progress.answered, len(progress.comparisons)
    words = filled(texts()["between"], done=done, of=of, next=done + 1)
    st.title(words["title"], anchor=False)
    st.markdown(words["text"])
    st.subheader(words["next_title"], anchor=False)
    st.markdown(words["next_text"])
    _lead_on(desk, progress, words["next"])


def _lead_on(desk: Desk, progress: Progress, label: str) -> None:
    """The button that starts the next comparison; its laps are run while the participant reads."""
    coming = progress.next
    if coming is None:
        return

    def begin() -> None:
        desk.store.start_comparison(coming.id, desk.clock())

    # A callback: a click is not lost if the script is interrupted on its way to the button.
    st.button(label, type="primary", on_click=attempt, args=(begin,))
    desk.laps.prepare(progress.lap_keys(desk.study, coming))
