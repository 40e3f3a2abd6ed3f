"""A participant's live session: which trial is under way, and what follows from what happens.

It lives in the web process, longer than a websocket: a reload or a dropped socket finds its trial again, at
rest, for `GRACE_S`. All that happens, happens in the event loop; only the archive works elsewhere.

=========  ==================================================================================
phase      meaning
=========  ==================================================================================
idle       no trial: nothing was opened yet, or the participant is at the questions
running    a trial is under way on a worker
pausing    a lap has ended; the next begins by itself
=========  ==================================================================================
"""

import asyncio
import time
from collections.abc import Callable, Mapping
from typing import Literal

from app.participant.progress import may_still_take_part
from app.server.access_log import LOG
from app.server.live.archive import Archive, Standing
from app.server.live.board import LiveRow
from app.server.live.channel import Ending
from app.server.live.connection import ELSEWHERE, MOVED, REFUSED, Connection
from app.server.live.crew import Crew
from app.server.live.ledger import Ledger
from app.server.live.limits import Allowance
from app.server.live.quality import RecentQuality
from app.server.live.turn import Turn
from app.server.live.wire import InputFrame
from data.records import Clock, Comparison, Outcome, Participant, Slot
from data.study import Study

GRACE_S = 30.0
"""For so long a trial waits for a page that is gone [s]."""
PAUSE_S: dict[Outcome, float] = {"completed": 1.5, "stuck": 4.0, "failed": 4.0, "abandoned": 4.0}
"""From a lap's end to the next one's start [s]."""
MOST_KEPT = 2000
"""So many trials and switches of one comparison are kept: nobody makes more by hand."""

_HIRING_S = 0.2
_TRIALS_PER_S, _TRIALS_AT_ONCE = 1.0, 8.0

Phase = Literal["idle", "running", "pausing"]


