"""The replay as a component in the page; its modules are served under ``/console-modules``."""

from functools import cache
from pathlib import Path

import streamlit as st
from streamlit.components.v2.types import ComponentRenderer

from app.stage import stage

_HERE = Path(__file__).resolve().parent
_STAGE = Path(stage.__file__).resolve().parent
_ENTRY = """
const module = import(new URL('/console-modules/replay.js', window.location.origin).href);
export default async (component) => (await module).default(component);
"""


@cache
def _component() -> ComponentRenderer:
    sheets = (_STAGE / "tokens.css", _STAGE / "shapes.css", _HERE / "replay.css")
    css = "\n".join(sheet.read_text(encoding="utf-8") for sheet in sheets)
    return st.components.v2.component("elbowroom_replay", css=css, js=_ENTRY)


def replay_view(data: dict[str, object], *, key: str) -> None:
    """Show a trial's replay (``replay_page.replay_data``)."""
    _component()(key=f"replay-{key}", data=data)
