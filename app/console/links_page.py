"""Links: making them for participants, and refusing them again."""

from datetime import timedelta
from urllib.parse import urlsplit

import streamlit as st

from app.console.style import card, heading, headline, table
from app.server.desk import Desk
from app.server.visitors import new_token
from data.store import Link, token_sha256

_KINDS = {"For any number of participants": "participant", "For one participant each": "personal"}
_KIND_NAMES = {"participant": "any number", "personal": "one participant", "researcher": "researcher, once"}


def show(desk: Desk) -> None:
    """New links at the top; they are shown once, since only their hashes are kept."""
    headline("Links")
    with card("new"):
        heading("New links")
        kind = st.radio("For whom", list(_KINDS), horizontal=True)
        label, number, end = st.columns([0.5, 0.2, 0.3])
        name = label.text_input("Label, for you alone", max_chars=80)
        many = number.number_input("How many", 1, 100, 1)
        days = end.number_input("Valid for days, 0 without end", 0, 3650, 0)
        if st.button("Make links", type="primary"):
            tokens = [new_token() for _ in range(int(many))]
            now = desk.clock()
            expires = now + timedelta(days=int(days)) if days else None
            for token in tokens:
                desk.store.create_link(
                    "personal" if _KINDS[kind] == "personal" else "participant",
                    desk.stored_study,
                    token_sha256(token),
                    at=now,
                    expires_at=expires,
                    label=name.strip(),
                )
            detail = {"kind": _KINDS[kind], "links": str(len(tokens)), "days": str(days or "without end")}
            desk.store.log("researcher", "make links", detail, now)
            st.caption("Copy them now: they can't be shown again.")
            st.code("\n".join(f"{_base()}/join/{token}" for token in tokens), language=None)
    with card("given-out"):
        heading("Links given out")
        _given_out(desk)


def _given_out(desk: Desk) -> None:
    links = desk.store.links(desk.stored_study)
    table(
        ("Label", "For", "Made", "Valid until", "First followed", "State"),
        [
            (
                link.label or "without label",
                _KIND_NAMES[link.kind],
                f"{link.created_at:%Y-%m-%d %H:%M}",
                f"{link.expires_at:%Y-%m-%d %H:%M}" if link.expires_at else "without end",
                f"{link.used_at:%Y-%m-%d %H:%M}" if link.used_at else "not yet",
                _state(desk, link),
            )
            for link in reversed(links)
        ],
    )
    valid = {
        f"{link.label or 'without label'}, {link.created_at:%Y-%m-%d %H:%M:%S}": link
        for link in links
        if link.kind != "researcher" and _state(desk, link) == "valid"
    }
    if valid:
        chosen = st.selectbox(
            "Refuse a link from now on", list(valid), index=None, placeholder="Choose a link"
        )
        if st.button("Refuse it", disabled=chosen is None) and chosen is not None:
            desk.store.revoke_link(valid[chosen].token_sha256)
            desk.store.log("researcher", "refuse link", {"label": valid[chosen].label})
            st.rerun()


def _state(desk: Desk, link: Link) -> str:
    if link.expires_at is not None and desk.clock() >= link.expires_at:
        return "over"
    return "used up" if link.kind == "researcher" and link.used_at else "valid"


def _base() -> str:
    parts = urlsplit(st.context.url or "")
    return f"{parts.scheme}://{parts.netloc}"
