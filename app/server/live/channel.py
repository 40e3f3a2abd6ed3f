"""What the web process and a live worker say to each other over their socket.

Each message is its length and kind, then its content. Neither side ever waits for the other: both write
what the socket takes and keep the rest.
"""

import pickle
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from sim_trials.trace import LapInputs

_T = TypeVar("_T")

HEADER = struct.Struct("<IB")
RUN = struct.Struct("<I")
PROGRESS = struct.Struct("<III")
"""Before a state: the run, how many control ticks it took and how many were skipped."""
SOCKET_BUFFER = 1 << 20
"""Room for what a process that is held up for seconds has not read yet [bytes]."""


class Order(IntEnum):
    """From the web process to a worker."""

    BEGIN = 1
    """`Beginning`, pickled."""
    INPUT = 2
    """A run and an input frame as it came."""
    RELEASE = 3
    """A run: nobody holds the robot any more."""
    END = 4
    """A run: give the lap up."""


class Tidings(IntEnum):
    """From a worker to the web process."""

    READY = 1
    """Everything is compiled."""
    STATE = 2
    """`PROGRESS` and a state frame, ready to be sent."""
    STROKES = 3
    """A run and new points of its strokes (``wire.POINT``)."""
    ENDED = 4
    """`Ending`, pickled."""
    FAILED = 5
    """A run and why it cannot go on."""


@dataclass(frozen=True)
class Beginning:
    """A trial for a worker.

    Attributes
    ----------
    run : int
        Names the trial between the processes.
    trial : int
        Names it between server and browser.
    """

    run: int
    trial: int
    mode: str
    lap: int
    is_practice: bool


@dataclass(frozen=True)
class Ending:
    """A trial that is over: its inputs are all that is needed to run it again.

    Attributes
    ----------
    ticks, skipped : int
        Control ticks it took, and further ones for which there was no time.
    """

    run: int
    ticks: int
    skipped: int
    inputs: "LapInputs"


def message(kind: IntEnum, content: bytes) -> bytes:
    """The bytes of a message."""
    return HEADER.pack(len(content), kind) + content


def pickled(kind: IntEnum, content: Beginning | Ending) -> bytes:
    """The bytes of a message that holds an object."""
    return message(kind, pickle.dumps(content, pickle.HIGHEST_PROTOCOL))


def unpickled(content: bytes, kind: type[_T]) -> _T:
    """The object in a message: from a process of our own, over a socket that nobody else has."""
    found = pickle.loads(content)
    assert isinstance(found, kind)
    return found


class Inbox:
    """Puts messages together from the pieces in which they arrive."""

    def __init__(self) -> None:
        self._rest = b""

    def take(self, piece: bytes) -> Iterator[tuple[int, bytes]]:
        """Kind and content of each message that is complete with this piece."""
        content = self._rest + piece if self._rest else piece
        at, size = 0, len(content)
        while size - at >= HEADER.size:
            length, kind = HEADER.unpack_from(content, at)
            end = at + HEADER.size + length
            if end > size:
                break
            yield kind, content[at + HEADER.size : end]
            at = end
        self._rest = content[at:]
