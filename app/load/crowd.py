"""How many people one server bears: real sockets, scripted hands, and what they notice.

The server is started as anybody would start it, on a store that is thrown away. The participants are all
in one process of their own, which shares the machine's cores with the server: what is measured is rather
too bad than too good.
"""

import asyncio
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from app.load.served import CpuTime, ServerUnderLoad
from app.server.live import wire
from app.server.live.route import PATH
from app.server.visitors import PARTICIPANT_COOKIE
from data.errors import ElbowroomError
from data.study import Study

if TYPE_CHECKING:
    from websockets.asyncio.client import ClientConnection

    from sim_trials.live import LiveView

INPUTS_PER_S = 60.0
"""What a page sends at least."""

_WARM_UP_S = 180.0
_SETTLE_S = 2.0


@dataclass(frozen=True)
class Load:
    """What came of a load test.

    Attributes
    ----------
    participants, seconds : int, float
        How many guided the robot at once, and for how long.
    skipped_share : float
        Of all control ticks, those for which there was no time.
    latency_median_ms, latency_p95_ms : float
        From sending an input to receiving the first state that used it.
    states_per_s : float
        Received by each participant.
    laps : int
        That came to an end.
    cpu : CpuTime or None
        Of the server, by the second; None where the system doesn't tell.
    client_cpu : float
        Of all participants together, by the second.
    """

    participants: int
    seconds: float
    skipped_share: float
    latency_median_ms: float
    latency_p95_ms: float
    states_per_s: float
    laps: int
    cpu: CpuTime | None
    client_cpu: float


@dataclass
class _Tally:
    """What one participant notices while it counts.

    Attributes
    ----------
    robot_s, wall_s : float
        By how much the robot's clock and ours went on, from the first to the last state of each trial. The
        hands never let go, so that the robot's clock stands still for skipped control ticks alone.
    """

    latencies_ms: list[float] = field(default_factory=list)
    states: int = 0
    laps: int = 0
    robot_s: float = 0.0
    wall_s: float = 0.0


class _Guide:
    """One participant: an input sixty times a second, aimed by what the last state shows."""

    def __init__(self, address: str, origin: str, cookie: str, study: Study, number: int) -> None:
        # Loaded before the sockets open: while it loads, nobody answers the server.
        from sim_trials.scripted_hand import ScriptedHand

        self.tally = _Tally()
        self.is_ready = asyncio.Event()
        self._address, self._origin, self._cookie = address, origin, cookie
        # People differ: between 7 and 13 cm/s, and they don't move in step.
        self._new_hand = partial(ScriptedHand, study, pace_m_s=0.07 + 0.06 * (number * 0.618 % 1.0))
        self._offset_s = number * 0.618 % 1.0 / INPUTS_PER_S
        self._slot = "AB"[number % 2]
        self._view: LiveView | None = None
        self._last: tuple[int, float, float] | None = None
        self._sent: deque[tuple[int, float]] = deque()
        self._seq = 0
        self._trial = 0

    async def run(self, is_over: asyncio.Event) -> None:
        """Guide the robot until it is over."""
        from websockets.asyncio.client import connect
        from websockets.exceptions import ConnectionClosed

        headers = {"Cookie": f"{PARTICIPANT_COOKIE}={self._cookie}", "Origin": self._origin}
        connecting = connect(
            self._address,
            additional_headers=headers,
            compression=None,
            proxy=None,
            open_timeout=_WARM_UP_S,
            ping_interval=None,
        )
        with suppress(ConnectionClosed):
            async with connecting as socket:
                await socket.send(f'{{"type":"open","slot":"{self._slot}"}}')
                tasks = [
                    asyncio.create_task(self._listen(socket)),
                    asyncio.create_task(self._guide(socket)),
                    asyncio.create_task(_until(is_over)),
                ]
                await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
                for task in tasks:
                    task.cancel()
                await asyncio.wait(tasks)
        if not is_over.is_set():
            raise ElbowroomError("the server closed a participant's socket")

    async def _guide(self, socket: "ClientConnection") -> None:
        hand, trial = self._new_hand(), 0
        period = 1.0 / INPUTS_PER_S
        due = time.monotonic() + self._offset_s
        while True:
            await asyncio.sleep(max(due - time.monotonic(), 0.0))
            due = max(due + period, time.monotonic())
            if self._view is None:
                continue
            if trial != self._trial:
                hand, trial = self._new_hand(), self._trial
            aim = hand.aim(self._view, period)
            self._seq += 1
            buttons = wire.ENABLE_BUTTON | (wire.BLAST_BUTTON if aim.blast else 0)
            now = time.monotonic()
            self._sent.append((self._seq, now))
            await socket.send(
                wire.pack_input(
                    wire.InputFrame(
                        buttons,
                        "mouse",
                        self._seq,
                        aim.y_m,
                        aim.z_m,
                        aim.tilt_y_deg,
                        aim.tilt_z_deg,
                        -1.0,
                        self._seq,
                        1000.0 * now,
                    )
                )
            )

    async def _listen(self, socket: "ClientConnection") -> None:
        async for message in socket:
            if isinstance(message, str):
                if '"type":"trial"' in message:
                    self._trial += 1
                elif '"type":"ended"' in message:
                    self._view = None
                    self.tally.laps += 1
                continue
            if message[0] == wire.STATE_KIND:
                self._take(wire.unpack_state(message), time.monotonic())

    def _take(self, state: wire.StateFrame, now: float) -> None:
        """Note a state, and how long ago the inputs were sent that it is the first to use."""
        self._view = None if state.has_ended else state.view
        self.is_ready.set()
        while self._sent and self._sent[0][0] <= state.input_seq:
            self.tally.latencies_ms.append(1000.0 * (now - self._sent.popleft()[1]))
        last, self._last = self._last, (state.trial, now, state.view.time_s)
        self.tally.states += 1
        if last is not None and last[0] == state.trial:
            self.tally.wall_s += now - last[1]
            self.tally.robot_s += state.view.time_s - last[2]


