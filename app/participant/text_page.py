"""What the participant's pages of text share: a column, how far one has come, the button that leads on."""

from collections.abc import Callable
from functools import cache
from html import escape
from pathlib import Path

import streamlit as st

from app.participant.progress import Progress
from app.participant.texts import filled, texts
from app.participant.trouble import attempt
from app.stage.stage import text_page


def head(title: str, progress: Progress | None = None) -> None:
    """The top of a page: the comparisons as short strokes, those that are answered filled, and the title."""
    text_page()
    st.html(f"<style>{_styles()}</style>")
    if progress is not None and len(progress.comparisons) > 1:
        st.html(way(progress.answered, len(progress.comparisons)))
    st.title(title, anchor=False)


def way(done: int, of: int) -> str:
    """The strokes as HTML."""
    words = filled(texts()["page"], done=done, of=of)
    strokes = '<i class="done"></i>' * done + "<i></i>" * (of - done)
    return f'<div class="way" role="img" aria-label="{escape(words["steps"])}">{strokes}</div>'


def lead_on(label: str, act: Callable[[], object]) -> None:
    """The button that leads on.

    It acts in a callback: a click is not lost if the script is interrupted on its way to the button.
    """
    st.button(label, type="primary", on_click=attempt, args=(act,))


@cache
def _styles() -> str:
    return Path(__file__).with_name("text_page.css").read_text(encoding="utf-8")
