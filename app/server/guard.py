"""What every answer and every write must satisfy: security headers, and writes from our own pages alone."""

from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.server.access_log import LOG
from app.server.public_url import PublicUrl

_READS = {"GET", "HEAD", "OPTIONS"}
_POLICY = "; ".join(
    (
        "default-src 'self'",
        # Streamlit imports a component's entry module from a blob; Vega compiles its charts.
        "script-src 'self' blob: 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "connect-src 'self' ws: wss: data: blob:",
        "worker-src 'self' blob:",
        "object-src 'none'",
        "base-uri 'self'",
        "form-action 'self'",
        "frame-ancestors 'none'",
    )
)
_HEADERS = {
    "content-security-policy": _POLICY,
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    # A link's token must not travel on to another site.
    "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}


class Guard:
    """ASGI middleware around everything, Streamlit's own routes included."""

    def __init__(self, app: ASGIApp, public_url: PublicUrl | None = None) -> None:
        self._app = app
        self._public_url = public_url

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse what comes from elsewhere; add the headers to what goes out."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        writes = scope["type"] == "websocket" or scope["method"] not in _READS
        headers = Headers(scope=scope)
        if writes and not is_own_origin(headers, self._public_url):
            self._note(headers)
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": 1008})
            else:
                await PlainTextResponse("forbidden", status_code=403)(scope, receive, send)
            return

        async def send_guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                outgoing = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    outgoing[name] = value
            await send(message)

        await self._app(scope, receive, send_guarded)

    def _note(self, headers: Headers) -> None:
        """Tell whoever runs the server why pages stay empty behind a proxy: a wrong or missing address."""
        origin = headers.get("origin", "")
        if origin:
            own = self._public_url.origin if self._public_url else headers.get("host", "")
            LOG.warning("refused a request from the Origin %.100r, not %.100r: see --public-url", origin, own)


def is_own_origin(headers: Headers, public_url: PublicUrl | None = None) -> bool:
    """Whether a request comes from one of our own pages. No Origin is no proof.

    Ours are the pages at the public address, if there is one, else those of the very host that is asked.
    """
    origin = headers.get("origin", "")
    if public_url is not None:
        return origin == public_url.origin
    try:
        host = urlsplit(origin).netloc
    except ValueError:
        return False
    return host != "" and host == headers.get("host")
