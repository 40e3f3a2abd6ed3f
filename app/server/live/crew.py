"""The live workers as the web process sees them: the least busy gets a new trial.

One that is dead is replaced, and so is one that hangs: a worker with trials says something at least twice a
second.
"""

import asyncio
import itertools
import multiprocessing
import socket
from multiprocessing.process import BaseProcess
from typing import Protocol

from app.server.access_log import LOG
from app.server.live import channel
from app.server.live.channel import Beginning, Ending, Inbox, Order, Tidings
from app.server.live.worker import work
from data.study import Study

_MOST_UNREAD = 1 << 20
"""A worker that leaves so many bytes unread hangs, and is replaced."""
_PATIENCE_S = 1.0
"""A worker that replaces one which hardly lived starts after a pause [s]."""
_GOODBYE_S = 5.0
_LOOK_S = 0.5
_MOST_SILENT_LOOKS = 4
"""A worker that has trials and was silent between so many looks hangs. Looks are counted rather than
seconds, so that nobody is to blame for what passes while the whole machine sleeps."""


class Follower(Protocol):
    """Who wants to know how a trial goes."""

    def on_state(self, state: bytes, ticks: int, skipped: int) -> None:
        """The newest state, as the browser gets it; control ticks taken and skipped so far."""

    def on_strokes(self, points: bytes) -> None:
        """New points of the strokes (``wire.POINT``)."""

    def on_ending(self, ending: Ending) -> None:
        """The trial is over; nothing comes after."""

    def on_lost(self) -> None:
        """The trial is gone with its worker; nothing comes after."""


class Handle:
    """A trial on its worker: what the web process can do to it."""

    def __init__(self, member: "Member", run: int) -> None:
        self._member = member
        self._name = channel.RUN.pack(run)

    def send_input(self, frame: bytes) -> None:
        """Pass an input frame on; its content was checked."""
        self._member.tell(channel.message(Order.INPUT, self._name + frame))

    def release(self) -> None:
        """Take the hand off the robot."""
        self._member.tell(channel.message(Order.RELEASE, self._name))

    def end(self) -> None:
        """Give the lap up: `Follower.on_ending` comes soon."""
        self._member.tell(channel.message(Order.END, self._name))


class Member(asyncio.Protocol):
    """One worker."""

    def __init__(self, crew: "Crew", study: Study) -> None:
        self.followers: dict[int, Follower] = {}
        self.is_ready = False
        self._was_heard = False
        self._silent_looks = 0
        self._crew = crew
        self._inbox = Inbox()
        self._transport: asyncio.WriteTransport | None = None
        self._ours, theirs = socket.socketpair()
        for end in (self._ours, theirs):
            for option in (socket.SO_SNDBUF, socket.SO_RCVBUF):
                end.setsockopt(socket.SOL_SOCKET, option, channel.SOCKET_BUFFER)
        context = multiprocessing.get_context("spawn")
        self.process: BaseProcess = context.Process(target=work, args=(theirs, study), daemon=True)
        self.process.start()
        # The worker has its own copy: with this one open, its death would not be noticed.
        theirs.close()

    async def connect(self) -> None:
        """Listen to it."""
        self._ours.setblocking(False)
        await asyncio.get_running_loop().create_connection(lambda: self, sock=self._ours)

    def tell(self, content: bytes) -> None:
        """Send it a message."""
        transport = self._transport
        if transport is None or transport.is_closing():
            return
        if transport.get_write_buffer_size() > _MOST_UNREAD:
            self.process.kill()
            return
        transport.write(content)

    def look(self) -> None:
        """See whether it does its work; kill it if it has not for long."""
        self._silent_looks = 0 if self._was_heard or not self.followers else self._silent_looks + 1
        self._was_heard = False
        if self._silent_looks >= _MOST_SILENT_LOOKS:
            LOG.error("a live worker hangs (%s)", self.process.pid)
            self.process.kill()

    def hang_up(self) -> None:
        """Let it go home."""
        if self._transport is not None:
            self._transport.close()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """asyncio: it can be told things."""
        assert isinstance(transport, asyncio.WriteTransport)
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        """asyncio: it tells something."""
        self._was_heard = True
        for kind, content in self._inbox.take(data):
            if kind == Tidings.STATE:
                run, ticks, skipped = channel.PROGRESS.unpack_from(content)
                follower = self.followers.get(run)
                if follower is not None:
                    follower.on_state(content[channel.PROGRESS.size :], ticks, skipped)
            elif kind == Tidings.STROKES:
                follower = self.followers.get(channel.RUN.unpack_from(content)[0])
                if follower is not None:
                    follower.on_strokes(content[channel.RUN.size :])
            elif kind == Tidings.ENDED:
                ending = channel.unpickled(content, Ending)
                follower = self.followers.pop(ending.run, None)
                if follower is not None:
                    follower.on_ending(ending)
            elif kind == Tidings.FAILED:
                run = channel.RUN.unpack_from(content)[0]
                LOG.error("a live trial failed: %s", content[channel.RUN.size :].decode())
                follower = self.followers.pop(run, None)
                if follower is not None:
                    follower.on_lost()
            elif kind == Tidings.READY:
                self.is_ready = True

    def connection_lost(self, exc: Exception | None) -> None:
        """asyncio: it is dead, or was let go."""
        del exc
        self._crew.miss(self)
        lost = list(self.followers.values())
        self.followers.clear()
        for follower in lost:
            follower.on_lost()


