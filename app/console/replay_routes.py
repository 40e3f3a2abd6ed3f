"""What the console fetches beside Streamlit: replays, recordings and the report, with its cookie alone."""

import asyncio
import threading
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from app.console.full_fit import full_fit, log_reading
from app.console.replay import replay_content
from app.server.access_log import LOG
from app.server.desk import Desk, desk
from app.server.visitors import is_researcher
from data.errors import ElbowroomError
from data.records import Trial

KEPT_REPLAYS = 48
"""How many replays stay in memory, about 150 kB each."""
_NO_STORE = {"cache-control": "no-store"}

Handler = Callable[[Request], Awaitable[Response]]


def _for_researchers(handler: Handler) -> Handler:
    """The handler, for those alone whose cookie opens the console."""

    async def checked(request: Request) -> Response:
        if not await run_in_threadpool(is_researcher, desk(), request.cookies):
            return _answer(403, "no researcher")
        try:
            return await handler(request)
        except ElbowroomError as error:
            return _answer(404, str(error))
        except BrokenProcessPool as error:
            LOG.error("%s: %s", request.url.path, error)
            return _answer(503, "not now")

    return checked


class Replays:
    """Replays under way and done; the same trial is computed once."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, Future[bytes]] = OrderedDict()
        self._lock = threading.Lock()

    def of(self, at: Desk, trial: Trial) -> "Future[bytes]":
        """A trial's replay to come."""
        path = at.store.recording_path(trial)
        with self._lock:
            known = self._known.get(trial.id)
            if known is not None and not (known.done() and (known.cancelled() or known.exception())):
                self._known.move_to_end(trial.id)
                return known
            future = at.laps.pool.submit(
                replay_content, path, trial.recording_sha256, at.study, trial.duration_s, trial.outcome
            )
            self._known[trial.id] = future
            while len(self._known) > KEPT_REPLAYS:
                self._known.popitem(last=False)
            return future


_replays = Replays()


def _trial(trial_id: str) -> Trial:
    """A trial of the study on offer; another study's labels may not be known here."""
    store = desk().store
    trial = store.trial(trial_id)
    if store.study_of(store.comparison(trial.comparison).participant).id != desk().stored_study.id:
        raise ElbowroomError(f"trial {trial_id!r} is not of this study")
    return trial


async def _replay(request: Request) -> Response:
    trial = await run_in_threadpool(_trial, request.path_params["trial"])
    future = await run_in_threadpool(_replays.of, desk(), trial)
    # Shielded: who leaves the page must not cancel what another one waits for.
    content = await asyncio.shield(asyncio.wrap_future(future))
    return Response(content, media_type="application/octet-stream", headers=_NO_STORE)


async def _recording(request: Request) -> Response:
    trial = await run_in_threadpool(_trial, request.path_params["trial"])
    if not await run_in_threadpool(desk().store.is_unblinded, desk().stored_study):
        return _answer(409, "the recording names its mode, and the study is blinded")
    path = await run_in_threadpool(desk().store.recording_path, trial)
    return FileResponse(
        path, media_type="application/vnd.apache.parquet", filename=f"{trial.id}.parquet", headers=_NO_STORE
    )


async def _report(request: Request) -> Response:
    """A file of the report that was fitted last; reading it while the study is blinded is logged."""
    report = full_fit().report
    if report is None:
        return _answer(404, "no report")
    wanted = (report.folder / request.path_params["file"]).resolve()
    if not wanted.is_relative_to(report.folder.resolve()) or not wanted.is_file():
        return _answer(404, "no such file")
    if wanted.name == "report.html":
        await run_in_threadpool(log_reading, desk(), "read report")
    return FileResponse(wanted, headers=_NO_STORE)


def _answer(status: int, why: str) -> Response:
    return JSONResponse({"refused": why}, status_code=status, headers=_NO_STORE)


class _Modules(StaticFiles):
    """The console's browser modules, looked at again after an upgrade."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """A module, to be revalidated each time."""
        response = await super().get_response(path, scope)
        response.headers["cache-control"] = "no-cache"
        return response


ROUTES = (
    Route("/replays/{trial}", _for_researchers(_replay), methods=["GET"]),
    Route("/recordings/{trial}", _for_researchers(_recording), methods=["GET"]),
    Route("/report/{file:path}", _for_researchers(_report), methods=["GET"]),
    Mount("/console-modules", _Modules(directory=Path(__file__).resolve().parent / "modules")),
)
