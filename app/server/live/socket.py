"""uvicorn's websocket, tuned for states that must not be late."""

import socket

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.http11 import Request

from app.server.live.route import PATH
from data.private_parts import require

_MOST_WAITING = 4096
"""What may wait for a slow receiver [bytes], in our buffer and in the system's: some 50 states, not 30 s of
them. A sender that is told early can send a newer state instead."""


require("uvicorn", WebSocketsSansIOProtocol, "handle_connect")


class LiveSocket(WebSocketsSansIOProtocol):
    """As uvicorn's; for the live route without compression and with small buffers."""

    def handle_connect(self, event: Request) -> None:
        """Answer the request that opens a websocket."""
        if event.path.partition("?")[0] == PATH:
            # Frames of 40 and 80 bytes: compressing costs more than it saves.
            if "Sec-WebSocket-Extensions" in event.headers:
                del event.headers["Sec-WebSocket-Extensions"]
            self.transport.set_write_buffer_limits(high=_MOST_WAITING)
            tcp = self.transport.get_extra_info("socket")
            if tcp is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):
                tcp.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, _MOST_WAITING)
        super().handle_connect(event)
