"""One trial on its worker: the newest input goes in with each tick, states and strokes come out."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from app.server.live import channel, wire
from app.server.live.channel import Beginning, Ending, Tidings
from app.server.live.wire import StateFrame

if TYPE_CHECKING:
    from sim_trials.live import HandInput, LiveTrial, LiveView

RELEASE_AFTER_S = 0.25
"""A hand that was not heard of for so long has let go [s]."""

_MOVING_TICKS, _RESTING_TICKS, _STROKE_TICKS, _POINT_TICKS = 5, 62, 5, 2
"""Without fresh inputs a state is sent 25 times a second while the robot moves, else twice; strokes are sent
25 times a second and have a point every 16 ms."""


class LiveRun:
    """One trial on its worker."""

    def __init__(self, beginning: Beginning, trial: "LiveTrial") -> None:
        self.beginning = beginning
        self.trial = trial
        self.skipped = 0
        self._seen = b""
        self._seen_at = -RELEASE_AFTER_S
        self._view = trial.view
        self._hand = _at_rest(self._view)
        self._seq = 0
        self._is_fresh = False
        self._since_state = 0
        self._frame = 0
        self._is_painting = False
        self._points = bytearray()

    def take_input(self, frame: bytes, now: float) -> None:
        """Note what the browser said; the next tick uses it."""
        self._seen = frame
        self._seen_at = now
        self._is_fresh = True

    def release(self) -> None:
        """Nobody holds the robot; inputs are numbered from 1 again."""
        self._seen, self._seen_at = b"", -RELEASE_AFTER_S
        self._is_fresh, self._seq = False, 0
        self._hand = _let_go(self._hand)

    def tick(self, now: float) -> None:
        """Take one control tick."""
        self._hold(now)
        self.trial.advance(self._hand)
        self._view = self.trial.view
        self._since_state += 1
        self._paint()

    def skip(self, ticks: int) -> None:
        """Count ticks for which there was no time; a robot at rest misses nothing."""
        if not self.trial.is_resting:
            self.skipped += ticks

    def news(self, tick: int, *, may_leave_out: bool) -> Iterator[bytes]:
        """What the web process should know after a tick.

        Parameters
        ----------
        tick : int
            Counts the worker's ticks: trials send their strokes in turn.
        may_leave_out : bool
            Whether the state may be left out, since the web process doesn't keep up.
        """
        run = self.beginning.run
        has_ended = self.trial.ending is not None
        if self._points and (has_ended or (tick + run) % _STROKE_TICKS == 0):
            yield channel.message(Tidings.STROKES, channel.RUN.pack(run) + self._points)
            self._points.clear()
        pause = _RESTING_TICKS if self.trial.is_resting else _MOVING_TICKS
        is_due = self._is_fresh or self._since_state >= pause
        if has_ended or (is_due and not may_leave_out):
            self._is_fresh, self._since_state = False, 0
            yield self._state(has_ended)
        if has_ended:
            ending = Ending(run, self.trial.ticks, self.skipped, self.trial.inputs)
            yield channel.pickled(Tidings.ENDED, ending)

    def _hold(self, now: float) -> None:
        """The hand as the browser said last, or let go if that was too long ago."""
        if self._is_fresh:
            said = wire.unpack_input(self._seen)
            self._seq = said.seq
            self._hand = _hand_of(said)
        elif now - self._seen_at > RELEASE_AFTER_S and self._hand.enable:
            self._hand = _let_go(self._hand)

    def _paint(self) -> None:
        view, has_begun = self._view, not self._is_painting
        lifts = not view.is_spraying or self.trial.ending is not None
        if (self._is_painting and lifts) or (
            not lifts and (has_begun or self.trial.ticks % _POINT_TICKS == 0)
        ):
            self._points += wire.POINT.pack(view.cursor_y_m, view.cursor_z_m, view.speed_m_s, float(lifts))
        self._is_painting = not lifts

    def _state(self, has_ended: bool) -> bytes:
        self._frame += 1
        state = StateFrame(self.beginning.trial, self._frame, self._seq, has_ended, self._view)
        progress = channel.PROGRESS.pack(self.beginning.run, self.trial.ticks, self.skipped)
        return channel.message(Tidings.STATE, progress + wire.pack_state(state))


def _hand_of(said: wire.InputFrame) -> "HandInput":
    from sim_trials.live import HandInput

    return HandInput(
        said.hand_y_m, said.hand_z_m, said.tilt_y_deg, said.tilt_z_deg, said.is_enabled, said.is_blasting
    )


def _let_go(hand: "HandInput") -> "HandInput":
    """The same hand, which holds nothing."""
    from sim_trials.live import HandInput

    return HandInput(hand.y_m, hand.z_m, hand.tilt_y_deg, hand.tilt_z_deg)


def _at_rest(view: "LiveView") -> "HandInput":
    """A hand that has not taken hold yet, where the cursor is."""
    from sim_trials.live import HandInput

    return HandInput(view.cursor_y_m, view.cursor_z_m)
