"""What the participant guides the robot with: chosen once, with its controls beside it."""

from collections.abc import Mapping
from html import escape
from typing import get_args

import streamlit as st

from app.participant.progress import Progress
from app.participant.text_page import head, lead_on
from app.participant.texts import texts
from app.server.desk import Desk
from data.records import Device

_DEVICES: tuple[Device, ...] = get_args(Device)
_TOUCHED = ("android", "iphone", "ipad", "mobile")


def show(desk: Desk, progress: Progress) -> None:
    """The choice, and how the chosen device guides; stored with the button."""
    words = texts()["device"]
    head(words["title"], progress)
    st.markdown(words["text"])
    chosen: Device = st.radio(
        words["choose"],
        _DEVICES,
        index=_DEVICES.index(likely_device(st.context.headers)),
        format_func=lambda name: words[name],
        horizontal=True,
        key="device",
    )
    st.markdown(texts()[f"guide.{chosen}"]["line"])
    st.html(controls(chosen))
    st.caption(words["kept"] + (" " + words["practice"] if desk.study.has_practice else ""))

    def keep() -> None:
        desk.store.record_device(progress.participant.id, chosen)
        st.query_params.clear()

    lead_on(words["next"], keep)


def likely_device(headers: Mapping[str, str]) -> Device:
    """What a browser is probably used with, by what it says of itself; a gamepad can't be told."""
    agent = headers.get("User-Agent", "").lower()
    return "touch" if any(name in agent for name in _TOUCHED) else "mouse"


def controls(device: Device) -> str:
    """The controls of a device as an HTML list, in the words that stand beside the wall later."""
    guide, keys = texts()["guide"], texts()[f"guide.{device}"]
    names = {name: guide[f"control_{name}"] for name in ("move", "release", "spray", "tilt", "tilt_up")}
    if keys["key_tilt"] == keys["key_tilt_up"]:
        del names["tilt_up"]
        names["tilt"] = texts()["device"]["tilt"]
    rows = ((label, keys[f"key_{name}"]) for name, label in names.items())
    items = "".join(f"<dt>{escape(label)}</dt><dd>{escape(key)}</dd>" for label, key in rows if key)
    return f'<dl class="controls">{items}</dl>'
