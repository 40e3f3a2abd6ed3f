"""The browser app as one ASGI process."""

from app.server.serving import serve

__all__ = ["serve"]
