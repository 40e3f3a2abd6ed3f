"""A page on which somebody guides the robot, by mouse, keyboard or touch."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from playwright.sync_api import CDPSession, Locator, Page, expect

from app.server.visitors import PARTICIPANT_COOKIE
from data.records import Comparison, Device, Trial
from tests.conftest import PATIENCE_S

from .conftest import Server
from .scene import LOOK_MS, Hold, Scene

if TYPE_CHECKING:
    from playwright.sync_api import Browser

HELD_S = 1.0
"""So long each of the ways to guide holds the robot, by its own clock."""
WATCHED_SOCKETS = """
    window.sockets = [];
    window.WebSocket = class extends WebSocket {
      constructor(...given) {
        super(...given);
        if (this.url.endsWith('/live')) window.sockets.push(this);
      }
    };"""


@dataclass(frozen=True)
class Guide:
    """A page on which somebody guides, and where it ends up."""

    page: Page
    server: Server
    comparison_id: str
    scene: Scene

    @property
    def wall(self) -> Locator:
        return self.page.get_by_label("Wall", exact=True)

    @property
    def comparison(self) -> Comparison:
        return self.server.store.comparison(self.comparison_id)

    @property
    def trials(self) -> tuple[Trial, ...]:
        return self.server.store.trials(comparison=self.comparison_id)

    def says(self, text: str) -> None:
        expect(self.page.get_by_text(text, exact=True).first).to_be_visible()

    def turn_to(self, slot: str) -> None:
        self.page.get_by_role("radio", name=f"Method {slot}", exact=True).check()
        self.is_ready(slot)

    def is_ready(self, slot: str) -> None:
        expect(self.page.locator(f".option.{slot.lower()} .status")).to_have_text("in your hand now")

    def at(self, right_m: float, down_m: float = 0.0) -> tuple[float, float]:
        """Where a point of the wall is on the screen, seen from the start."""
        maze = self.scene.maze
        return self.scene.at(maze.left_y_m - right_m, maze.top_z_m - down_m)

    def hold_with_the_mouse(self, right_m: float = 0.0) -> Hold:
        """Take the robot by the mouse, and see that it follows."""
        mouse = self.page.mouse
        mouse.move(*self.at(right_m))
        hold = Hold(self.scene, mouse.down, mouse.up)
        hold.keep(0.0)
        self.says("Robot moves")
        return hold

    def until_trials(self, count: int) -> None:
        """Wait until so many are stored; a new process has to load everything first."""
        end = time.monotonic() + PATIENCE_S
        while len(self.trials) < count and time.monotonic() < end:
            self.page.wait_for_timeout(LOOK_MS)
        assert len(self.trials) == count

    def answer_to_the_end(self) -> None:
        """Answer the questions of the only comparison, until the last page."""
        page = self.page
        answer = page.get_by_role("button", name="Answer the questions")
        expect(answer).to_have_attribute("aria-disabled", "false")
        answer.click()
        submit = page.get_by_role("button", name="Submit answers")
        expect(submit).to_be_visible()
        # The page before has a group of radio buttons, too.
        expect(self.wall).to_have_count(0)
        for group in page.get_by_role("radiogroup").all():
            group.get_by_role("radio").first.check()
        submit.click()
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible()


@contextmanager
def guiding(
    chromium: "Browser", server: Server, device: Device, *, practises: bool = False
) -> Iterator[Guide]:
    """Somebody new, who practises or whose first comparison is open, in a browser of their own."""
    cookie, participant = server.join(starts=not practises)
    server.store.record_device(participant.id, device)
    context = chromium.new_context(has_touch=device == "touch", viewport={"width": 1024, "height": 768})
    context.add_cookies([{"name": PARTICIPANT_COOKIE, "value": cookie, "url": server.base}])
    context.add_init_script(WATCHED_SOCKETS)
    errors: list[str] = []
    page = context.new_page()
    page.on("pageerror", lambda error: errors.append(str(error)))
    study = server.store.studies()[0].study
    guide = Guide(
        page,
        server,
        f"{participant.id}.c1",
        Scene(page, (study.practice_study if practises else study).maze),
    )
    page.goto(server.base)
    expect(guide.wall).to_be_visible()
    if not practises:
        guide.is_ready("A")
    yield guide
    context.close()
    assert errors == []


def by_mouse(guide: Guide) -> None:
    mouse, keyboard = guide.page.mouse, guide.page.keyboard
    hold = guide.hold_with_the_mouse()
    keyboard.down(" ")
    guide.says("Spray on")
    hold.keep(HELD_S, lambda share: mouse.move(*guide.at(0.12 * share)))
    mouse.wheel(0, 200)
    guide.says("Robot moves")
    keyboard.up(" ")
    mouse.up()
    guide.says("Robot waits")


def by_keyboard(guide: Guide) -> None:
    keyboard = guide.page.keyboard

    def take() -> None:
        guide.wall.focus()
        keyboard.down("ArrowRight")

    def let_go() -> None:
        keyboard.up("ArrowRight")
        keyboard.press("Escape")

    hold = Hold(guide.scene, take, let_go)
    hold.keep(0.0)
    guide.says("Robot moves")
    tap_until_it_sprays(guide)
    hold.keep(HELD_S)
    let_go()
    guide.says("Robot waits")


def tap_until_it_sprays(guide: Guide) -> None:
    """Tap Space; once more, if so much time passed between down and up that it was no tap."""
    for _ in range(3):
        guide.page.keyboard.press(" ")
        with suppress(AssertionError):
            expect(guide.page.get_by_text("Spray on", exact=True)).to_be_visible(timeout=5_000)
            return
    raise AssertionError("it does not spray")


def by_touch(guide: Guide) -> None:
    finger: CDPSession = guide.page.context.new_cdp_session(guide.page)

    def touch(kind: str, number: int, point: tuple[float, float]) -> None:
        spot = {"x": point[0], "y": point[1], "id": number}
        finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [spot]})

    pad = guide.page.locator(".pad").bounding_box()
    spray = guide.page.get_by_role("button", name="Spray", exact=True)
    button = spray.bounding_box()
    assert pad is not None
    assert button is not None
    assert min(button["width"], button["height"], pad["width"], pad["height"]) >= 44
    on_spray = (button["x"] + button["width"] / 2, button["y"] + button["height"] / 2)
    right_of_pad = (pad["x"] + 0.9 * pad["width"], pad["y"] + pad["height"] / 2)
    start = guide.at(0)
    hold = Hold(guide.scene, lambda: touch("touchStart", 0, start), lambda: touch("touchEnd", 0, start))
    hold.keep(0.0)
    touch("touchStart", 1, on_spray)
    touch("touchEnd", 1, on_spray)
    expect(spray).to_have_attribute("aria-pressed", "true")
    guide.says("Robot moves")
    guide.says("Spray on")
    hold.keep(HELD_S, lambda share: touch("touchMove", 0, guide.at(0.12 * share)))
    touch("touchStart", 1, right_of_pad)
    expect(guide.page.locator(".nozzle .value")).not_to_have_text("Straight")
    touch("touchEnd", 1, right_of_pad)
    touch("touchEnd", 0, guide.at(0.12))
    guide.says("Robot waits")
    spray.tap()
    expect(spray).to_have_attribute("aria-pressed", "false")


WAYS: dict[Device, Callable[[Guide], None]] = {"mouse": by_mouse, "keyboard": by_keyboard, "touch": by_touch}