class Crew:
    """All live workers of one server."""

    def __init__(self, study: Study, size: int) -> None:
        self.size = size
        self._study = study
        self._members: list[Member] = []
        self._numbers = itertools.count(1)
        self._is_open = False
        self._hirings: set[asyncio.Task[None]] = set()
        self._next_look: asyncio.TimerHandle | None = None

    async def start(self) -> None:
        """Start the workers; they compile what they need while others start."""
        self._is_open = True
        for _ in range(self.size):
            await self._hire()
        self._look()

    async def close(self) -> None:
        """Let all workers go; trials under way are lost."""
        self._is_open = False
        if self._next_look is not None:
            self._next_look.cancel()
        for hiring in self._hirings:
            hiring.cancel()
        leaving = list(self._members)
        for member in leaving:
            member.hang_up()
            if not member.is_ready:
                # It compiles, and would not notice for long.
                member.process.kill()
        for member in leaving:
            await asyncio.to_thread(member.process.join, _GOODBYE_S)
            if member.process.is_alive():
                member.process.kill()

    @property
    def is_ready(self) -> bool:
        """Whether a trial can be had at once."""
        return any(member.is_ready for member in self._members)

    def begin(
        self, follower: Follower, *, trial: int, mode: str, lap: int, is_practice: bool
    ) -> Handle | None:
        """Start a trial on the least busy worker; None if none is ready just now.

        Parameters
        ----------
        trial : int
            Its number between server and browser.
        mode : str
            Name of one of the study's modes.
        """
        ready = [member for member in self._members if member.is_ready]
        if not ready:
            return None
        member, run = min(ready, key=lambda member: len(member.followers)), next(self._numbers)
        member.followers[run] = follower
        member.tell(channel.pickled(Order.BEGIN, Beginning(run, trial, mode, lap, is_practice)))
        return Handle(member, run)

    def miss(self, member: Member) -> None:
        """A worker is gone: replace it."""
        if member in self._members:
            self._members.remove(member)
        if not self._is_open:
            return
        LOG.error("a live worker is gone (%s); a new one takes over", member.process.pid)
        hiring = asyncio.ensure_future(self._replace(0.0 if member.is_ready else _PATIENCE_S))
        self._hirings.add(hiring)
        hiring.add_done_callback(self._hirings.discard)

    async def _replace(self, pause_s: float) -> None:
        """Hire another, as soon as the machine has room for one."""
        while True:
            await asyncio.sleep(pause_s)
            try:
                await self._hire()
            except OSError as error:
                LOG.error("no new live worker can be started yet: %s", error)
                pause_s = _PATIENCE_S
            else:
                return

    async def _hire(self) -> None:
        member = Member(self, self._study)
        await member.connect()
        self._members.append(member)

    def _look(self) -> None:
        """Look at all workers, now and again."""
        for member in self._members:
            member.look()
        self._next_look = asyncio.get_running_loop().call_later(_LOOK_S, self._look)
