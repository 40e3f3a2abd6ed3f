"""The two doors: a participant's link and a researcher's one-time link, each traded for a cookie.

The token leaves the address bar at once: both answer with a redirect to a clean URL.
"""

from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import Route

from app.participant.texts import texts
from app.server.desk import desk
from app.server.visitors import (
    PARTICIPANT_COOKIE,
    RESEARCHER_COOKIE,
    give_cookie,
    new_participant_cookie,
    new_researcher_cookie,
    visitor,
)
from data.store import LinkRefused

_PARTICIPANT_DAYS = 60
_RESEARCHER_DAYS = 7

_REFUSED = """<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width"><meta name="color-scheme" content="light dark">
<body style="font:16px/24px system-ui,sans-serif;max-width:34em;margin:15vh auto;padding:0 24px">
<h1 style="font-size:24px">{title}</h1><p>{text}</p></body></html>"""


def join(request: Request) -> Response:
    """Follow a participant's link. Who took part in this browser through the same link goes on there."""
    token = request.path_params["token"]
    here = visitor(desk(), request.cookies)
    if here is not None and here.cookie.partition(".")[0] == token:
        return _to("/")
    cookie = new_participant_cookie(desk(), token)
    if cookie is None:
        page = texts()["page"]
        return _refused(page["bad_link_title"], page["bad_link"])
    return _with_cookie(_to("/"), PARTICIPANT_COOKIE, cookie, _PARTICIPANT_DAYS)


def research(request: Request) -> Response:
    """Follow a researcher's link, which opens the console once; only looking at it doesn't use it up."""
    if request.method != "GET":
        return Response(status_code=405)
    try:
        cookie = new_researcher_cookie(desk(), request.path_params["token"])
    except LinkRefused as error:
        return _refused(
            "This link doesn't open the console",
            f"{str(error).capitalize()}. Starting elbowroom serve again prints a new one.",
        )
    return _with_cookie(_to("/overview"), RESEARCHER_COOKIE, cookie, _RESEARCHER_DAYS)


def _to(path: str) -> Response:
    return RedirectResponse(path, status_code=303, headers={"cache-control": "no-store"})


def _refused(title: str, text: str) -> Response:
    page = _REFUSED.format(title=title, text=text)
    return HTMLResponse(page, status_code=403, headers={"cache-control": "no-store"})


def _with_cookie(response: Response, name: str, value: str, days: int) -> Response:
    give_cookie(response, desk(), name, value, days)
    return response


ROUTES = (
    Route("/join/{token}", join, methods=["GET"]),
    Route("/researcher/{token}", research, methods=["GET"]),
)
