"""The console's other door: a passphrase that the person who starts the server chose.

The page is plain HTML, without a script, and its one form is answered with the same cookie as a one-time
link. Guessing is slow: a wrong passphrase is answered late, and after a few of them not at all for a while.
"""

import asyncio
import hashlib
import hmac
import secrets
from collections import deque
from collections.abc import Mapping
from html import escape
from pathlib import Path
from urllib.parse import parse_qs

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import Route

from app.server.access_log import LOG
from app.server.desk import Desk, desk
from app.server.visitors import RESEARCHER_COOKIE, give_cookie, new_token
from data.errors import InputError
from data.records import Clock
from data.store import token_sha256

VARIABLE = "ELBOWROOM_PASSPHRASE"
SHORTEST = 12
"""Characters that a passphrase has at least."""
WRONG_AFTER_S = 1.0
MOST_TRIES = 5
"""Wrong passphrases from one address, and four times as many from all, within `FORGOTTEN_AFTER_S`."""
FORGOTTEN_AFTER_S = 60.0
_EVERYWHERE = 4
_COOKIE_DAYS = 7
_LONGEST_BODY = 4096

_PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Elbowroom console</title>
<meta name="viewport" content="width=device-width"><meta name="color-scheme" content="light dark">
<style>
:root {{ --page: #FAFAF8; --ink: #1D2930; --line: #B9C1C2; --surface: #FFFFFF; --primary: #22404E;
  --on-primary: #FFFFFF; --bad: #B3261E; }}
@media (prefers-color-scheme: dark) {{ :root {{ --page: #12181C; --ink: #E8EDEF; --line: #4C5A63;
  --surface: #1A2228; --primary: #D5E3E9; --on-primary: #12181C; --bad: #FF8A80; }} }}
body {{ margin: 16vh auto; max-width: 24em; padding: 0 24px; background: var(--page); color: var(--ink);
  font: 16px/24px -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }}
h1 {{ font-size: 24px; line-height: 32px; font-weight: 600; margin: 0 0 16px; }}
label {{ display: block; font-size: 14px; line-height: 20px; margin-bottom: 6px; }}
input, button {{ font: inherit; box-sizing: border-box; width: 100%; height: 44px; border-radius: 8px; }}
input {{ padding: 0 12px; border: 1px solid var(--line); background: var(--surface); color: inherit; }}
button {{ margin-top: 12px; border: 0; background: var(--primary); color: var(--on-primary);
  cursor: pointer; }}
:is(input, button):focus-visible {{ outline: 3px solid var(--ink); outline-offset: 2px; }}
p {{ margin: 12px 0 0; font-size: 14px; line-height: 20px; }} .wrong {{ color: var(--bad); }}
</style>
<main><h1>Elbowroom console</h1>{content}</main></html>"""
_FORM = """<form method="post" action="/researcher"><label for="passphrase">Passphrase</label>
<input id="passphrase" name="passphrase" type="password" autocomplete="current-password" required autofocus>
<button type="submit">Open the console</button></form>{said}"""
_CLOSED = "<p>This server was started without a passphrase. Its one-time link opens the console.</p>"


class Passphrase:
    """What is asked for at the door, and who tried lately. Only a salted hash is kept."""

    def __init__(self, text: str, clock: Clock) -> None:
        self._salt = secrets.token_bytes(16)
        self._hash = self._hashed(text)
        self._clock = clock
        self._wrong: deque[tuple[float, str]] = deque()

    def is_locked_for(self, address: str) -> bool:
        """Whether there were too many wrong tries in the last minute to look at another."""
        earliest = self._now() - FORGOTTEN_AFTER_S
        while self._wrong and self._wrong[0][0] < earliest:
            self._wrong.popleft()
        mine = sum(who == address for _, who in self._wrong)
        return mine >= MOST_TRIES or len(self._wrong) >= _EVERYWHERE * MOST_TRIES

    def opens(self, text: str, address: str) -> bool:
        """Whether this is the passphrase; the time it takes doesn't tell how much of it is right."""
        is_right = hmac.compare_digest(self._hashed(text), self._hash)
        if not is_right:
            self._wrong.append((self._now(), address))
        return is_right

    def _now(self) -> float:
        return self._clock().timestamp()

    def _hashed(self, text: str) -> bytes:
        # One round is enough: the hash lives in this process's memory alone and is never written down.
        return hashlib.sha256(self._salt + text.encode()).digest()


_door: list[Passphrase] = []


def set_passphrase(text: str | None, clock: Clock) -> None:
    """Open the door of this process to a passphrase; None keeps it closed."""
    _door[:] = [Passphrase(text, clock)] if text is not None else []


def has_passphrase() -> bool:
    """Whether a passphrase opens the console."""
    return bool(_door)


def read_passphrase(file: Path | None, environment: Mapping[str, str]) -> str | None:
    """The passphrase from a file, or else from the variable ``ELBOWROOM_PASSPHRASE``; None if there is none.

    Raises
    ------
    InputError
        If the file can't be read, or the passphrase is too short.
    """
    if file is None:
        where, text = VARIABLE, environment.get(VARIABLE)
        if text is None:
            return None
    else:
        where = f"--passphrase-file: {file}"
        try:
            text = file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            why = (error.strerror or "").lower() if isinstance(error, OSError) else "not UTF-8 text"
            raise InputError(f"{where}: cannot be read: {why}") from None
    text = text.strip()
    if len(text) < SHORTEST:
        raise InputError(f"{where}: a passphrase has at least {SHORTEST} characters, not {len(text)}")
    return text


async def show_door(request: Request) -> Response:
    """The form."""
    del request
    return _page(_FORM.format(said="") if _door else _CLOSED)


async def knock(request: Request) -> Response:
    """Take a passphrase, and give the console's cookie for the right one."""
    if not _door:
        return _page(_CLOSED, 403)
    door, address = _door[0], request.client.host if request.client else ""
    if door.is_locked_for(address):
        return _refusal("Too many wrong passphrases. Please wait a minute.", 429)
    given = await _given(request)
    if given is None or not door.opens(given, address):
        LOG.warning("wrong passphrase for the console from %s", address)
        await run_in_threadpool(_log_wrong, desk())
        await asyncio.sleep(WRONG_AFTER_S)
        return _refusal("This is not the passphrase.", 403)
    cookie = await run_in_threadpool(_admit, desk())
    answer = RedirectResponse("/overview", status_code=303, headers={"cache-control": "no-store"})
    give_cookie(answer, desk(), RESEARCHER_COOKIE, cookie, _COOKIE_DAYS)
    return answer


async def _given(request: Request) -> str | None:
    """The form's passphrase; None if what was sent isn't the form."""
    if not request.headers.get("content-type", "").startswith("application/x-www-form-urlencoded"):
        return None
    content = b""
    async for part in request.stream():
        content += part
        if len(content) > _LONGEST_BODY:
            return None
    try:
        fields = parse_qs(content.decode("ascii"), max_num_fields=4, errors="strict")
    except ValueError:
        return None
    return fields.get("passphrase", [""])[0].strip()


def _admit(at: Desk) -> str:
    cookie = new_token()
    with at.store.transaction():
        at.store.open_session(token_sha256(cookie), at.stored_study, None, at.clock())
        detail = {"study": at.stored_study.label, "by": "passphrase"}
        at.store.log("researcher", "open console", detail, at.clock())
    return cookie


def _log_wrong(at: Desk) -> None:
    at.store.log("nobody", "wrong passphrase", {"study": at.stored_study.label}, at.clock())


def _refusal(words: str, status: int) -> Response:
    return _page(_FORM.format(said=f'<p class="wrong" role="alert">{escape(words)}</p>'), status)


def _page(content: str, status: int = 200) -> Response:
    return HTMLResponse(_PAGE.format(content=content), status, headers={"cache-control": "no-store"})


ROUTES = (
    Route("/researcher", show_door, methods=["GET"]),
    Route("/researcher", knock, methods=["POST"]),
)
