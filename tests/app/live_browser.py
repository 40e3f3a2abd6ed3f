"""A participant's page without a browser: the websocket, and a hand that moves as the script says."""

import json
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from app.server.live.wire import InputFrame, StateFrame, pack_input, unpack_state
from app.server.visitors import PARTICIPANT_COOKIE
from data.study import Study
from data.study_file import parse_study
from sim_trials.scripted_hand import ScriptedHand
from tests.conftest import PATIENCE_S

from .conftest import GUIDED_STUDY, Server

PERIOD_S = 1 / 60

STUDY = parse_study(GUIDED_STUDY, where="the guided study")

Aim = Callable[[StateFrame | None], tuple[float, float]]


def still(state: StateFrame | None) -> tuple[float, float]:
    """Where the cursor starts."""
    del state
    return 0.35, 0.45


def to_the_right(state: StateFrame | None) -> tuple[float, float]:
    """A little ahead of the cursor, along the first edge."""
    return (0.35 if state is None else state.view.cursor_y_m) - 0.1, 0.45


class AroundTheMaze:
    """A hand that guides the robot around."""

    def __init__(self, study: Study = STUDY) -> None:
        self._hand = ScriptedHand(study, pace_m_s=0.2)

    def __call__(self, state: StateFrame | None) -> tuple[float, float]:
        if state is None:
            return still(state)
        aim = self._hand.aim(state.view, PERIOD_S)
        return aim.y_m, aim.z_m


