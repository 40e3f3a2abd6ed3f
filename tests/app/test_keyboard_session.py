"""A whole session by the keyboard alone, from consent to the last page."""

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import Locator, Page, expect

from data.study import Study
from sim_trials.scripted_hand import ScriptedHand
from tests.conftest import PATIENCE_S

from .conftest import BACKGROUND, GUIDED_STUDY, serving
from .drawn import until_drawn
from .scene import LOOK_MS, Hold, Scene

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
SIZE = {"width": 1280, "height": 800}
ONE_COMPARISON = GUIDED_STUDY + BACKGROUND


class KeyboardHand:
    """Holds the arrow keys that bring the hand to where the scripted hand would have it."""

    ARROWS = (("ArrowLeft", 1, 0), ("ArrowRight", -1, 0), ("ArrowUp", 0, 1), ("ArrowDown", 0, -1))
    NEAR_M = 0.006

    def __init__(self, scene: Scene, study: Study) -> None:
        self.scene, self.keyboard = scene, scene.page.keyboard
        self.hand = ScriptedHand(study, pace_m_s=0.07)
        self.held: set[str] = set()

    def guide(self, seconds: float = math.inf) -> None:
        """Guide for a while by the robot's clock, or until the lap ends."""
        assert self.scene.state is not None
        trial = self.scene.state.trial
        hold = Hold(self.scene, self.take, self.let_go)
        looked = time.monotonic()
        end = looked + 3 * PATIENCE_S
        while hold.passed_s < seconds:
            state, now = self.scene.state, time.monotonic()
            assert now < end, "the robot does not come to where it is guided"
            if state.trial != trial or state.has_ended:
                break
            view = state.view
            wanted = self.hand.aim(view, max(now - looked, 1e-3))
            looked = now
            left, up = wanted.y_m - view.hand_y_m, wanted.z_m - view.hand_z_m
            self.hold({key for key, y, z in self.ARROWS if y * left + z * up > self.NEAR_M})
            self.scene.page.wait_for_timeout(LOOK_MS)
            hold.look()
        self.let_go()

    def take(self) -> None:
        self.keyboard.press("Enter")
        self.keyboard.press(" ")

    def let_go(self) -> None:
        self.hold(set())
        self.keyboard.press("Escape")

    def hold(self, keys: set[str]) -> None:
        for key in self.held - keys:
            self.keyboard.up(key)
        for key in keys - self.held:
            self.keyboard.down(key)
        self.held = keys


class Keys:
    """A person at the keyboard: moves on with Tab, and sees where they are."""

    SEES = """(e) => {
        for (let around = e, i = 0; around && i < 5; around = around.parentElement, i++) {
          const { outlineStyle, outlineWidth } = getComputedStyle(around);
          if (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2) return true;
        }
        return false;
    }"""

    def __init__(self, page: Page) -> None:
        self.page = page

    def has_focus(self, goal: Locator) -> bool:
        return bool(goal.evaluate("(e) => e.getRootNode().activeElement === e"))

    def reach(self, goal: Locator) -> None:
        """Press Tab until the goal has the focus; it must be seen to have it."""
        # While a page turns, the one before may still be there, and one that comes takes the focus away.
        expect(goal).to_have_count(1)
        expect(goal).to_be_visible()
        until_drawn(self.page)
        for _ in range(60):
            if self.has_focus(goal):
                self.page.wait_for_timeout(250)
                if self.has_focus(goal):
                    break
            self.page.keyboard.press("Tab")
            self.page.wait_for_timeout(30)
        expect(goal).to_be_focused()
        assert goal.evaluate(self.SEES), "nobody sees where the focus is"

    def press(self, name: str, key: str = "Enter") -> None:
        self.reach(self.page.get_by_role("button", name=name))
        self.page.keyboard.press(key)

    def choose(self, group: str, option: str) -> None:
        """To a radio group with Tab, and to its option with the arrows."""
        options = self.page.get_by_role("radiogroup", name=group).get_by_role("radio")
        expect(options.first).to_be_visible()
        until_drawn(self.page)
        for _ in range(20):
            if any(self.has_focus(each) for each in options.all()):
                break
            self.page.keyboard.press("Tab")
        chosen = options.and_(self.page.get_by_role("radio", name=option, exact=True))
        (at,) = [k for k, each in enumerate(options.all()) if self.has_focus(each)]
        if self.has_focus(chosen) and not chosen.is_checked():
            self.page.keyboard.press(" ")
        for _ in range(options.count()):
            if self.has_focus(chosen):
                break
            self.page.keyboard.press("ArrowRight")
            at = (at + 1) % options.count()
            expect(options.nth(at)).to_be_focused()
        expect(chosen).to_be_checked()
        assert chosen.evaluate(self.SEES), "nobody sees where the focus is"


def test_a_whole_session_by_the_keyboard_alone(chromium: "Browser", tmp_path: Path) -> None:
    with serving(tmp_path, ONE_COMPARISON) as server:
        context = chromium.new_context(viewport=SIZE)  # type: ignore[arg-type]
        page, study = context.new_page(), server.store.studies()[0].study
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        keys, wall = Keys(page), page.get_by_label("Wall", exact=True)
        practice = Scene(page, study.practice_study.maze)
        page.goto(server.participant_url)
        keys.press("I agree to take part")
        keys.choose("Have you guided a robot by hand before?", "Often")
        keys.reach(page.get_by_label("How old are you?"))
        page.keyboard.type("33")
        keys.press("Continue")
        expect(page.get_by_role("heading", name="What you will do")).to_be_visible()
        keys.press("Continue", " ")
        keys.choose("What do you guide it with?", "Keyboard")
        keys.press("Continue")

        keys.reach(wall)
        practice.until_trial(after=0)
        KeyboardHand(practice, study.practice_study).guide()
        go_on = page.get_by_role("button", name="Continue")
        expect(go_on).to_be_focused()
        keys.press("Continue")
        expect(page.get_by_role("heading", name="Next: compare")).to_be_visible()
        scene = Scene(page, study.maze)
        keys.press("Continue")

        keys.reach(wall)
        for slot, key in (("A", "1"), ("B", "2")):
            before = scene.trial if slot == "B" else 0
            page.keyboard.press(key)
            expect(page.get_by_role("radio", name=f"Method {slot}", exact=True)).to_be_checked()
            scene.until_trial(after=before)
            KeyboardHand(scene, study).guide(2.5)
        expect(page.get_by_role("button", name="Answer the questions")).to_have_attribute(
            "aria-disabled", "false"
        )
        keys.press("Answer the questions")
        keys.choose("Which method was the smoothest to use?", "B smoother")
        keys.choose("Which method felt safest to use?", "About the same")
        keys.press("Submit answers")
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible()
        context.close()
        assert errors == []
        (person,) = server.store.participants(server.store.studies()[0])
        assert (person.device, person.background["years"]) == ("keyboard", "33")
        (comparison,) = server.store.comparisons(server.store.studies()[0])
        assert {r.question: r.answer for r in server.store.responses(comparison.id)} == {
            "Q1": "B>A", "Q2": "A=B",
        }  # fmt: skip
        trials = server.store.trials(comparison=comparison.id)
        assert {trial.slot for trial in trials} == {"A", "B"}
        assert all(trial.metrics["latency_samples"] >= 1 for trial in trials)
