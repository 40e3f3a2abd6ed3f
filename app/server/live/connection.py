"""One browser's websocket, as a session sends to it: what must arrive in order, and the newest state.

A receiver that is slow gets fewer states, never older ones, and its strokes in larger pieces: nothing that
grows without bound is kept for it.
"""

import asyncio
import json
from collections import deque
from collections.abc import Mapping

from starlette.types import Send

from app.server.live import wire

ELSEWHERE, MOVED, NOBODY, REFUSED = 4001, 4002, 4003, 1008
"""Codes with which the server closes: a newer window took over, no comparison is open here, no participant,
not what our page would send."""
_MOST_MESSAGES = 200


class Strokes:
    """All points painted in one trial, so that they can be sent once more (``wire.POINT``)."""

    def __init__(self, trial: int) -> None:
        self.trial = trial
        self._points = bytearray()

    def __len__(self) -> int:
        return len(self._points) // wire.POINT.size

    def add(self, points: bytes) -> None:
        """Append points."""
        self._points += points

    def frame(self, first: int) -> bytes:
        """The frame with the points from an index on, as many as fit."""
        start = first * wire.POINT.size
        points = bytes(self._points[start : start + wire.MOST_POINTS * wire.POINT.size])
        return wire.pack_strokes(self.trial, first, points)


class Connection:
    """What waits to be sent to one browser."""

    def __init__(self) -> None:
        self._messages: deque[str | bytes] = deque()
        self._state: bytes | None = None
        self._strokes: Strokes | None = None
        self._sent_points = 0
        self._code: int | None = None
        self._has_news = asyncio.Event()

    @property
    def is_closing(self) -> bool:
        """Whether nothing more will be sent but the end."""
        return self._code is not None

    def tell(self, message: Mapping[str, object]) -> None:
        """Send a message; all messages arrive, in order."""
        self._put(json.dumps(message, separators=(",", ":")))

    def follow(self, strokes: Strokes) -> None:
        """Send these strokes from now on, from the first point on; states of another trial are dropped."""
        self._strokes, self._sent_points, self._state = strokes, 0, None

    def show(self, state: bytes) -> None:
        """Send a state, unless a newer one comes before its turn."""
        self._state = state
        self._has_news.set()

    def paint(self) -> None:
        """Send what is new of the strokes."""
        self._has_news.set()

    def flush(self) -> None:
        """Put strokes and state among the messages: what is told next comes after them."""
        strokes = self._strokes
        while strokes is not None and self._sent_points < len(strokes):
            self._put(self._next_points(strokes))
        if self._state is not None:
            self._put(self._state)
            self._state = None

    def close(self, code: int) -> None:
        """Close once the messages are sent."""
        if self._code is None:
            self._code = code
            self._has_news.set()

    async def pump(self, send: Send) -> None:
        """Send until the connection is to be closed, and close it."""
        while True:
            await self._has_news.wait()
            self._has_news.clear()
            while self._messages:
                await _send(send, self._messages.popleft())
            if self._code is not None:
                await send({"type": "websocket.close", "code": self._code})
                return
            strokes = self._strokes
            if strokes is not None and self._sent_points < len(strokes):
                await _send(send, self._next_points(strokes))
                if self._sent_points < len(strokes):
                    self._has_news.set()
            state, self._state = self._state, None
            # A message that came meanwhile may begin another trial, which has no state yet.
            if state is not None and not self._messages:
                await _send(send, state)

    def _next_points(self, strokes: Strokes) -> bytes:
        frame = strokes.frame(self._sent_points)
        self._sent_points += (len(frame) - wire.STROKES.size) // wire.POINT.size
        return frame

    def _put(self, message: str | bytes) -> None:
        if len(self._messages) >= _MOST_MESSAGES:
            # It asks and doesn't listen.
            self._messages.clear()
            self.close(REFUSED)
        if self._code is None:
            self._messages.append(message)
            self._has_news.set()


async def _send(send: Send, message: str | bytes) -> None:
    kind = "text" if isinstance(message, str) else "bytes"
    await send({"type": "websocket.send", kind: message})
