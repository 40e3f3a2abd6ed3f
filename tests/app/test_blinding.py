"""Under every allocation, nothing that reaches the browser says which mode is behind A or B."""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from app.server.visitors import PARTICIPANT_COOKIE

from .conftest import GUIDED_STUDY, SECRETS, Server, serving
from .ear import Ear
from .scene import Hold, Scene

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
PARAMETERS = (0.21375, 0.61125, 0.24875, 0.25125)
"""Odd enough that they don't turn up by chance, and different in both modes."""
ODD = "lambda0 = {}, sigma_t = {}"
STUDY = (
    GUIDED_STUDY.replace(ODD.format(0.2, 0.25), ODD.format(PARAMETERS[0], PARAMETERS[2]))
    .replace(ODD.format(0.6, 0.25), ODD.format(PARAMETERS[1], PARAMETERS[3]))
    .replace("repetitions = 1", "repetitions = 2\nattention_checks = 1")
)


def joined(chromium: "Browser", server: Server) -> tuple[Scene, Ear, str]:
    """What a participant sees before the first comparison, an ear at their browser, and who it is."""
    cookie, participant = server.join(starts=False)
    server.store.record_device(participant.id, "mouse")
    server.store.record_practice(participant.id, server.store.clock())
    context = chromium.new_context(viewport={"width": 1024, "height": 768})
    context.add_cookies([{"name": PARTICIPANT_COOKIE, "value": cookie, "url": server.base}])
    page = context.new_page()
    ear = Ear(page, SECRETS, PARAMETERS)
    scene = Scene(page, server.store.studies()[0].study.maze)
    page.goto(server.base)
    return scene, ear, participant.id


def guide_a_little(scene: Scene, slot: str) -> None:
    """Turn to a method, hold the nozzle for a moment, start the lap anew, hold it again."""
    page = scene.page
    page.get_by_role("radio", name=f"Method {slot}", exact=True).check()
    ready = page.locator(f".option.{slot.lower()} .status")
    for again in (False, True):
        if again:
            page.get_by_role("button", name="Restart the lap").click()
        expect(ready).to_have_text("in your hand now")
        page.mouse.move(*scene.at(0.25, 0.4))
        Hold(scene, page.mouse.down, page.mouse.up).keep(0.4)
        page.mouse.up()


def test_no_mode_name_or_parameter_reaches_the_browser_under_any_allocation(
    chromium: "Browser", tmp_path: Path
) -> None:
    with serving(tmp_path, STUDY) as server:
        scene, ear, who = joined(chromium, server)
        page, wall = scene.page, scene.page.get_by_label("Wall", exact=True)
        comparisons = server.store.comparisons(participant=who)
        allocations = {(c.mode_a, c.mode_b) for c in comparisons}
        assert {("Zwetschge", "Mirabelle"), ("Mirabelle", "Zwetschge")} < allocations
        shapes: list[set[str]] = []
        for _ in comparisons:
            before = len(ear.heard)
            page.get_by_role("button", name="Continue").click()
            for slot in ("A", "B"):
                guide_a_little(scene, slot)
            ear.look()
            answer = page.get_by_role("button", name="Answer the questions")
            expect(answer).to_have_attribute("aria-disabled", "false")
            answer.click()
            submit = page.get_by_role("button", name="Submit answers")
            expect(submit).to_be_visible()
            # The page before has a group of radio buttons, too.
            expect(wall).to_have_count(0)
            for group in page.get_by_role("radiogroup").all():
                group.get_by_role("radio").first.check()
            ear.look()
            submit.click()
            expect(submit).to_have_count(0)
            shapes.append(shape_of(ear.heard[before:]))
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible()
        ear.look()
        page.context.close()
    assert ear.secrets_heard() == []
    assert ear.errors == []
    # The kinds of messages and their fields are the same whatever is behind A and B.
    assert all(shape == shapes[0] for shape in shapes)
    assert "kind 2" in shapes[0], "no state was heard"
    kinds = {where.rpartition("/")[2] for where, _ in ear.heard}
    assert {"live", "stream", "document", "guide.js"} <= kinds


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
        page = chromium.new_page()
        ear = Ear(page, SECRETS, PARAMETERS)
        page.goto(server.participant_url)
        page.get_by_role("button", name="I agree to take part").wait_for()
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