class Session:
    """One participant's session in one comparison, or in practice.

    Parameters
    ----------
    comparison : Comparison or None
        None for practice.
    standing : Standing
        What is stored of the comparison.
    """

    def __init__(
        self,
        participant: Participant,
        comparison: Comparison | None,
        standing: Standing,
        *,
        study: Study,
        crew: Crew,
        archive: Archive,
        clock: Clock,
        on_settled: Callable[["Session"], None],
    ) -> None:
        self.participant = participant
        self.is_over = False
        self._study = study
        self._crew = crew
        self._clock = clock
        self._on_settled = on_settled
        self._ledger = Ledger(
            study,
            participant,
            comparison,
            standing,
            archive=archive,
            clock=clock,
            tell=self._tell,
            on_gone=self.dismiss,
            on_idle=self._settle,
        )
        self._phase: Phase = "idle"
        self._turn: Turn | None = None
        self._trials = 0
        self._starts = Allowance(_TRIALS_PER_S, _TRIALS_AT_ONCE, time.monotonic, first=_TRIALS_AT_ONCE)
        self._leaving: set[int] = set()
        self._timer: asyncio.TimerHandle | None = None
        self._connection: Connection | None = None
        self._is_followed = False
        self._wants_finish = False
        self._since = clock()
        self._recent = RecentQuality()
        self._last_said: InputFrame | None = None

    @property
    def comparison(self) -> Comparison | None:
        """The comparison; None for practice."""
        return self._ledger.comparison

    # What the keeper of sessions does.

    def attach(self, connection: Connection, comparison: Comparison | None, standing: Standing) -> None:
        """A window opens: it takes over from the one before."""
        if self._connection is not None:
            self._connection.tell({"type": "elsewhere"})
            self._connection.close(ELSEWHERE)
        self._wait_for_nothing()
        self._let_go()
        if comparison is not None and comparison != self.comparison:
            self._give_up_trial()
            self._ledger.begin_anew(comparison, standing)
        self._ledger.see(standing)
        self.is_over = False
        self._connection, self._since = connection, self._clock()
        self._is_followed = self._wants_finish = False
        self._recent, self._last_said = RecentQuality(), None
        connection.tell(
            {
                "type": "welcome",
                "practice": self.comparison is None,
                "slot": self._ledger.slot,
                "exposure": self._ledger.standing.told_exposure,
                "laps": self._ledger.standing.laps,
            }
        )

    def detach(self, connection: Connection) -> None:
        """A window is gone; if it was the newest, its trial waits for the next one."""
        if connection is not self._connection:
            return
        self._connection, self._since = None, self._clock()
        self._is_followed = False
        self._wait_for_nothing()
        self._let_go()
        self._timer = asyncio.get_running_loop().call_later(GRACE_S, self.leave)

    def leave(self) -> None:
        """Nobody is there any more: end what is under way, and keep it."""
        self._wait_for_nothing()
        self._give_up_trial()
        self.is_over = True
        self._settle()

    def dismiss(self) -> None:
        """The comparison is not open any more: tell the window to look where it is, and end."""
        if self._connection is not None:
            self._connection.tell({"type": "moved"})
            self._connection.close(MOVED)
        self.leave()

    # What the participant does.

    def open(self, slot: Slot) -> None:
        """Turn to a slot: its trial goes on, or one begins."""
        if self.comparison is None and slot != "A":
            self._refuse()
            return
        self._wait_for_nothing()
        self._wants_finish = False
        self._ledger.note_turn(slot)
        turn = self._turn
        if turn is not None and turn.slot == slot:
            self._announce(turn, is_resumed=True)
            return
        self._give_up_trial()
        self._begin(slot)

    def restart(self) -> None:
        """Begin the lap anew."""
        slot = self._ledger.slot
        if slot is None or not self._is_followed or self._phase == "idle":
            return
        self._wait_for_nothing()
        self._give_up_trial()
        self._begin(slot)

    def finish(self) -> None:
        """Leave for the questions: `finished` is told when everything is stored."""
        self._wait_for_nothing()
        self._give_up_trial()
        self._wants_finish = True
        self._settle()

    def take_input(self, said: InputFrame, frame: bytes) -> None:
        """Pass on what the hand does."""
        self._recent.note(said, time.monotonic())
        self._last_said = said
        turn = self._turn
        if turn is not None and turn.handle is not None and self._is_followed:
            turn.handle.send_input(frame)
            turn.note(said, self._clock)

    # What happens to a trial.

    def on_state(self, turn: Turn, state: bytes, ticks: int, skipped: int) -> None:
        """The newest state of a trial."""
        turn.state, turn.ticks, turn.skipped = state, ticks, skipped
        if turn is self._turn and self._is_followed and self._connection is not None:
            self._connection.show(state)

    def on_strokes(self, turn: Turn, points: bytes) -> None:
        """New points of a trial's strokes."""
        turn.strokes.add(points)
        if turn is self._turn and self._is_followed and self._connection is not None:
            self._connection.paint()

    def on_over(self, turn: Turn, ending: Ending | None) -> None:
        """A trial is over, or gone with its worker."""
        self._leaving.discard(turn.trial)
        outcome = turn.outcome(ending)
        if turn is self._turn:
            self._turn, self._phase = None, "idle"
            self._show_end(turn, outcome)
        self._ledger.note_end(turn, ending, outcome)
        self._settle()

    def _begin(self, slot: Slot) -> None:
        """Start a trial, now or as soon as it can be had."""
        if self._ledger.standing.trials + self._ledger.switches > MOST_KEPT:
            self._refuse()
            return
        study, comparison = self._study, self.comparison
        if not may_still_take_part(study, self.participant, self._clock()):
            self.dismiss()
            return
        mode = study.practice_mode if comparison is None else comparison.mode_of(slot)
        self._phase = "pausing"
        if not self._crew.is_ready:
            self._later(_HIRING_S, slot)
            return
        if not self._starts.take():
            self._later(1.0 / _TRIALS_PER_S, slot)
            return
        self._trials += 1
        turn = Turn(slot, 1 + self._ledger.laps[slot], self._trials)
        turn.handle = self._crew.begin(
            _TurnFollower(self, turn),
            trial=turn.trial,
            mode=mode,
            lap=turn.lap,
            is_practice=comparison is None,
        )
        if turn.handle is None:
            self._later(_HIRING_S, slot)
            return
        self._turn, self._phase = turn, "running"
        self._announce(turn, is_resumed=False)

    def _announce(self, turn: Turn, *, is_resumed: bool) -> None:
        if self._connection is None:
            return
        self._is_followed = True
        self._connection.tell(
            {"type": "trial", "slot": turn.slot, "trial": turn.trial, "lap": turn.lap, "resumed": is_resumed}
        )
        self._connection.follow(turn.strokes)
        if turn.state is not None:
            self._connection.show(turn.state)
        self._connection.paint()

    def _show_end(self, turn: Turn, outcome: Outcome) -> None:
        """Tell the window how a lap ended; the next one begins by itself."""
        if self._connection is None or not self._is_followed:
            return
        self._connection.flush()
        self._connection.tell(
            {
                "type": "ended",
                "slot": turn.slot,
                "trial": turn.trial,
                "outcome": outcome if outcome in ("completed", "stuck") else "stopped",
                "next_in_s": PAUSE_S[outcome],
            }
        )
        self._phase = "pausing"
        self._later(PAUSE_S[outcome], turn.slot)

    def _give_up_trial(self) -> None:
        turn, self._turn, self._phase = self._turn, None, "idle"
        if turn is not None and turn.handle is not None:
            self._leaving.add(turn.trial)
            turn.handle.end()

    def _let_go(self) -> None:
        """Take the hand off the robot."""
        if self._turn is not None and self._turn.handle is not None:
            self._turn.handle.release()

    def _later(self, pause_s: float, slot: Slot) -> None:
        self._timer = asyncio.get_running_loop().call_later(pause_s, self._begin, slot)

    def _wait_for_nothing(self) -> None:
        """No next trial begins by itself, and nobody is waited for."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if self._phase == "pausing":
            self._phase = "idle"

    def _refuse(self) -> None:
        LOG.error("live: closed, since nobody does that by hand")
        if self._connection is not None:
            self._connection.close(REFUSED)

    def _tell(self, message: Mapping[str, object]) -> None:
        """Send a message to the window, if there is one."""
        if self._connection is not None:
            self._connection.tell(message)

    def _settle(self) -> None:
        """See whether everything is stored that there was to store."""
        if self._leaving or not self._ledger.is_idle:
            return
        if self._wants_finish and self._connection is not None:
            self._wants_finish = False
            self._tell({"type": "finished", "exposure": self._ledger.standing.told_exposure})
        if self.is_over:
            self._on_settled(self)

    def row(self) -> LiveRow:
        """What the console shows."""
        now, turn, standing = time.monotonic(), self._turn, self._ledger.standing
        latency = self._recent.latency(now)
        return LiveRow(
            participant=self.participant.id,
            number=self.participant.number,
            comparison=self.comparison.position if self.comparison else None,
            slot=self._ledger.slot,
            lap=turn.lap if turn else 0,
            is_connected=self._connection is not None,
            since=self._since,
            device=self._last_said.device if self._last_said else None,
            latency_median_ms=latency.median_ms if latency else None,
            latency_p95_ms=latency.p95_ms if latency else None,
            frame_rate_hz=self._recent.frame_rate_hz(now),
            skipped_share=turn.skipped_share if turn else 0.0,
            trials=standing.trials,
            stuck=standing.stuck,
        )


class _TurnFollower:
    """Tells a session how one of its trials goes."""

    def __init__(self, session: Session, turn: Turn) -> None:
        self._session = session
        self._turn = turn

    def on_state(self, state: bytes, ticks: int, skipped: int) -> None:
        self._session.on_state(self._turn, state, ticks, skipped)

    def on_strokes(self, points: bytes) -> None:
        self._session.on_strokes(self._turn, points)

    def on_ending(self, ending: Ending) -> None:
        self._session.on_over(self._turn, ending)

    def on_lost(self) -> None:
        self._session.on_over(self._turn, None)
