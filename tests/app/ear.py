"""Hears everything that a participant's browser receives, and looks for what it must not."""

import struct
from collections.abc import Sequence

from playwright.sync_api import Error, Page, Request, Response, WebSocket

_EVERYTHING = """() => JSON.stringify({
    document: [...document.querySelectorAll('*')].map((e) => e.shadowRoot?.innerHTML ?? '').join('\\n')
      + document.documentElement.outerHTML,
    local: { ...localStorage },
    session: { ...sessionStorage },
    cookie: document.cookie,
    address: location.href,
    history: history.state,
})"""


class Ear:
    """Answers with their headers, socket frames, what stands in the document and in the browser's storage.

    Parameters
    ----------
    secrets : sequence of str
        Words that may not be in it, in any case of letters.
    numbers : sequence of float
        Numbers that may not be in it: neither as text nor as a float of 32 or 64 bits.
    """

    def __init__(self, page: Page, secrets: Sequence[str], numbers: Sequence[float] = ()) -> None:
        self.heard: list[tuple[str, bytes]] = []
        self.errors: list[str] = []
        self._page = page
        self._words = [secret.lower().encode() for secret in secrets]
        self._words += [f"{number:g}".encode() for number in numbers]
        self._floats = [struct.pack(kind, number) for number in numbers for kind in ("<f", "<d")]
        page.on("requestfinished", self._request)
        page.on("websocket", self._socket)
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def secrets_heard(self) -> list[str]:
        """Each secret that was heard, and where."""
        found = set()
        for where, content in self.heard:
            lower = content.lower()
            found.update(f"{word.decode()} in {where}" for word in self._words if word in lower)
            found.update(f"{number.hex()} in {where}" for number in self._floats if number in content)
        return sorted(found)

    def look(self) -> None:
        """Take in the document and the browser's storage as they are now."""
        self.heard.append(("document", self._page.evaluate(_EVERYTHING).encode()))

    def _request(self, request: Request) -> None:
        response: Response | None = request.response()
        # Streamlit's own bundles are the same for every study.
        if response is None or "/static/" in request.url or response.status in (204, 303, 304):
            return
        headers = repr(sorted(response.headers.items())).encode()
        self.heard.append((request.url, request.url.encode() + headers + self._body(request, response)))

    def _body(self, request: Request, response: Response) -> bytes:
        try:
            return response.body()
        except Error:
            # Of a page that was left meanwhile the browser keeps nothing: what can be asked for again is.
            return self._page.request.get(request.url).body() if request.method == "GET" else b""

    def _socket(self, socket: WebSocket) -> None:
        def keep(frame: str | bytes) -> None:
            self.heard.append((socket.url, frame.encode() if isinstance(frame, str) else frame))

        socket.on("framereceived", keep)
