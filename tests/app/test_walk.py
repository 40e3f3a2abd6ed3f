"""A person takes part in a real browser, the researcher looks on; then everything is in the store, once."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import Page, expect

from .conftest import SECRETS, TINY_STUDY, Server, serving
from .drawn import until_drawn
from .ear import Ear

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
TWO_COMPARISONS = TINY_STUDY.replace("repetitions = 1", "repetitions = 2")


def watch_both(page: Page) -> None:
    expect(page.get_by_label("Wall", exact=True)).to_be_visible()
    for slot in ("B", "A"):
        page.get_by_role("radio", name=f"Method {slot}", exact=True).check()
        expect(page.get_by_text(re.compile(f"more with .*{slot},"))).to_have_count(0)
    page.get_by_role("button", name="Answer the questions").click()
    expect(page.get_by_role("button", name="Submit answers")).to_be_visible()
    expect(page.get_by_label("Wall", exact=True)).to_have_count(0)


def scale(page: Page, wording: str) -> list[str]:
    return [
        str(option.get_attribute("aria-label"))
        for option in page.get_by_role("radiogroup", name=wording).get_by_role("radio").all()
    ]


def test_from_consent_to_thanks_with_a_reload_then_the_researcher(
    chromium: "Browser", tmp_path: Path
) -> None:
    with serving(tmp_path, TWO_COMPARISONS) as server:
        participant = chromium.new_context()
        page = participant.new_page()
        ear = Ear(page, SECRETS)
        page.goto(server.participant_url)
        page.get_by_role("button", name="I agree to take part").click()
        page.get_by_role("button", name="Continue").click()
        watch_both(page)
        smoothest, safest = "Which method was the smoothest to use?", "Which method felt safest to use?"
        assert scale(page, smoothest) == [
            "A much smoother", "A smoother", "About the same", "B smoother", "B much smoother",
        ]  # fmt: skip
        page.get_by_role("radiogroup", name=smoothest).get_by_role("radio", name="A smoother").check()
        ear.look()

        page.reload()
        chosen = page.get_by_role("radio", name="A smoother")
        expect(chosen).to_be_checked()
        page.get_by_role("button", name="Submit answers").click()
        expect(page.get_by_role("radio", name="Method A", exact=True)).to_be_focused()

        page.get_by_role("button", name="Back to the robot").click()
        watch_both(page)
        expect(chosen).to_be_checked()
        page.get_by_role("radiogroup", name=safest).get_by_role("radio").last.check()
        page.get_by_role("button", name="Submit answers").click()
        page.get_by_role("button", name="Continue").click()

        watch_both(page)
        chosen.focus()
        page.keyboard.press("ArrowRight")
        expect(page.get_by_role("radio", name="About the same").first).to_be_checked()
        page.get_by_role("radiogroup", name=safest).get_by_role("radio").first.check()
        page.get_by_role("button", name="Submit answers").click()
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible()
        ear.look()
        page.goto(f"{server.base}/overview")
        expect(page.get_by_role("heading", name="Please open your link")).to_be_visible()
        ear.look()
        participant.close()
        assert ear.secrets_heard() == []
        heard = {where for where, _ in ear.heard}
        assert {"document", f"{server.base}/laps/A/1"} <= heard
        assert any(where.startswith("ws://") for where in heard)
        assert ear.errors == []
        check_store(server)
        researcher = chromium.new_page()
        check_console(researcher, server)
        researcher.context.close()
    assert "Traceback" not in server.log.read_text()


def check_store(server: Server) -> None:
    (study,) = server.store.studies()
    (person,) = server.store.participants(study)
    assert person.consent_version == "7"
    assert person.finished_at is not None
    first, second = server.store.comparisons(study)
    answers = {c.id: [(r.question, r.answer) for r in server.store.responses(c.id)] for c in (first, second)}
    assert answers == {first.id: [("Q1", "A>B"), ("Q2", "B>A")], second.id: [("Q1", "A=B"), ("Q2", "A>B")]}
    for comparison in (first, second):
        trials = server.store.trials(comparison=comparison.id)
        for slot in ("A", "B"):
            exposure = sum(trial.duration_s for trial in trials if trial.slot == slot)
            assert exposure >= study.study.protocol.minimum_exposure_s - 0.05
        assert {trial.mode for trial in trials} == {comparison.mode_a, comparison.mode_b}
        assert len(server.store.switches(comparison.id)) >= 2


def check_console(page: Page, server: Server) -> None:
    page.goto(server.researcher_url)
    expect(page.get_by_role("heading", name="Zweifelhaft")).to_be_visible()
    page.get_by_role("link", name="Results").click()
    expect(page.get_by_role("cell", name="X", exact=True).first).to_be_visible()
    expect(page.get_by_test_id("stVegaLiteChart").locator("svg.marks").first).to_be_visible()
    until_drawn(page)
    assert "Zwetschge" not in page.content()
    page.get_by_role("link", name="Overview").click()
    page.get_by_role("button", name="Unblind").click()
    page.get_by_role("button", name="Unblind now").click()
    expect(page.get_by_text("Unblinded: modes are shown by name")).to_be_visible()
    page.get_by_role("link", name="Results").click()
    expect(page.get_by_role("cell", name="Zwetschge").first).to_be_visible()
    actions = [entry.action for entry in server.store.audit_log()]
    assert actions == ["open console", "look at results", "unblind"]
    page.get_by_role("link", name="Data").click()
    page.get_by_role("button", name="Prepare the export").click()
    expect(page.get_by_role("button", name="Download the export")).to_be_visible()
    for name in ("Study file", "Links"):
        page.get_by_role("link", name=name).click()
        expect(page.get_by_role("heading", name=name).first).to_be_visible()
