"""The browser component in Streamlit: the robot page, the questions, and the picture of the instructions.

The modules are served under ``/stage`` as they are, without a build step; a component's entry is a line
that imports one of them. Styles go into the component's shadow root.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import streamlit as st
from streamlit.components.v2.types import ComponentRenderer

Data = dict[str, object]
Callback = Callable[[], None]

_HERE = Path(__file__).resolve().parent
_ENTRY = """
const module = import(new URL('/stage/%s.js', window.location.origin).href);
export default async (component) => (await module).default(component);
"""


@cache
def _component(name: str, *styles: str) -> ComponentRenderer:
    css = "\n".join(
        (_HERE / f"{style}.css").read_text(encoding="utf-8") for style in ("tokens", "shapes", *styles)
    )
    return st.components.v2.component(f"elbowroom_{name}", css=css, js=_ENTRY % name)


def watch(data: Data, *, key: str, on_answer: Callback, on_moved: Callback) -> None:
    """The robot page; calls back when the questions are wanted, or when another comparison is open by now."""
    _component("watch", "stage", "watch")(
        key=key, data=data, on_answer_change=on_answer, on_moved_change=on_moved
    )


def guide(data: Data, *, key: str, on_answer: Callback, on_moved: Callback, on_practised: Callback) -> None:
    """The page where the robot is guided, for a comparison or for practice.

    Calls back when the questions are wanted, when something else is open by now, and when practice is done.
    """
    _component("guide", "stage", "guide")(
        key=key,
        data=data,
        on_answer_change=on_answer,
        on_moved_change=on_moved,
        on_practised_change=on_practised,
    )


def ask(data: Data, *, key: str, on_back: Callback, on_submitted: Callback) -> None:
    """The questions; calls back to go back to the robot, and when the answers are stored."""
    _component("questions", "questions")(
        key=key, data=data, on_back_change=on_back, on_submitted_change=on_submitted
    )


def lab(data: Data, *, key: str, on_turned: Callable[[object], None], on_answer: Callback) -> None:
    """The page beside a robot in the lab; calls back with the method turned to, or for the questions."""

    def turned() -> None:
        on_turned(st.session_state[key].get("turned"))

    _component("lab", "lab")(key=key, data=data, on_turned_change=turned, on_answer_change=on_answer)


def picture(data: Data) -> None:
    """The picture of the instructions."""
    _component("picture", "stage", "picture")(key="picture", data=data)


def bare_page() -> None:
    """The whole window for one component: no header, no padding."""
    _style("page", "bare")


def text_page() -> None:
    """A column for reading."""
    _style("page", "text")


def _style(*names: str) -> None:
    st.html(f"<style>{_sheets(*names)}</style>")


def _sheets(*names: str) -> str:
    return "\n".join((_HERE / f"{name}.css").read_text(encoding="utf-8") for name in names)
