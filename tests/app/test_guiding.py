"""A person guides the real robot in a real browser: by mouse, keyboard and touch, into the store."""

import json
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import Page, expect

from data.records import Device
from tests.conftest import PATIENCE_S

from .conftest import SECRETS, Server
from .drawn import until_drawn
from .guide_page import HELD_S, WAYS, by_mouse, guiding
from .guided_session import MouseHand

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser


@pytest.mark.parametrize("device", WAYS)
def test_a_comparison_is_guided_answered_and_stored(
    chromium: "Browser", guided_server: Server, device: Device
) -> None:
    with guiding(chromium, guided_server, device) as guide:
        page = guide.page
        answer = page.get_by_role("button", name="Answer the questions")
        expect(answer).to_have_attribute("aria-disabled", "true")
        until_drawn(page)
        assert page.evaluate("scrollY + document.scrollingElement.scrollHeight - innerHeight") <= 0
        WAYS[device](guide)
        if device == "keyboard":
            guide.wall.press("2")
            guide.is_ready("B")
        else:
            guide.turn_to("B")
        WAYS[device](guide)
        guide.answer_to_the_end()
        assert guide.comparison.answered_at is not None
        assert {trial.slot for trial in guide.trials} == {"A", "B"}
        for trial in guide.trials:
            assert (trial.source, trial.outcome) == ("guided", "abandoned")
            assert trial.duration_s >= HELD_S
            assert trial.metrics["latency_samples"] >= 1
            assert trial.metrics["latency_median_ms"] > 0.0
            assert trial.recording is not None
        switches = guided_server.store.switches(guide.comparison_id)
        assert [switch.slot for switch in switches] == ["A", "B"]


def test_a_reload_and_a_dropped_line_go_on_in_the_same_lap(
    chromium: "Browser", guided_server: Server
) -> None:
    with guiding(chromium, guided_server, "mouse") as guide:
        by_mouse(guide)
        time_chip = guide.page.locator(".chip .time")
        expect(time_chip).not_to_have_text("0:00")
        before = time_chip.inner_text()
        guide.page.evaluate("window.sockets.at(-1).close()")
        guide.page.wait_for_function("window.sockets.length >= 2")
        guide.is_ready("A")
        expect(time_chip).not_to_have_text("0:00")
        guide.page.reload()
        expect(time_chip).not_to_have_text("0:00")
        assert time_chip.inner_text() >= before
        until_painted(guide.page)
        assert guide.trials == ()


def until_painted(page: Page) -> None:
    """Wait for some pixels of the wall in the colour of the path."""
    page.wait_for_function(
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
            return count > 100;
        }"""
    )


def test_a_lap_that_is_restarted_is_in_nobody_s_hand_at_once(
    chromium: "Browser", guided_server: Server
) -> None:
    with guiding(chromium, guided_server, "mouse") as guide:
        restart = guide.page.get_by_role("button", name="Restart the lap")
        said = restart.evaluate(
            "(b) => { b.click(); return b.getRootNode().querySelector('.option.a .status').textContent; }"
        )
        assert "in your hand" not in said
        guide.is_ready("A")


def test_a_newer_window_takes_over_and_the_older_one_can_go_on(
    chromium: "Browser", guided_server: Server
) -> None:
    with guiding(chromium, guided_server, "mouse") as guide:
        second = guide.page.context.new_page()
        second.goto(guided_server.base)
        guide.says("The robot is in another window now")
        guide.page.get_by_role("button", name="Go on here").click()
        guide.is_ready("A")
        expect(second.get_by_role("button", name="Go on here")).to_be_visible()
        guide.page.bring_to_front()
        by_mouse(guide)


def test_practice_ticks_itself_off_and_leads_on_once_it_is_stored(
    chromium: "Browser", guided_server: Server
) -> None:
    with guiding(chromium, guided_server, "mouse", practises=True) as guide:
        page, study = guide.page, guided_server.store.studies()[0].study
        guide.says("Press the left mouse button on the wall and keep it down")
        expect(page.get_by_role("radiogroup")).to_have_count(0)
        guide.scene.until_trial(after=0)
        assert MouseHand(guide.scene, study.practice_study, pace_m_s=0.1).guide(PATIENCE_S)
        for name in ("Take the nozzle", "Move it", "Spray", "Finish a lap"):
            expect(page.get_by_role("listitem").filter(has_text=name)).to_have_class("done")
        expect(page.get_by_role("button", name="Continue")).to_be_focused()
        who = guide.comparison_id.rpartition(".")[0]
        assert guided_server.store.participant(who).practised_at is not None
        page.get_by_role("button", name="Continue").click()
        expect(guide.wall).to_have_count(0)


@pytest.mark.parametrize("event", ["blur", "pointercancel", "close"])
def test_whatever_takes_the_hand_away_stops_the_robot(
    chromium: "Browser", guided_server: Server, event: str
) -> None:
    with guiding(chromium, guided_server, "mouse") as guide:
        guide.hold_with_the_mouse(0.05)
        if event == "blur":
            guide.page.evaluate("window.dispatchEvent(new Event('blur'))")
        elif event == "close":
            guide.page.evaluate("window.sockets.at(-1).close()")
        else:
            guide.wall.dispatch_event("pointercancel", {"pointerId": 1})
        guide.says("Robot waits")
        guide.page.mouse.move(*guide.at(0.1))
        guide.page.wait_for_timeout(300)
        guide.says("Robot waits")
        guide.page.mouse.up()
        guide.is_ready("A")
        guide.hold_with_the_mouse(0.1)


def test_nothing_the_page_receives_says_more_than_a_and_b(chromium: "Browser", guided_server: Server) -> None:
    with guiding(chromium, guided_server, "mouse") as guide:
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
        assert any('"type":"trial"' in text for text in told)
        assert any(text.startswith("\x02") for text in told), "no state was heard"
        assert [secret for secret in SECRETS if secret.lower() in json.dumps(told).lower()] == []
