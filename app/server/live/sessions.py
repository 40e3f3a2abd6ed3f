"""All live sessions of a server: who comes in gets theirs, and the console sees who is there."""

import asyncio
import concurrent.futures
from collections import defaultdict

from starlette.concurrency import run_in_threadpool

from app.participant.progress import progress_of
from app.server.access_log import LOG
from app.server.live.archive import Archive, Standing, nothing_yet
from app.server.live.board import LiveRow
from app.server.live.connection import Connection
from app.server.live.crew import Crew
from app.server.live.guided_lap import warm_up
from app.server.live.session import Session
from app.server.robot_pool import RobotPool
from data.records import Comparison, Participant
from data.store import Store
from data.study import Study

_GOODBYE_S = 10.0
"""For so long the server waits, when it stops, for what is to be stored [s]; then once more for less."""
_BOARD_S = 2.0


class LiveSessions:
    """The sessions, the workers that run their trials, and the archive that keeps them.

    Parameters
    ----------
    pool : RobotPool
        Finishes the laps.
    workers : int
        How many live workers there are.
    """

    def __init__(self, study: Study, store: Store, pool: RobotPool, workers: int) -> None:
        self._study = study
        self._store = store
        self._pool = pool
        self._crew = Crew(study, workers)
        self._archive = Archive(study, store, pool)
        self._sessions: dict[str, Session] = {}
        self._former: set[Session] = set()
        self._entries: defaultdict[str, asyncio.Lock] = defaultdict(asyncio.Lock)
        self._loop: asyncio.AbstractEventLoop | None = None

    async def start(self) -> None:
        """Start the workers; the server answers while they compile what they need."""
        self._loop = asyncio.get_running_loop()
        await self._crew.start()
        for _ in range(self._pool.size):
            self._pool.submit(warm_up, self._study)

    async def close(self) -> None:
        """End all trials as abandoned, store them, and let the workers go."""
        for session in [*self._sessions.values(), *self._former]:
            session.leave()
        for last in (False, True):
            waiting = [*self._sessions.values(), *self._former]
            if last and waiting:
                LOG.error("%d live sessions are not stored yet; a last attempt", len(waiting))
                self._archive.close()
            deadline = asyncio.get_running_loop().time() + _GOODBYE_S
            while (self._sessions or self._former) and asyncio.get_running_loop().time() < deadline:
                await asyncio.sleep(0.02)
        await self._crew.close()
        self._loop = None

    async def enter(self, participant: Participant, connection: Connection) -> Session | None:
        """The session of a participant who opens a window; None if nothing is open for them."""
        async with self._entries[participant.id]:
            while True:
                present = self._sessions.get(participant.id)
                place = await run_in_threadpool(self._place, participant.id)
                # A session that ended meanwhile has stored its last trial: too late for what was read.
                if present is self._sessions.get(participant.id):
                    break
            if place is None:
                if present is not None:
                    present.dismiss()
                return None
            comparison, standing = place
            if present is not None and not _is_of(present, comparison):
                self._retire(present)
                present = None
            if present is None:
                present = Session(
                    participant,
                    comparison,
                    standing,
                    study=self._study,
                    crew=self._crew,
                    archive=self._archive,
                    clock=self._store.clock,
                    on_settled=self._forget,
                )
                self._sessions[participant.id] = present
            present.attach(connection, comparison, standing)
            return present

    def dismiss(self, participant_id: str) -> None:
        """What a participant had open is not open any more; may be called from any thread."""

        def now() -> None:
            session = self._sessions.get(participant_id)
            if session is not None:
                session.dismiss()

        if self._loop is not None:
            self._loop.call_soon_threadsafe(now)

    def board(self) -> tuple[LiveRow, ...]:
        """Who is at the robot now, by number; from any thread but the event loop's own."""
        loop = self._loop
        if loop is None:
            return ()
        found: concurrent.futures.Future[tuple[LiveRow, ...]] = concurrent.futures.Future()
        loop.call_soon_threadsafe(lambda: found.set_result(self._rows()))
        try:
            return found.result(_BOARD_S)
        except concurrent.futures.TimeoutError:
            return ()

    def _rows(self) -> tuple[LiveRow, ...]:
        rows = [session.row() for session in self._sessions.values() if not session.is_over]
        return tuple(sorted(rows, key=lambda row: row.number))

    def _place(self, participant_id: str) -> tuple[Comparison | None, Standing] | None:
        """What is open for a participant: a comparison, practice (no comparison), or nothing."""
        progress = progress_of(self._store, self._store.participant(participant_id))
        place = progress.place_in(self._study, self._store.clock())
        if place == "comparison" and progress.comparison is not None:
            return progress.comparison, self._archive.read_standing(progress.comparison)
        return (None, nothing_yet()) if place == "practice" else None

    def _retire(self, session: Session) -> None:
        """The participant goes on with something else: what is to be stored still is."""
        self._former.add(session)
        self._sessions.pop(session.participant.id, None)
        session.dismiss()

    def _forget(self, session: Session) -> None:
        """Everything of a session that is over is stored."""
        self._former.discard(session)
        if self._sessions.get(session.participant.id) is session:
            del self._sessions[session.participant.id]


def _is_of(session: Session, comparison: Comparison | None) -> bool:
    """Whether a session belongs to this comparison, or to practice if there is none."""
    mine = session.comparison
    return (mine.id if mine else None) == (comparison.id if comparison else None)
