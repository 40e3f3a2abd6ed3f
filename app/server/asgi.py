"""The app: Streamlit's pages, our routes beside them, and the guard around both."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import Scope
from streamlit.starlette import App

from app.console import replay_routes
from app.server import entry, participant_routes, passphrase
from app.server.desk import Desk, open_desk
from app.server.guard import Guard
from app.server.live import route

_APP = Path(__file__).resolve().parent.parent


def build_app(desk: Desk) -> App:
    """The ASGI app of a desk; `settings.apply_settings` comes first."""
    open_desk(desk)

    @asynccontextmanager
    async def open_hours(_: App) -> AsyncIterator[None]:
        if desk.live is not None:
            await desk.live.start()
        elif desk.study.protocol.trial_source == "observed":
            desk.laps.warm_up()
        try:
            yield
        finally:
            if desk.live is not None:
                await desk.live.close()
            desk.laps.close()

    return App(
        _APP / "server" / "page.py",
        routes=[
            Route("/healthz", _health, methods=["GET"]),
            *entry.ROUTES,
            *participant_routes.ROUTES,
            *passphrase.ROUTES,
            *replay_routes.ROUTES,
            WebSocketRoute(route.PATH, route.LiveRoute()),
            Mount("/stage", StageModules(directory=_APP / "stage" / "modules")),
        ],
        middleware=[Middleware(Guard, public_url=desk.public_url)],
        lifespan=open_hours,
    )


def _health(_: Request) -> Response:
    return JSONResponse({"status": "ok"}, headers={"cache-control": "no-store"})


class StageModules(StaticFiles):
    """The browser's modules: the same for everyone, and looked at again after an upgrade."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """A module, to be revalidated each time."""
        response = await super().get_response(path, scope)
        response.headers["cache-control"] = "no-cache"
        return response
