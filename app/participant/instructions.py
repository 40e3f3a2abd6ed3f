"""What there will be to do or to see, with a picture; for those who guide, then what they guide with."""

import streamlit as st

from app.participant import device
from app.participant.blinding import picture_data
from app.participant.coming_back import note_begun
from app.participant.progress import Progress
from app.participant.text_page import head, lead_on
from app.participant.texts import filled, texts
from app.server.desk import Desk
from app.stage.stage import picture

_STEP = "step"
_DEVICE = "device"


def show(desk: Desk, progress: Progress) -> None:
    """The instructions, before anything moves; which of their two screens is in the address."""
    is_guided = desk.study.protocol.trial_source == "guided"
    if is_guided and st.query_params.get(_STEP) == _DEVICE:
        device.show(desk, progress)
        return
    source = desk.study.protocol.trial_source
    words = filled(texts()[f"instructions.{source}"], questions=questions_in_words(len(desk.study.questions)))
    head(words["title"], progress)
    st.markdown(words["before"])
    if source != "external":
        picture(picture_data(desk.study))
    if is_guided:
        st.markdown(words["after"])
        lead_on(texts()["instructions"]["next"], _to_device)
        return
    st.markdown(words["after"] + " " + comparisons_in_words(len(progress.comparisons)))
    lead_on_to_next(desk, progress, texts()["instructions"]["next"])


def lead_on_to_next(desk: Desk, progress: Progress, label: str) -> None:
    """The button that starts the next comparison; laps to watch are run while the participant reads."""
    coming = progress.next
    if coming is None:
        return

    def begin() -> None:
        note_begun(desk.store.start_comparison(coming.id, desk.clock()))
        st.query_params.clear()

    lead_on(label, begin)
    if desk.study.protocol.trial_source == "observed":
        desk.laps.prepare(progress.lap_keys(desk.study, coming))


def questions_in_words(count: int) -> str:
    """How many questions follow each comparison, to be put into a sentence."""
    words = texts()["instructions.questions"]
    return words["one"] if count == 1 else filled(words, questions=count)["more"]


def comparisons_in_words(count: int) -> str:
    """How many comparisons there are, as a sentence."""
    words = texts()["instructions"]
    return words["comparisons_one"] if count == 1 else filled(words, comparisons=count)["comparisons"]


def _to_device() -> None:
    st.query_params[_STEP] = _DEVICE
