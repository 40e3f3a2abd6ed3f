"""Who a browser belongs to: cookies, links, and what the store knows of them.

A participant's cookie is ``<link token>.<nonce>``: the link it came from, and this browser's own secret.
Nothing is stored until the participant agrees to take part, so a link that is only looked at, by a person
or by a mail program's preview, makes no participant. The store keeps hashes of tokens and cookies alone.
"""

import secrets
from collections.abc import Mapping
from dataclasses import dataclass

from starlette.responses import Response

from app.server.desk import Desk
from data.records import Comparison, Participant
from data.schedule import plan_session
from data.store import Link, token_sha256

PARTICIPANT_COOKIE = "elbowroom_participant"
RESEARCHER_COOKIE = "elbowroom_researcher"
_NONCE_BYTES = 16
_TOKEN_BYTES = 24


@dataclass(frozen=True)
class Visitor:
    """Someone with a participant's cookie; ``participant`` is None before consent."""

    cookie: str
    participant: Participant | None


def new_token() -> str:
    """A secret that nobody can guess, in characters that a URL takes as they are."""
    return secrets.token_urlsafe(_TOKEN_BYTES)


def participant_link(desk: Desk, token: str) -> Link | None:
    """The link of a token that participants of this study may follow now, or None."""
    hashed = token_sha256(token)
    for link in desk.store.links(desk.stored_study):
        if link.token_sha256 == hashed and link.kind != "researcher":
            is_over = link.expires_at is not None and desk.clock() >= link.expires_at
            return None if is_over else link
    return None


def new_participant_cookie(desk: Desk, token: str) -> str | None:
    """A cookie for a browser that follows a link; None if the link isn't valid.

    A personal link that was followed before leads back to its participant, in any browser.
    """
    link = participant_link(desk, token)
    if link is None:
        return None
    cookie = f"{token}.{secrets.token_urlsafe(_NONCE_BYTES)}"
    if link.participant is not None:
        desk.store.open_session(token_sha256(cookie), desk.stored_study, link.participant, desk.clock())
    return cookie


def visitor(desk: Desk, cookies: Mapping[str, str]) -> Visitor | None:
    """Whose browser sent these cookies; None if it followed no valid link."""
    cookie = cookies.get(PARTICIPANT_COOKIE, "")
    session = desk.store.session(token_sha256(cookie)) if cookie else None
    if session is not None and session.study.id == desk.stored_study.id and session.participant is not None:
        return Visitor(cookie, desk.store.participant(session.participant))
    token, _, nonce = cookie.partition(".")
    if not nonce:
        return None
    withdrawn = _withdrawn(desk, cookie)
    if withdrawn is None and participant_link(desk, token) is None:
        return None
    return Visitor(cookie, withdrawn)


def admit(desk: Desk, cookie: str) -> Participant:
    """Make a visitor who agrees a participant: number, consent, schedule and session in one transaction."""
    token = cookie.partition(".")[0]
    now = desk.clock()
    with desk.store.transaction():
        joined = desk.store.redeem_participant_link(token_sha256(token), _participant_id(desk, cookie), now)
        consented = desk.store.record_consent(joined.id, desk.study.consent.version, now)
        desk.store.add_comparisons(
            Comparison(
                id=f"{joined.id}.c{planned.position}",
                participant=joined.id,
                position=planned.position,
                repetition=planned.repetition,
                mode_a=planned.mode_a,
                mode_b=planned.mode_b,
                check=planned.check,
            )
            for planned in plan_session(desk.study, joined.number)
        )
        desk.store.open_session(token_sha256(cookie), desk.stored_study, joined.id, now)
    return consented


def _participant_id(desk: Desk, cookie: str) -> str:
    """The id of who agrees to take part with this cookie."""
    return f"{desk.stored_study.sha256[:6]}-{token_sha256(cookie)[:10]}"


def _withdrawn(desk: Desk, cookie: str) -> Participant | None:
    """Who agreed with this cookie and was withdrawn: that ends the session, and must not begin another.

    With a personal link it is whoever the link is of, in any browser that followed it.
    """
    hashed = token_sha256(cookie.partition(".")[0])
    theirs = {link.participant for link in desk.store.links(desk.stored_study) if link.token_sha256 == hashed}
    theirs.add(_participant_id(desk, cookie))
    everyone = desk.store.participants(desk.stored_study, source="human")
    return next((one for one in everyone if one.id in theirs and one.withdrawn_at is not None), None)


def new_researcher_cookie(desk: Desk, token: str) -> str:
    """Use up a one-time link; the cookie opens the console from then on.

    Raises
    ------
    data.store.LinkRefused
        If the link is unknown, expired or was used before.
    """
    cookie = new_token()
    with desk.store.transaction():
        study = desk.store.redeem_researcher_link(token_sha256(token), desk.clock())
        desk.store.open_session(token_sha256(cookie), study, None, desk.clock())
        desk.store.log("researcher", "open console", {"study": study.label}, desk.clock())
    return cookie


def give_cookie(response: Response, desk: Desk, name: str, value: str, days: int) -> None:
    """Have the browser keep a cookie that no script reads; over TLS alone where browsers come by TLS."""
    is_secure = desk.public_url is not None and desk.public_url.is_secure
    # Lax, not strict: a strict cookie would not come along after a click on a link in a mail.
    response.set_cookie(
        name, value, max_age=days * 86_400, path="/", secure=is_secure, httponly=True, samesite="lax"
    )


def is_researcher(desk: Desk, cookies: Mapping[str, str]) -> bool:
    """Whether the browser followed a researcher's link of this study."""
    cookie = cookies.get(RESEARCHER_COOKIE, "")
    session = desk.store.session(token_sha256(cookie)) if cookie else None
    return session is not None and session.participant is None and session.study.id == desk.stored_study.id
