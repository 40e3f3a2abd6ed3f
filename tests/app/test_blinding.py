"""Under every allocation, nothing that reaches the browser says which mode is behind A or B."""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import Page, expect

from app.server.visitors import PARTICIPANT_COOKIE

from .conftest import GUIDED_STUDY, SECRETS, Server, serving
from .ear import Ear

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
TIMEOUT_MS = 60_000
PARAMETERS = (0.21375, 0.61125, 0.24875, 0.25125)
"""Odd enough that they don't turn up by chance, and different in both modes."""
ODD = "lambda0 = {}, sigma_t = {}"
STUDY = (
    GUIDED_STUDY.replace(ODD.format(0.2, 0.25), ODD.format(PARAMETERS[0], PARAMETERS[2]))
    .replace(ODD.format(0.6, 0.25), ODD.format(PARAMETERS[1], PARAMETERS[3]))
    .replace("repetitions = 1", "repetitions = 2\nattention_checks = 1")
)


def joined(chromium: "Browser", server: Server) -> tuple[Page, Ear, str]:
    """A participant's browser before the first comparison, an ear at it, and who it is."""
    cookie, participant = server.join(starts=False)
    server.store.record_device(participant.id, "mouse")
    server.store.record_practice(participant.id, server.store.clock())
    context = chromium.new_context(viewport={"width": 1024, "height": 768})
    context.add_cookies([{"name": PARTICIPANT_COOKIE, "value": cookie, "url": server.base}])
    context.set_default_timeout(TIMEOUT_MS)
    page = context.new_page()
    ear = Ear(page, SECRETS, PARAMETERS)
    page.goto(server.base)
    return page, ear, participant.id


def guide_a_little(page: Page, slot: str) -> None:
    """Turn to a method, hold the nozzle for a moment, start the lap anew, hold it again."""
    page.get_by_role("radio", name=f"Method {slot}", exact=True).check()
    ready = page.locator(f".option.{slot.lower()} .status")
    box = page.get_by_label("Wall", exact=True).bounding_box()
    assert box is not None
    for again in (False, True):
        if again:
            page.get_by_role("button", name="Restart the lap").click()
        expect(ready).to_have_text("in your hand now", timeout=TIMEOUT_MS)
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        page.mouse.down()
        expect(page.get_by_text("Robot moves", exact=True)).to_be_visible(timeout=TIMEOUT_MS)
        page.wait_for_timeout(400)
        page.mouse.up()


def test_no_mode_name_or_parameter_reaches_the_browser_under_any_allocation(
    chromium: "Browser", tmp_path: Path
) -> None:
    with serving(tmp_path, STUDY) as server:
        page, ear, who = joined(chromium, server)
        comparisons = server.store.comparisons(participant=who)
        allocations = {(c.mode_a, c.mode_b) for c in comparisons}
        assert {("Zwetschge", "Mirabelle"), ("Mirabelle", "Zwetschge")} < allocations
        shapes: list[set[str]] = []
        for _ in comparisons:
            page.get_by_role("button", name="Continue").click()
            before = len(ear.heard)
            for slot in ("A", "B"):
                guide_a_little(page, slot)
            ear.look()
            answer = page.get_by_role("button", name="Answer the questions")
            expect(answer).to_have_attribute("aria-disabled", "false", timeout=TIMEOUT_MS)
            answer.click()
            submit = page.get_by_role("button", name="Submit answers")
            expect(submit).to_be_visible(timeout=TIMEOUT_MS)
            for group in page.get_by_role("radiogroup").all():
                group.get_by_role("radio").first.check()
            ear.look()
            submit.click()
            expect(submit).to_have_count(0, timeout=TIMEOUT_MS)
            shapes.append(shape_of(ear.heard[before:]))
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible(timeout=TIMEOUT_MS)
        ear.look()
        page.context.close()
    assert ear.secrets_heard() == []
    assert ear.errors == []
    # The kinds of messages and their fields are the same whatever is behind A and B.
    assert all(shape == shapes[0] for shape in shapes)
    kinds = {where.rpartition("/")[2] for where, _ in ear.heard}
    assert {"live", "stream", "document", "guide.js"} <= kinds
    assert sum(where.endswith("/live") for where, _ in ear.heard) > 100


def shape_of(heard: list[tuple[str, bytes]]) -> set[str]:
    """Which fields the messages of the live socket have, and how long its frames are."""
    shape = set()
    for where, content in heard:
        if where.endswith("/live"):
            is_text = content.startswith(b"{")
            shape.add(str(sorted(json.loads(content))) if is_text else f"kind {content[0]}")
            assert is_text or content[0] != 2 or len(content) == 80
    return shape


def test_a_leak_planted_in_the_page_is_heard(chromium: "Browser", tmp_path: Path) -> None:
    planted = re.sub(r"felt safest to use\?", "felt safest to use, Mirabelle?", STUDY)
    planted = planted.replace('text = "You will watch a robot."', f'text = "Factor {PARAMETERS[1]}"')
    with serving(tmp_path, planted) as server:
        page = chromium.new_context().new_page()
        ear = Ear(page, SECRETS, PARAMETERS)
        page.goto(server.participant_url)
        page.get_by_role("button", name="I agree to take part").wait_for(timeout=TIMEOUT_MS)
        ear.look()
        page.context.close()
    assert f"{PARAMETERS[1]:g} in document" in ear.secrets_heard()


@pytest.mark.parametrize("form", ["word", "text", "<f", "<d"])
def test_the_ear_hears_words_and_numbers_in_any_form(chromium: "Browser", form: str) -> None:
    import struct

    page = chromium.new_page()
    ear = Ear(page, SECRETS, PARAMETERS)
    planted = {"word": b"..MIRAbelle", "text": f"[{PARAMETERS[1]}]".encode()}
    ear.heard.append(("socket", planted.get(form) or b"\x02" + struct.pack(form, PARAMETERS[1])))
    assert len(ear.secrets_heard()) == 1
    page.close()
