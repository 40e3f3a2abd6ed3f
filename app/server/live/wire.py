"""The binary frames between a participant's browser and the server, little-endian.

Up go inputs: where the hand is and which triggers it pulls. Down come states, of which only the newest
matters, and strokes, which are numbered and all arrive. Nothing says under which method the robot moves.
"""

import math
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING

from data.records import Device

if TYPE_CHECKING:
    from sim_trials.live import LiveView

VERSION = 1
INPUT_KIND, STATE_KIND, STROKES_KIND = 1, 2, 3

INPUT = struct.Struct("<BBBBIfffffId")
"""Kind, version, buttons, device, number; hand y, z [m], tilt y, z [deg], latency [ms], frames, clock [ms]"""
STATE = struct.Struct("<BBBBIII10f6f")
"""Kind, version, flags, 0, trial, frame, input; time [s], cursor y, z [m], tilt y, z [deg], hand y, z [m],
pull, speed [m/s], share; joint angles [rad]."""
STROKES = struct.Struct("<BBHII")
"""Kind, version, number of points, trial, index of the first point; then so many of `POINT`."""
POINT = struct.Struct("<4f")
"""Cursor y, z [m], its speed [m/s], and 1 if the stroke ends after this point."""

_TIME = struct.Struct("<f")

ENABLE_BUTTON, BLAST_BUTTON = 1, 2
ENABLED, SPRAYING, RESTING, ENDED = 1, 2, 4, 8
DEVICES: tuple[Device, ...] = ("mouse", "keyboard", "touch", "gamepad")
"""What a hand is moved with, by its number on the wire."""

FARTHEST_HAND_M = 5.0
STEEPEST_TILT_DEG = 90.0
LONGEST_LATENCY_MS = 60_000.0
MOST_POINTS = 4000
"""The most points that one frame of strokes carries: 64 kB."""


class BadFrame(ValueError):
    """A frame that no page of ours would send."""


@dataclass(frozen=True, slots=True)
class InputFrame:
    """What the browser said last.

    Attributes
    ----------
    seq : int
        Grows from frame to frame of one connection, from 1.
    hand_y_m, hand_z_m : float
        Where on the wall the hand wants the cursor; base frame, y to the left, z up.
    tilt_y_deg, tilt_z_deg : float
        Lean that the hand wants: its components along base y and z.
    latency_ms : float
        One measurement of the time from an input to the picture that shows it; -1 if there is none.
    frames : int
        Pictures drawn since the page was opened.
    client_ms : float
        The page's clock.
    """

    buttons: int
    device: Device
    seq: int
    hand_y_m: float
    hand_z_m: float
    tilt_y_deg: float
    tilt_z_deg: float
    latency_ms: float
    frames: int
    client_ms: float

    @property
    def is_enabled(self) -> bool:
        """Whether the trigger that lets the robot move is pulled."""
        return self.buttons & ENABLE_BUTTON != 0

    @property
    def is_blasting(self) -> bool:
        """Whether the trigger of the nozzle is pulled."""
        return self.buttons & BLAST_BUTTON != 0


def pack_input(frame: InputFrame) -> bytes:
    """The bytes of an input, as the browser makes them."""
    return INPUT.pack(
        INPUT_KIND,
        VERSION,
        frame.buttons,
        DEVICES.index(frame.device),
        frame.seq,
        frame.hand_y_m,
        frame.hand_z_m,
        frame.tilt_y_deg,
        frame.tilt_z_deg,
        frame.latency_ms,
        frame.frames,
        frame.client_ms,
    )


def unpack_input(content: bytes) -> InputFrame:
    """An input from its bytes; everything in it is checked.

    Raises
    ------
    BadFrame
        If the size, kind or version is another one, or a number is none, or out of its range.
    """
    if len(content) != INPUT.size:
        raise BadFrame("size")
    kind, version, buttons, device, seq, y, z, tilt_y, tilt_z, latency, frames, clock = INPUT.unpack(content)
    if kind != INPUT_KIND or version != VERSION:
        raise BadFrame("kind or version")
    if buttons > (ENABLE_BUTTON | BLAST_BUTTON) or device >= len(DEVICES) or seq == 0:
        raise BadFrame("buttons, device or number")
    # A comparison with NaN is false, so each claim is of the good.
    if not (abs(y) <= FARTHEST_HAND_M and abs(z) <= FARTHEST_HAND_M):
        raise BadFrame("hand")
    if not (abs(tilt_y) <= STEEPEST_TILT_DEG and abs(tilt_z) <= STEEPEST_TILT_DEG):
        raise BadFrame("tilt")
    if not (latency == -1.0 or 0.0 <= latency <= LONGEST_LATENCY_MS):
        raise BadFrame("latency")
    if not (clock >= 0.0 and math.isfinite(clock)):
        raise BadFrame("clock")
    return InputFrame(buttons, DEVICES[device], seq, y, z, tilt_y, tilt_z, latency, frames, clock)


@dataclass(frozen=True, slots=True)
class StateFrame:
    """What the browser draws.

    Attributes
    ----------
    trial : int
        Which trial of the session it is.
    frame : int
        Grows from state to state of one trial.
    input_seq : int
        The last input that this state was computed with; 0 for none.
    """

    trial: int
    frame: int
    input_seq: int
    has_ended: bool
    view: "LiveView"


def pack_state(frame: StateFrame) -> bytes:
    """The bytes of a state."""
    view = frame.view
    flags = (
        (ENABLED if view.is_enabled else 0)
        | (SPRAYING if view.is_spraying else 0)
        | (RESTING if view.is_resting else 0)
        | (ENDED if frame.has_ended else 0)
    )
    return STATE.pack(
        STATE_KIND,
        VERSION,
        flags,
        0,
        frame.trial,
        frame.frame,
        frame.input_seq,
        view.time_s,
        view.cursor_y_m,
        view.cursor_z_m,
        view.tilt_y_deg,
        view.tilt_z_deg,
        view.hand_y_m,
        view.hand_z_m,
        view.pull,
        view.speed_m_s,
        view.share,
        *view.q_rad,
    )


def unpack_state(content: bytes) -> StateFrame:
    """A state from its bytes, as the browser reads them.

    Raises
    ------
    BadFrame
        If it is none.
    """
    from sim_trials.live import LiveView

    if len(content) != STATE.size or content[0] != STATE_KIND or content[1] != VERSION:
        raise BadFrame("no state")
    _, _, flags, _, trial, frame, input_seq, *numbers = STATE.unpack(content)
    triggers = bool(flags & ENABLED), bool(flags & SPRAYING), bool(flags & RESTING)
    view = LiveView._make((*numbers[:10], tuple(numbers[10:]), *triggers))
    return StateFrame(trial, frame, input_seq, bool(flags & ENDED), view)


def state_time_s(content: bytes) -> float:
    """The trial's clock in a state's bytes [s]."""
    time_s: float = _TIME.unpack_from(content, 16)[0]
    return time_s


def pack_strokes(trial: int, first: int, points: bytes) -> bytes:
    """The bytes of strokes, whose points are packed already (`POINT`), at most `MOST_POINTS`."""
    return STROKES.pack(STROKES_KIND, VERSION, len(points) // POINT.size, trial, first) + points
