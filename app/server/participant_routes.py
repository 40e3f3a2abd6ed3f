"""What the participant's page fetches and sends beside Streamlit: laps, what was watched, answers.

Each looks up the cookie's participant and the comparison that is open in the store, so an address names a
slot and a lap alone, and the same address means another lap in the next comparison.
"""

import asyncio
import json
from collections.abc import Awaitable, Callable
from concurrent.futures.process import BrokenProcessPool

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from app.operator import session as external_runs
from app.participant.progress import Progress, may_still_take_part, progress_of
from app.participant.watching import BadReport, WatchReport, store_report, watched_s
from app.server.access_log import LOG
from app.server.desk import desk
from app.server.visitors import visitor
from data.errors import ElbowroomError, InputError

_NO_STORE = {"cache-control": "no-store"}
_LONGEST_BODY = 64 * 1024

Handler = Callable[[Request, Progress], Awaitable[Response]]


def _for_participants(handler: Handler) -> Callable[[Request], Awaitable[Response]]:
    """The handler, for those alone who have a comparison open."""

    async def checked(request: Request) -> Response:
        try:
            progress = await run_in_threadpool(_progress, request)
            if progress is None:
                return _answer(403, "no participant")
            if not may_still_take_part(desk().study, progress.participant, desk().clock()):
                return _answer(409, "the time to take part has passed")
            if progress.comparison is None:
                return _answer(409, "no comparison is open")
            return await handler(request, progress)
        except (ElbowroomError, BrokenProcessPool) as error:
            # A full disk, a busy store, a killed worker: the page keeps what it has and tries again.
            LOG.error("%s: %s", request.url.path, error)
            return _answer(503, "not now")

    return checked


def _progress(request: Request) -> Progress | None:
    here = visitor(desk(), request.cookies)
    if here is None or here.participant is None:
        return None
    return progress_of(desk().store, here.participant)


async def _lap(request: Request, progress: Progress) -> Response:
    slot, lap = request.path_params["slot"], request.path_params["lap"]
    if not _is_observed():
        return _answer(404, "no such lap")
    if slot not in ("A", "B") or not 1 <= lap <= desk().study.protocol.laps_per_condition:
        return _answer(404, "no such lap")
    watched = await asyncio.wrap_future(desk().laps.lap(progress.lap_key(desk().study, slot, lap)))
    return Response(watched.frames, media_type="application/octet-stream", headers=_NO_STORE)


async def _watched(request: Request, progress: Progress) -> Response:
    body = await _body(request)
    assert progress.comparison is not None
    if not _is_observed():
        return _answer(404, "nothing is watched here")
    if body is None:
        return _answer(422, "no report")
    if body.get("comparison") != progress.comparison.position:
        return _answer(409, "another comparison is open")
    try:
        report = WatchReport.parse(body, desk().study)
    except BadReport as error:
        return _answer(422, str(error))
    laps = {}
    for run in report.runs:
        key = progress.lap_key(desk().study, run.slot, run.lap)
        laps[run.slot, run.lap] = await asyncio.wrap_future(desk().laps.lap(key))
    refused: dict[str, object] = {}
    try:
        await run_in_threadpool(store_report, desk().store, progress, report, laps, desk().clock())
    except BadReport as error:
        refused = {"refused": str(error)}
    # Also after a refusal: the page must not count what the server doesn't.
    seconds = await run_in_threadpool(watched_s, desk().store, progress.comparison)
    return JSONResponse({**refused, "watched": seconds}, 422 if refused else 200, headers=_NO_STORE)


async def _answers(request: Request, progress: Progress) -> Response:
    body = await _body(request)
    comparison = progress.comparison
    assert comparison is not None
    answers = body.get("answers") if body is not None else None
    if body is None or not isinstance(answers, dict):
        return _answer(422, "no answers")
    if body.get("comparison") != comparison.position:
        return _answer(409, "another comparison is open")
    seconds = await run_in_threadpool(watched_s, desk().store, comparison)
    if not progress.may_answer(desk().study, seconds):
        return _answer(422, "not watched long enough")
    given = {str(name): str(answer) for name, answer in answers.items()}
    try:
        await run_in_threadpool(_submit, comparison.id, given, progress)
    except InputError:
        return _answer(422, "an answer is missing or not on its scale")
    live = desk().live
    if live is not None:
        live.dismiss(progress.participant.id)
    return JSONResponse({"stored": True}, headers=_NO_STORE)


def _is_observed() -> bool:
    """Whether the study's laps are watched: nobody else may claim to have watched any."""
    return desk().study.protocol.trial_source == "observed"


def _submit(comparison_id: str, answers: dict[str, str], progress: Progress) -> None:
    """Store the answers, and with the last ones that the participant has finished.

    A run that the operator began in the lab meanwhile ends with them.
    """
    store, now = desk().store, desk().clock()
    with store.transaction():
        store.submit_responses(comparison_id, answers, now)
        external_runs.finish(store, comparison_id, now)
        if progress.is_last:
            store.finish_participant(progress.participant.id, now)


async def _body(request: Request) -> dict[str, object] | None:
    if not request.headers.get("content-type", "").startswith("application/json"):
        return None
    content = b""
    async for part in request.stream():
        content += part
        if len(content) > _LONGEST_BODY:
            return None
    try:
        body = json.loads(content)
    except (ValueError, RecursionError):
        return None
    return body if isinstance(body, dict) else None


def _answer(status: int, why: str) -> Response:
    return JSONResponse({"refused": why}, status_code=status, headers=_NO_STORE)


ROUTES = (
    Route("/laps/{slot}/{lap:int}", _for_participants(_lap), methods=["GET"]),
    Route("/watched", _for_participants(_watched), methods=["POST"]),
    Route("/answers", _for_participants(_answers), methods=["POST"]),
)
