"""The websocket ``/live``: who may come in, and what may be said there.

The guard has checked the Origin before; here the cookie says who it is, and the store what is open. Whatever
our own page would not send closes the socket, and leaves everybody else alone.
"""

import asyncio
import json
import time
from collections import deque
from typing import Literal

from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection
from starlette.types import Receive, Scope, Send

from app.server.access_log import LOG
from app.server.desk import desk
from app.server.live.connection import MOVED, NOBODY, REFUSED, Connection
from app.server.live.limits import Allowance
from app.server.live.session import Session
from app.server.live.wire import BadFrame, unpack_input
from app.server.visitors import visitor
from data.errors import ElbowroomError
from data.records import Slot

PATH = "/live"
LONGEST_TEXT = 1024
"""Of a message [bytes]; ours are a tenth of it."""
FRAMES_PER_S, FRAMES_SAVED = 250.0, 1250.0
"""Input frames: twice as many as our page sends at most, and what five seconds of a bad network hold back."""
TEXTS_PER_S, TEXTS_SAVED = 20.0, 40.0
SOCKETS_PER_S = 3
"""So many sockets a participant may open within a second."""

_GOODBYE_S = 1.0
_TRY_AGAIN = 1013
_COMMANDS: dict[str, frozenset[str]] = {
    "open": frozenset({"type", "slot"}),
    "restart": frozenset({"type"}),
    "finish": frozenset({"type"}),
}


class BadMessage(ValueError):
    """A message that no page of ours would send."""


class LiveRoute:
    """The ASGI endpoint."""

    def __init__(self) -> None:
        self._opened: dict[str, deque[float]] = {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One socket, from its opening to its end."""
        await receive()
        live = desk().live
        if live is None:
            await send({"type": "websocket.close", "code": REFUSED})
            return
        try:
            here = await run_in_threadpool(visitor, desk(), HTTPConnection(scope).cookies)
            await send({"type": "websocket.accept"})
            if here is None or here.participant is None:
                await send({"type": "websocket.close", "code": NOBODY})
                return
            if self._is_flood(here.participant.id):
                LOG.error("live: refused: too many sockets")
                await send({"type": "websocket.close", "code": REFUSED})
                return
            connection = Connection()
            session = await live.enter(here.participant, connection)
        except ElbowroomError as error:
            LOG.error("live: %s", error)
            await send({"type": "websocket.close", "code": _TRY_AGAIN})
            return
        if session is None:
            connection.tell({"type": "moved"})
            connection.close(MOVED)
            await connection.pump(send)
            return
        pump = asyncio.create_task(connection.pump(send))
        try:
            await _listen(receive, connection, session)
            if connection.is_closing:
                await asyncio.wait({pump}, timeout=_GOODBYE_S)
        finally:
            session.detach(connection)
            pump.cancel()
            await asyncio.gather(pump, return_exceptions=True)

    def _is_flood(self, participant_id: str) -> bool:
        now = time.monotonic()
        for name in [name for name, times in self._opened.items() if now - times[-1] > 1.0]:
            del self._opened[name]
        times = self._opened.setdefault(participant_id, deque(maxlen=SOCKETS_PER_S))
        is_flood = len(times) == SOCKETS_PER_S and now - times[0] < 1.0
        if not is_flood:
            times.append(now)
        return is_flood


async def _listen(receive: Receive, connection: Connection, session: Session) -> None:
    """Take what the browser says until it goes, or says what it must not."""
    frames = Allowance(FRAMES_PER_S, FRAMES_SAVED, time.monotonic)
    texts = Allowance(TEXTS_PER_S, TEXTS_SAVED, time.monotonic)
    seq = 0
    try:
        while True:
            message = await receive()
            if message["type"] == "websocket.disconnect":
                return
            if connection.is_closing:
                # Another window has taken over, or everything is over here.
                continue
            content = message.get("bytes")
            if content is not None:
                if not frames.take():
                    raise BadFrame("too many frames")
                said = unpack_input(content)
                if said.seq <= seq:
                    raise BadFrame("number")
                seq = said.seq
                session.take_input(said, content)
            else:
                if not texts.take():
                    raise BadMessage("too many messages")
                _obey(session, message.get("text") or "")
    except (BadFrame, BadMessage) as error:
        LOG.error("live: refused: %s", error)
        connection.close(REFUSED)


def _obey(session: Session, text: str) -> None:
    """Do what a message says."""
    kind, slot = parse_command(text)
    if kind == "open" and slot is not None:
        session.open(slot)
    elif kind == "restart":
        session.restart()
    elif kind == "finish":
        session.finish()


def parse_command(text: str) -> tuple[Literal["open", "restart", "finish"], Slot | None]:
    """What a message says, and the slot that it names.

    Raises
    ------
    BadMessage
        If it is too long, no JSON object, or has other keys or values than ours.
    """
    if len(text) > LONGEST_TEXT or len(text.encode()) > LONGEST_TEXT:
        raise BadMessage("size of a message")
    try:
        said = json.loads(text)
    except (ValueError, RecursionError):
        raise BadMessage("no JSON") from None
    if not isinstance(said, dict) or not isinstance(said.get("type"), str):
        raise BadMessage("no message")
    if said.keys() != _COMMANDS.get(said["type"], frozenset()):
        raise BadMessage("unknown message")
    if said["type"] == "open":
        if said["slot"] == "A":
            return "open", "A"
        if said["slot"] == "B":
            return "open", "B"
        raise BadMessage("slot")
    return ("restart" if said["type"] == "restart" else "finish"), None
