"""What the server writes about requests: to stderr, without Streamlit's own traffic and without tokens."""

import asyncio
import logging
import re
from typing import Any

LOG = logging.getLogger("elbowroom")
"""For what the person who runs the server should know: a full disk, a busy store."""

_TOKEN = re.compile(r"/(join|researcher)/[^\s/?]+")
_STREAMLIT = ("/_stcore", "/static/", "/stage/", "/console-modules/", "/media/", "/favicon")


def masked(path: str) -> str:
    """A path without the token of a link."""
    return _TOKEN.sub(r"/\1/***", path)


class Discretion(logging.Filter):
    """Masks links in uvicorn's access records; drops the pages' moving parts, and what a stop breaks off."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep a record only if it tells something."""
        if record.exc_info and isinstance(record.exc_info[1], asyncio.CancelledError):
            # A request that was not over long after the server was told to stop: no fault of anything.
            return False
        if isinstance(record.args, tuple) and len(record.args) == 5:
            client, method, path, version, status = record.args
            if str(path).startswith(_STREAMLIT):
                return False
            record.args = (client, method, masked(str(path)), version, status)
        return True


LOGGING: dict[str, Any] = {
    "version": 1,
    "disable_existing_loggers": False,
    "filters": {"discretion": {"()": f"{__name__}.Discretion"}},
    "formatters": {"line": {"format": "%(asctime)s %(levelname)s %(message)s"}},
    "handlers": {
        "line": {
            "class": "logging.StreamHandler",
            "stream": "ext://sys.stderr",
            "formatter": "line",
            "filters": ["discretion"],
        }
    },
    "loggers": {
        "uvicorn.error": {"handlers": ["line"], "level": "WARNING", "propagate": False},
        "elbowroom": {"handlers": ["line"], "level": "INFO", "propagate": False},
        "uvicorn.access": {"handlers": ["line"], "level": "INFO", "propagate": False},
    },
}
"""For uvicorn: stdout stays free for the two lines that `serve` prints."""
