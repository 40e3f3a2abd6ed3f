"""What somebody who guides the robot sees on the screen, and how they hold it."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field

from playwright.sync_api import Page, WebSocket

from app.server.live.wire import StateFrame, unpack_state
from data.study import Maze
from tests.conftest import PATIENCE_S

LOOK_MS = 20
LOST_S = 3.0
"""A hand that the robot doesn't follow for so long takes it anew."""


@dataclass
class Scene:
    """What a person sees on the screen, read from the frames that the page receives."""

    page: Page
    maze: Maze
    state: StateFrame | None = None
    times_s: dict[int, float] = field(default_factory=dict)
    """The clock of every trial: how long the robot was in hand in it."""

    def __post_init__(self) -> None:
        self.page.on("websocket", self._listen)

    def _listen(self, socket: WebSocket) -> None:
        def keep(frame: str | bytes) -> None:
            if isinstance(frame, bytes) and frame[0] == 2:
                self.state = state = unpack_state(frame)
                self.times_s[state.trial] = state.view.time_s

        if socket.url.endswith("/live"):
            socket.on("framereceived", keep)

    @property
    def trial(self) -> int:
        """The trial that was seen last; 0 before the first."""
        return self.state.trial if self.state else 0

    def until_trial(self, after: int) -> StateFrame:
        """Wait for the first state of a trial with a higher number."""
        end = time.monotonic() + PATIENCE_S
        while self.state is None or self.state.trial <= after or self.state.has_ended:
            assert time.monotonic() < end, "no trial began"
            self.page.wait_for_timeout(LOOK_MS)
        return self.state

    def at(self, y: float, z: float) -> tuple[float, float]:
        """Where a point of the wall is on the screen [px] (``app/stage/modules/frame.js``)."""
        box = self.page.get_by_label("Wall", exact=True).bounding_box()
        assert box is not None
        maze = self.maze
        across = maze.left_y_m - maze.right_y_m + 0.365
        up = maze.top_z_m - maze.bottom_z_m + 0.165
        scale = min(box["width"] / across, box["height"] / up)
        return (
            box["x"] + box["width"] / 2 - (y - (maze.left_y_m + maze.right_y_m) / 2) * scale,
            box["y"] + box["height"] / 2 - (z - (maze.top_z_m + maze.bottom_z_m) / 2) * scale,
        )


class Hold:
    """A hand on the robot. It looks whether the robot follows; if not, it lets go and takes it anew.

    What is pressed before a trial has begun doesn't count, and a line that was lost lets go: people notice,
    and press again.

    Parameters
    ----------
    take, let_go : callable
        Press what takes the robot, and release it. It is taken at once.
    """

    def __init__(self, scene: Scene, take: Callable[[], object], let_go: Callable[[], object]) -> None:
        self._scene = scene
        self._take, self._let_go = take, let_go
        self._seen = scene.state
        self._followed_at = time.monotonic()
        self.has_followed = False
        self.passed_s = 0.0
        """For how long the robot was in this hand, by its own clock: a loaded machine holds it up."""
        take()

    def look(self) -> None:
        """See how the robot does; take it anew if it hasn't followed for a while."""
        before, state, now = self._seen, self._scene.state, time.monotonic()
        self._seen = state
        if state is not None and state is not before and state.view.is_enabled:
            self._followed_at, self.has_followed = now, True
            if before is not None and before.trial == state.trial:
                self.passed_s += max(state.view.time_s - before.view.time_s, 0.0)
        elif now - self._followed_at > LOST_S:
            self._let_go()
            self._take()
            self._followed_at = now

    def keep(self, seconds: float, move: Callable[[float], object] = lambda share: None) -> None:
        """Hold on until the robot's clock has gone on for so long.

        Parameters
        ----------
        move : callable
            Moves the hand; called with the share of the time that is over, at last with 1.
        """
        begun_s, end = self.passed_s, time.monotonic() + PATIENCE_S
        while not self.has_followed or self.passed_s - begun_s < seconds:
            assert time.monotonic() < end, "the robot does not follow the hand"
            self._scene.page.wait_for_timeout(LOOK_MS)
            self.look()
            move(min((self.passed_s - begun_s) / seconds, 1.0) if seconds else 1.0)
