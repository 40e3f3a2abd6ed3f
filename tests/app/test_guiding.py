"""A person guides the real robot in a real browser: by mouse, keyboard and touch, into the store."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import CDPSession, Locator, Page, expect

from app.server.visitors import PARTICIPANT_COOKIE
from data.records import Comparison, Device, Trial
from data.study import Maze

from .conftest import GUIDED_STUDY, SECRETS, Server, serving

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
TIMEOUT_MS = 30_000
STEP_S = 0.02
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
    maze: Maze

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
        expect(self.page.get_by_text(text, exact=True).first).to_be_visible(timeout=TIMEOUT_MS)

    def turn_to(self, slot: str) -> None:
        self.page.get_by_role("radio", name=f"Method {slot}", exact=True).check()
        self.is_ready(slot)

    def is_ready(self, slot: str) -> None:
        status = self.page.locator(f".option.{slot.lower()} .status")
        expect(status).to_have_text("in your hand now", timeout=TIMEOUT_MS)

    def at(self, right_m: float, down_m: float = 0.0) -> tuple[float, float]:
        """Where a point of the wall is on the screen, seen from the start."""
        box = self.wall.bounding_box()
        assert box is not None
        maze = self.maze
        width, height = maze.left_y_m - maze.right_y_m, maze.top_z_m - maze.bottom_z_m
        scale = min(box["width"] / (width + 0.365), box["height"] / (height + 0.165))
        x = box["x"] + box["width"] / 2 + (right_m - width / 2) * scale
        y = box["y"] + box["height"] / 2 + (down_m - height / 2) * scale
        return x, y


@pytest.fixture(scope="module")
def guided(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server on which the robot is guided."""
    with serving(tmp_path_factory.mktemp("guided"), GUIDED_STUDY) as running:
        yield running


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
    context.set_default_timeout(TIMEOUT_MS)
    errors: list[str] = []
    page = context.new_page()
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(server.base)
    study = server.store.studies()[0].study
    maze = (study.practice_study if practises else study).maze
    guide = Guide(page, server, f"{participant.id}.c1", maze)
    expect(guide.wall).to_be_visible(timeout=TIMEOUT_MS)
    if not practises:
        guide.is_ready("A")
    yield guide
    context.close()
    assert errors == []


def steps(seconds: float) -> Iterator[float]:
    """Shares of a movement that takes so long."""
    begun = time.monotonic()
    while (share := (time.monotonic() - begun) / seconds) < 1:
        yield share
        time.sleep(STEP_S)
    yield 1.0


def by_mouse(guide: Guide) -> None:
    mouse = guide.page.mouse
    mouse.move(*guide.at(0))
    mouse.down()
    guide.page.keyboard.down(" ")
    for share in steps(1.5):
        mouse.move(*guide.at(0.12 * share))
    mouse.wheel(0, 200)
    guide.says("Robot moves")
    guide.says("Spray on")
    guide.page.keyboard.up(" ")
    mouse.up()
    guide.says("Robot waits")


def by_keyboard(guide: Guide) -> None:
    keyboard = guide.page.keyboard
    guide.wall.focus()
    keyboard.press(" ")
    keyboard.down("ArrowRight")
    guide.says("Robot moves")
    guide.says("Spray on")
    time.sleep(1.2)
    keyboard.up("ArrowRight")
    keyboard.press("Escape")
    guide.says("Robot waits")


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
    touch("touchStart", 0, guide.at(0))
    touch("touchStart", 1, on_spray)
    touch("touchEnd", 1, on_spray)
    expect(spray).to_have_attribute("aria-pressed", "true")
    for share in steps(1.2):
        touch("touchMove", 0, guide.at(0.12 * share))
    guide.says("Robot moves")
    guide.says("Spray on")
    touch("touchStart", 1, right_of_pad)
    expect(guide.page.locator(".nozzle .value")).not_to_have_text("Straight")
    touch("touchEnd", 1, right_of_pad)
    touch("touchEnd", 0, guide.at(0.12))
    guide.says("Robot waits")
    spray.tap()
    expect(spray).to_have_attribute("aria-pressed", "false")


WAYS: dict[Device, Callable[[Guide], None]] = {"mouse": by_mouse, "keyboard": by_keyboard, "touch": by_touch}


@pytest.mark.parametrize("device", WAYS)
def test_a_comparison_is_guided_answered_and_stored(
    chromium: "Browser", guided: Server, device: Device
) -> None:
    with guiding(chromium, guided, device) as guide:
        page = guide.page
        answer = page.get_by_role("button", name="Answer the questions")
        expect(answer).to_have_attribute("aria-disabled", "true")
        assert page.evaluate("scrollY + document.scrollingElement.scrollHeight - innerHeight") <= 0
        WAYS[device](guide)
        if device == "keyboard":
            guide.wall.press("2")
            guide.is_ready("B")
        else:
            guide.turn_to("B")
        WAYS[device](guide)
        expect(answer).to_have_attribute("aria-disabled", "false")
        answer.click()
        expect(page.get_by_role("button", name="Submit answers")).to_be_visible(timeout=TIMEOUT_MS)
        expect(guide.wall).to_have_count(0, timeout=TIMEOUT_MS)
        for group in page.get_by_role("radiogroup").all():
            group.get_by_role("radio").first.check()
        page.get_by_role("button", name="Submit answers").click()
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible(timeout=TIMEOUT_MS)
        assert guide.comparison.answered_at is not None
        assert {trial.slot for trial in guide.trials} == {"A", "B"}
        for trial in guide.trials:
            assert (trial.source, trial.outcome) == ("guided", "abandoned")
            assert trial.duration_s >= 1.0
            assert trial.metrics["latency_samples"] > 10
            assert 1.0 <= trial.metrics["latency_median_ms"] < 1000.0
            assert trial.recording is not None
        switches = guided.store.switches(guide.comparison_id)
        assert [switch.slot for switch in switches] == ["A", "B"]