async def _until(event: asyncio.Event) -> None:
    await event.wait()


class Crowd:
    """All participants of a load test, at the robot at once."""

    def __init__(self, server: ServerUnderLoad, study: Study, participants: int) -> None:
        address = server.base.replace("http://", "ws://") + PATH
        self._guides = [
            _Guide(address, server.base, cookie, study, number)
            for number, cookie in enumerate(server.admit(study, participants))
        ]
        self._server = server
        self._is_over = asyncio.Event()
        self._all: asyncio.Future[list[None]] | None = None

    async def start(self) -> None:
        """Open all sockets; when this is done, every robot moves."""
        self._all = asyncio.gather(*(guide.run(self._is_over) for guide in self._guides))
        ready = asyncio.gather(*(guide.is_ready.wait() for guide in self._guides))
        give_up = time.monotonic() + _WARM_UP_S
        while not ready.done() and time.monotonic() < give_up:
            await asyncio.wait([ready], timeout=1.0)
            if self._all.done():
                self._all.result()
        if not ready.done():
            ready.cancel()
            raise ElbowroomError(f"not every robot moved within {_WARM_UP_S:.0f} s")
        await asyncio.sleep(_SETTLE_S)

    async def measure(self, seconds: float, said: Callable[[float], None]) -> Load:
        """Count for a while.

        Parameters
        ----------
        said : callable
            Is told how many seconds have passed, once a second.
        """
        for guide in self._guides:
            guide.tally = _Tally()
        before, mine, start = self._server.cpu_s(), time.process_time(), time.monotonic()
        while (passed := time.monotonic() - start) < seconds:
            said(passed)
            await asyncio.sleep(min(1.0, seconds - passed))
            if self._all is not None and self._all.done():
                self._all.result()
        passed = time.monotonic() - start
        after = self._server.cpu_s()
        tallies = [guide.tally for guide in self._guides]
        latencies = np.array([ms for tally in tallies for ms in tally.latencies_ms])
        if not latencies.size:
            raise ElbowroomError("no robot answered")
        return Load(
            participants=len(tallies),
            seconds=passed,
            skipped_share=1.0 - sum(t.robot_s for t in tallies) / max(sum(t.wall_s for t in tallies), 1e-9),
            latency_median_ms=float(np.percentile(latencies, 50)),
            latency_p95_ms=float(np.percentile(latencies, 95)),
            states_per_s=sum(tally.states for tally in tallies) / len(tallies) / passed,
            laps=sum(tally.laps for tally in tallies),
            cpu=after.since(before, passed) if before and after else None,
            client_cpu=(time.process_time() - mine) / passed,
        )

    async def stop(self) -> None:
        """Close all sockets."""
        self._is_over.set()
        if self._all is not None:
            await self._all
