"""What a live session has to store, one thing after the other, and what it may count on meanwhile."""

import asyncio
from collections.abc import Awaitable, Callable, Mapping

from app.server.access_log import LOG
from app.server.live.archive import Archive, FinishedTrial, Gone, Standing
from app.server.live.channel import Ending
from app.server.live.turn import Turn
from data.errors import ElbowroomError
from data.records import Clock, Comparison, Outcome, Participant, Slot, Switch
from data.study import Study

Tell = Callable[[Mapping[str, object]], None]
"""Sends a message to the window, if there is one."""


class Ledger:
    """The books of a session.

    Numbers of trials and switches are given away here, in the order in which things happen, before they are
    stored: so two trials never get the same, and there are no gaps.

    Parameters
    ----------
    comparison : Comparison or None
        None for practice.
    standing : Standing
        What is stored of the comparison.
    on_gone, on_idle : callable
        Called when the participant has withdrawn, and when everything is stored.

    Attributes
    ----------
    slot : Slot or None
        Which was open last.
    laps : dict
        Laps of each slot that came to an end by themselves, stored or not yet.
    """

    def __init__(
        self,
        study: Study,
        participant: Participant,
        comparison: Comparison | None,
        standing: Standing,
        *,
        archive: Archive,
        clock: Clock,
        tell: Tell,
        on_gone: Callable[[], None],
        on_idle: Callable[[], None],
    ) -> None:
        self.standing = standing
        self.comparison = comparison
        self.slot = standing.slot
        self.laps = dict(standing.laps)
        self.switches = standing.switches
        self._study = study
        self._participant = participant
        self._numbers = dict(standing.numbers)
        self._practised = 0
        self._archive = archive
        self._clock = clock
        self._tell = tell
        self._on_gone = on_gone
        self._on_idle = on_idle
        self._jobs: set[asyncio.Task[None]] = set()
        self._in_order = asyncio.Lock()

    @property
    def is_idle(self) -> bool:
        """Whether everything is stored."""
        return not self._jobs

    def begin_anew(self, comparison: Comparison, standing: Standing) -> None:
        """The comparison was begun anew: what counts starts from what is stored of it."""
        self.comparison, self.slot, self.laps = comparison, standing.slot, dict(standing.laps)

    def see(self, standing: Standing) -> None:
        """What was read of the store; a trial may have been stored since it was."""
        if sum(standing.numbers.values()) >= sum(self.standing.numbers.values()):
            self.standing = standing

    def note_turn(self, slot: Slot) -> None:
        """The participant turned to a slot."""
        if slot == self.slot:
            return
        self.slot = slot
        if self.comparison is not None:
            self.switches += 1
            switch = Switch(self.comparison.id, self.switches, slot, self._clock())
            self._do(lambda: self._archive.keep_switch(switch, self._participant.id))

    def note_end(self, turn: Turn, ending: Ending | None, outcome: Outcome) -> None:
        """A trial is over."""
        if outcome in ("completed", "stuck"):
            self.laps[turn.slot] += 1
        if self.comparison is None:
            self._practised += outcome == "completed"
            if outcome == "completed" and self._practised == self._study.practice.laps:
                self._do(self._keep_practice)
            return
        number = self._numbers[turn.slot] + 1
        finished = turn.finished(self.comparison, number, ending)
        if finished is not None:
            self._numbers[turn.slot] = number
            self._do(lambda: self._keep_trial(finished))

    async def _keep_trial(self, finished: FinishedTrial) -> None:
        self.standing = await self._archive.keep_trial(finished)
        self._tell({"type": "stored", "exposure": self.standing.told_exposure, "laps": self.standing.laps})

    async def _keep_practice(self) -> None:
        await self._archive.keep_practice(self._participant.id, self._clock())
        self._tell({"type": "practised"})

    def _do(self, job: Callable[[], Awaitable[None]]) -> None:
        """Let the archive work, one thing after the other."""

        async def in_order() -> None:
            async with self._in_order:
                try:
                    await job()
                except Gone:
                    self._on_gone()
                except ElbowroomError as error:
                    LOG.error("live: lost when the server stopped: %s", error)

        task = asyncio.get_running_loop().create_task(in_order())
        self._jobs.add(task)
        task.add_done_callback(self._done)

    def _done(self, task: asyncio.Task[None]) -> None:
        self._jobs.discard(task)
        if not task.cancelled() and task.exception() is not None:
            LOG.error("live: something could not be stored", exc_info=task.exception())
        if self.is_idle:
            self._on_idle()