def test_a_reload_and_a_dropped_line_go_on_in_the_same_lap(chromium: "Browser", guided: Server) -> None:
    with guiding(chromium, guided, "mouse") as guide:
        by_mouse(guide)
        time_chip = guide.page.locator(".chip .time")
        expect(time_chip).not_to_have_text("0:00")
        before = time_chip.inner_text()
        guide.page.evaluate("window.sockets.at(-1).close()")
        guide.page.wait_for_function("window.sockets.length === 2")
        guide.is_ready("A")
        expect(time_chip).not_to_have_text("0:00")
        guide.page.reload()
        expect(time_chip).not_to_have_text("0:00", timeout=TIMEOUT_MS)
        assert time_chip.inner_text() >= before
        assert painted(guide.page) > 100
        assert guide.trials == ()


def painted(page: Page) -> int:
    """Pixels of the wall in the colour of the path."""
    return int(
        page.evaluate(
            """() => {
            const find = (root) => {
              for (const e of root.querySelectorAll('*')) {
                if (e.matches('.wall canvas')) return e;
                const inside = e.shadowRoot && find(e.shadowRoot);
                if (inside) return inside;
              }
              return null;
            };
            const c = find(document);
            const { data } = c.getContext('2d').getImageData(0, 0, c.width, c.height);
            let count = 0;
            for (let i = 0; i < data.length; i += 4) if (data[i] > 225 && data[i] - data[i + 2] > 25) count++;
            return count;
            }"""
        )
    )


def test_a_newer_window_takes_over_and_the_older_one_can_go_on(chromium: "Browser", guided: Server) -> None:
    with guiding(chromium, guided, "mouse") as guide:
        second = guide.page.context.new_page()
        second.goto(guided.base)
        guide.says("The robot is in another window now")
        guide.page.get_by_role("button", name="Go on here").click()
        guide.is_ready("A")
        expect(second.get_by_role("button", name="Go on here")).to_be_visible(timeout=TIMEOUT_MS)
        guide.page.bring_to_front()
        by_mouse(guide)


def test_practice_ticks_itself_off_and_leads_on_once_it_is_stored(
    chromium: "Browser", guided: Server
) -> None:
    with guiding(chromium, guided, "mouse", practises=True) as guide:
        page, mouse, maze = guide.page, guide.page.mouse, guide.maze
        guide.says("Press the left mouse button on the wall and keep it down")
        expect(page.get_by_role("radiogroup")).to_have_count(0)
        width, height = maze.left_y_m - maze.right_y_m, maze.top_z_m - maze.bottom_z_m
        corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height), (0.0, 0.0)]
        mouse.move(*guide.at(0))
        mouse.down()
        page.keyboard.down(" ")
        for (x0, y0), (x1, y1) in pairwise(corners):
            for share in steps(2.5):
                mouse.move(*guide.at(x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
            time.sleep(0.8)
        for name in ("Take the nozzle", "Move it", "Spray", "Finish a lap"):
            expect(page.get_by_role("listitem").filter(has_text=name)).to_have_class("done")
        expect(page.get_by_role("button", name="Continue")).to_be_focused(timeout=TIMEOUT_MS)
        who = guide.comparison_id.rpartition(".")[0]
        assert guided.store.participant(who).practised_at is not None
        page.keyboard.up(" ")
        mouse.up()
        page.get_by_role("button", name="Continue").click()
        expect(guide.wall).to_have_count(0, timeout=TIMEOUT_MS)


@pytest.mark.parametrize("event", ["blur", "pointercancel", "close"])
def test_whatever_takes_the_hand_away_stops_the_robot(
    chromium: "Browser", guided: Server, event: str
) -> None:
    with guiding(chromium, guided, "mouse") as guide:
        guide.page.mouse.move(*guide.at(0.05))
        guide.page.mouse.down()
        guide.says("Robot moves")
        if event == "blur":
            guide.page.evaluate("window.dispatchEvent(new Event('blur'))")
        elif event == "close":
            guide.page.evaluate("window.sockets.at(-1).close()")
        else:
            guide.wall.dispatch_event("pointercancel", {"pointerId": 1})
        guide.says("Robot waits")
        guide.page.mouse.move(*guide.at(0.1))
        time.sleep(0.3)
        guide.says("Robot waits")
        guide.page.mouse.up()
        guide.is_ready("A")
        guide.page.mouse.down()
        guide.says("Robot moves")


def test_nothing_the_page_receives_says_more_than_a_and_b(chromium: "Browser", guided: Server) -> None:
    with guiding(chromium, guided, "mouse") as guide:
        guide.page.evaluate(
            """() => {
            window.heard = [];
            window.sockets.at(-1).addEventListener('message', ({ data }) => {
              const text = (bytes) => String.fromCharCode(...new Uint8Array(bytes));
              window.heard.push(typeof data === 'string' ? data : text(data));
            });
            }"""
        )
        by_mouse(guide)
        guide.turn_to("B")
        told = guide.page.evaluate("window.heard")
        assert len(told) > 50
        assert [secret for secret in SECRETS if secret.lower() in json.dumps(told).lower()] == []
