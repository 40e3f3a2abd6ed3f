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
        self._born = time.monotonic()

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
        """Send one input."""
        self.seq += 1
        clock = (time.monotonic() - self._born) * 1000
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

    def until(self, kind: str, seconds: float = 20.0) -> dict[str, Any]:
        """Wait for a message of a type that was not seen before this call."""
        seen, end = len(self.told), time.monotonic() + seconds
        while time.monotonic() < end and self.close_code is None:
            self.read(end - time.monotonic())
            for said in self.told[seen:]:
                if said["type"] == kind:
                    return said
        raise AssertionError(f"no {kind!r} came; told {self.told[-5:]}, closed {self.close_code}")

    def until_closed(self, seconds: float = 10.0) -> int | None:
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.close_code is None:
            self.read(end - time.monotonic())
        return self.close_code

    def open(self, slot: str) -> dict[str, Any]:
        """Turn to a slot; a server that has just started compiles before a trial begins."""
        self.tell("open", slot=slot)
        return self.until("trial", 90.0)

    def wait_for_the_robot(self) -> None:
        """Until the first state comes."""
        end = time.monotonic() + 90.0
        while self.state is None and time.monotonic() < end:
            self.read(1.0)
        assert self.state is not None

    def guide(self, seconds: float, aim: Aim = to_the_right, buttons: int = 3, until: str = "") -> None:
        """Hold the robot for a while, or until a message of a type comes."""
        seen, end = len(self.told), time.monotonic() + seconds
        due = time.monotonic()
        while due < end and not any(said["type"] == until for said in self.told[seen:]):
            self.hold(*aim(self.state), buttons)
            due = max(due + PERIOD_S, time.monotonic())
            while self.read(due - time.monotonic()) or time.monotonic() < due:
                assert self.close_code is None, f"closed with {self.close_code}"