class LiveBrowser:
    """One window: what it was told, and the newest state."""

    def __init__(self, server: Server, cookie: str, *, origin: str | None = None) -> None:
        self._connecting = connect(
            server.base.replace("http://", "ws://") + "/live",
            additional_headers={"Cookie": f"{PARTICIPANT_COOKIE}={cookie}"},
            origin=server.base if origin is None else origin,  # type: ignore[arg-type]
            compression=None,
            proxy=None,
            open_timeout=PATIENCE_S,
            ping_interval=None,
            # A window that isn't read for a while must answer the server's pings all the same.
            max_queue=None,
            max_size=1 << 20,
        )
        self.socket: ClientConnection
        self.told: list[dict[str, Any]] = []
        self.received: list[str | bytes] = []
        self.strokes: dict[int, list[tuple[int, bytes]]] = {}
        self.state: StateFrame | None = None
        self.trial = 0
        self.seq = 0
        self.close_code: int | None = None

    def __enter__(self) -> Self:
        self.socket = self._connecting.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connecting.__exit__(kind, error, trace)

    def tell(self, kind: str, **more: object) -> None:
        self.socket.send(json.dumps({"type": kind, **more}))

    def hold(self, y: float, z: float, buttons: int = 3, **changes: object) -> None:
        """Send one input; by the page's own clock they come at an even pace."""
        self.seq += 1
        clock = 1000 * PERIOD_S * self.seq
        fields: dict[str, Any] = {
            "buttons": buttons, "device": "mouse", "seq": self.seq, "hand_y_m": y, "hand_z_m": z,
            "tilt_y_deg": 0.0, "tilt_z_deg": 0.0, "latency_ms": 20.0, "frames": self.seq, "client_ms": clock,
            **changes,
        }  # fmt: skip
        self.socket.send(pack_input(InputFrame(**fields)))

    def read(self, seconds: float) -> bool:
        """Take in one message, if one comes in time."""
        try:
            message = self.socket.recv(timeout=max(seconds, 0.0))
        except TimeoutError:
            return False
        except ConnectionClosed as closed:
            self.close_code = closed.rcvd.code if closed.rcvd else 1006
            return False
        self.received.append(message)
        if isinstance(message, str):
            said = json.loads(message)
            self.told.append(said)
            if said["type"] == "trial":
                self.trial, self.state = said["trial"], None
        elif message[0] == 2:
            state = unpack_state(message)
            if state.trial == self.trial:
                self.state = state
        else:
            first = int.from_bytes(message[8:12], "little")
            self.strokes.setdefault(int.from_bytes(message[4:8], "little"), []).append((first, message[12:]))
        return True

    def points(self, trial: int) -> bytes:
        """All points of a trial's strokes, put together by their numbers."""
        found = bytearray()
        for first, points in self.strokes.get(trial, []):
            assert first * 16 <= len(found), "a gap in the strokes"
            found[first * 16 : first * 16 + len(points)] = points
        return bytes(found)

    def until(self, kind: str, *, since: int | None = None) -> dict[str, Any]:
        """Wait for a message of a type.

        Parameters
        ----------
        since : int, optional
            Only what came after so many messages (`told`) counts; by default what comes after this call.
        """
        seen, end = len(self.told) if since is None else since, time.monotonic() + PATIENCE_S
        while True:
            for said in self.told[seen:]:
                if said["type"] == kind:
                    return said
            if time.monotonic() > end or self.close_code is not None:
                raise AssertionError(f"no {kind!r} came; told {self.told[-5:]}, closed {self.close_code}")
            self.read(end - time.monotonic())

    def until_closed(self) -> int | None:
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end and self.close_code is None:
            self.read(end - time.monotonic())
        return self.close_code

    def until_seen(self, is_so: Callable[[StateFrame], bool]) -> StateFrame:
        """Look on until a state is so."""
        end = time.monotonic() + PATIENCE_S
        while self.state is None or not is_so(self.state):
            assert time.monotonic() < end, f"last seen: {self.state}"
            assert self.close_code is None, f"closed with {self.close_code}"
            self.read(1.0)
        return self.state

    def open(self, slot: str) -> dict[str, Any]:
        """Turn to a slot; a server that has just started compiles before a trial begins."""
        self.tell("open", slot=slot)
        return self.until("trial")

    def wait_for_the_robot(self) -> None:
        """Until the first state comes."""
        self.until_seen(lambda _: True)

    def press(self, seconds: float, aim: Aim = to_the_right, buttons: int = 3) -> None:
        """Send inputs for a while, whatever comes of it."""
        end = time.monotonic() + seconds
        self._send_until(lambda: time.monotonic() >= end, aim, buttons)

    def guide(self, seconds: float, aim: Aim = to_the_right) -> None:
        """Hold the robot until its clock has gone on for so long: a loaded machine holds it up."""
        passed, last = 0.0, self.state

        def is_over() -> bool:
            nonlocal passed, last
            before, last = last, self.state
            if before is not None and last is not None and before.trial == last.trial:
                passed += last.view.time_s - before.view.time_s if last.view.is_enabled else 0.0
            return passed >= seconds and last is not None and last.view.is_enabled

        self.guide_until(is_over, aim)

    def guide_until(self, is_over: Callable[[], bool], aim: Aim = to_the_right) -> None:
        """Hold the robot until something is so."""
        end = time.monotonic() + PATIENCE_S

        def is_enough() -> bool:
            assert time.monotonic() < end, f"last seen: {self.state}, told {self.told[-5:]}"
            return is_over()

        self._send_until(is_enough, aim, buttons=3)

    def guide_to_the_end(self, aim: Aim) -> dict[str, Any]:
        """Hold the robot until the lap has ended: how it did."""
        seen = len(self.told)
        self.guide_until(lambda: any(said["type"] == "ended" for said in self.told[seen:]), aim)
        return self.until("ended", since=seen)

    def _send_until(self, is_over: Callable[[], bool], aim: Aim, buttons: int) -> None:
        due = time.monotonic()
        while not is_over():
            self.hold(*aim(self.state), buttons)
            due = max(due + PERIOD_S, time.monotonic())
            while self.read(due - time.monotonic()) or time.monotonic() < due:
                assert self.close_code is None, f"closed with {self.close_code}"
