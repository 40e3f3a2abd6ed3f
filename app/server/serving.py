"""`elbowroom serve`: one process with the browser app, until it is told to stop."""

import signal
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from app.server.public_url import PublicUrl, parse_public_url
from data.errors import ElbowroomError, InputError
from data.store import Store, StoredStudy, token_sha256
from data.store.links import LinkKind

_WILDCARDS = ("", "0.0.0.0", "::")
_PROXIES = ["127.0.0.1", "::1"]
_ELSEWHERE = {socket.AF_INET: "198.51.100.1", socket.AF_INET6: "2001:db8::1"}
"""Addresses that are nobody's (RFC 5737, RFC 3849): nothing is ever sent to them."""
_GOODBYE_S = 3
_MOST_LAP_WORKERS = 4
_SWITCH_S = 0.0005
_LONG_S = 5.0


def serve(
    study_source: str | Path,
    store_url: str | Path,
    host: str = "127.0.0.1",
    port: int = 8501,
    workers: int | None = None,
    passphrase: str | None = None,
    public_url: str | None = None,
) -> None:
    """Serve a study until SIGINT or SIGTERM.

    Prints ``participant: URL`` and ``researcher: URL`` (which opens once) as soon as requests are answered.

    Parameters
    ----------
    study_source : str or Path
        Name of a built-in study, or a study file.
    store_url : str or Path
        Where everything goes: a path or a SQLAlchemy URL.
    port : int
        0 takes any free one.
    workers : int, optional
        Processes that run the robot; by default one per core. Where people guide it themselves, half as many
        more finish their laps.
    passphrase : str, optional
        Opens the console beside the one-time link.
    public_url : str, optional
        Where browsers reach the server, if a proxy stands before it: links begin with it, writes come from
        there alone, and a proxy on this machine is believed in whose name it asks.

    Raises
    ------
    InputError
        If the study, the store's address or the public one is wrong.
    ElbowroomError
        If the store or the port cannot be had.
    """
    from app.server.passphrase import set_passphrase
    from app.studies import check_can_be_run, open_study

    public = parse_public_url(public_url) if public_url is not None else None
    opened = open_study(study_source)
    with _listen(host, port) as listener:
        # A wrong mode or a maze out of reach is found now, not when a participant waits for a lap.
        with _saying_that_it_takes_long():
            check_can_be_run(opened.study, str(study_source))
        with Store.open(store_url) as store:
            set_passphrase(passphrase, store.clock)
            _run(listener, store, store.add_study(opened.study, opened.text), host, workers, public)


def _run(
    listener: socket.socket,
    store: Store,
    stored: StoredStudy,
    host: str,
    workers: int | None,
    public_url: PublicUrl | None,
) -> None:
    import os

    import uvicorn

    from app.server.access_log import LOGGING
    from app.server.asgi import build_app
    from app.server.desk import Desk
    from app.server.laps import LapKeeper
    from app.server.live.sessions import LiveSessions
    from app.server.live.socket import LiveSocket
    from app.server.settings import apply_settings

    apply_settings(public_url)
    # So often does a page's script that computes hand the interpreter over: states that wait to be passed on
    # must not wait for the usual 5 ms each time.
    sys.setswitchinterval(_SWITCH_S)
    size = workers or os.cpu_count() or 1
    is_guided = stored.study.protocol.trial_source == "guided"
    laps = LapKeeper(
        stored.study, store.recordings_folder, min((size + 1) // 2 if is_guided else size, _MOST_LAP_WORKERS)
    )
    live = LiveSessions(stored.study, store, laps.pool, size) if is_guided else None
    app = build_app(Desk(stored, store, laps, live, public_url))
    own = f"http://{shown_host(host)}:{listener.getsockname()[1]}"
    base = public_url.origin if public_url is not None else own
    lines = (
        f"participant: {base}/join/{_new_link(store, stored, 'participant')}",
        f"researcher: {base}/researcher/{_new_link(store, stored, 'researcher')}",
    )

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            if self.started:
                print(*lines, sep="\n", flush=True)

    config = uvicorn.Config(
        app,
        log_config=LOGGING,
        timeout_graceful_shutdown=_GOODBYE_S,
        server_header=False,
        proxy_headers=public_url is not None,
        forwarded_allow_ips=_PROXIES,
        ws=LiveSocket,
        ws_max_size=1 << 20,
    )
    _stop_quietly()
    Server(config).run(sockets=[listener])


@contextmanager
def _saying_that_it_takes_long() -> Iterator[None]:
    """After some seconds, a line on stderr: a first start compiles the robot, and shows nothing else."""
    words = "Compiling the robot; the first start on a machine takes about a minute."
    timer = threading.Timer(_LONG_S, print, (words,), {"file": sys.stderr, "flush": True})
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _new_link(store: Store, stored: StoredStudy, kind: LinkKind) -> str:
    from app.server.visitors import new_token

    token = new_token()
    store.create_link(kind, stored, token_sha256(token), label="elbowroom serve")
    return token


def _listen(host: str, port: int) -> socket.socket:
    """A socket that listens already, so that a port in use is found before anything else is done."""
    if not 0 <= port <= 65535:
        raise InputError(f"--port: {port} is not in 0..65535")
    try:
        found = socket.getaddrinfo(host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        family, kind, protocol, _, address = found[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ElbowroomError(f"--host: {host!r} is no address of this machine ({error.strerror})") from None
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen(256)
    except OSError as error:
        listener.close()
        raise ElbowroomError(
            f"cannot serve on {host}:{port}: {(error.strerror or str(error)).lower()}"
        ) from None
    listener.set_inheritable(False)
    return listener


def shown_host(host: str) -> str:
    """How a browser names the host it listens on: by this machine's address in its network, if on all."""
    if host in _WILDCARDS:
        host = _network_address(socket.AF_INET6 if host == "::" else socket.AF_INET) or "127.0.0.1"
    return f"[{host}]" if ":" in host else host


def _network_address(family: socket.AddressFamily) -> str | None:
    """The address from which this machine would speak to others; None if it is in no network."""
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        try:
            # "Connecting" a datagram socket looks up the route and sends nothing.
            probe.connect((_ELSEWHERE[family], 9))
            return str(probe.getsockname()[0])
        except OSError:
            return None


def _stop_quietly() -> None:
    """uvicorn raises the signal that stopped it once more when it is done; by then nothing is left to do."""

    def done(number: int, frame: FrameType | None) -> None:
        del number, frame

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, done)
