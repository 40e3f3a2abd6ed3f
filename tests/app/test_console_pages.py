"""The researcher walks through the console in a real browser; until unblinding no page names a mode."""

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import FilePayload, Page, expect

from app.cohort import simulate_cohort
from app.studies import OpenedStudy, resolved_modes
from data.store import Store
from data.study_file import parse_study
from tests.conftest import PATIENCE_S

from .conftest import TINY_STUDY, Server, serving
from .drawn import until_drawn

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
NAMES = ("Zwetschge", "Mirabelle", "Quitte")
STUDY = TINY_STUDY.replace("repetitions = 1", "repetitions = 2")


@pytest.fixture
def rehearsed(tmp_path: Path) -> Iterator[Server]:
    """A server whose store has one simulated participant and one person, whose first comparison is open."""
    study = parse_study(STUDY, "study.toml")
    with Store.open(tmp_path / "study.sqlite") as store:
        simulate_cohort(
            OpenedStudy(study, STUDY, resolved_modes(study, "study.toml")), store, 1, seed=3, n_jobs=1
        )
    with serving(tmp_path, STUDY) as server:
        server.join()
        yield server


@pytest.fixture
def page(chromium: "Browser", rehearsed: Server) -> Iterator[Page]:
    context = chromium.new_context(viewport={"width": 1280, "height": 800})
    opened = context.new_page()
    opened.goto(rehearsed.researcher_url)
    expect(opened.get_by_role("heading", name="Zweifelhaft")).to_be_visible()
    yield opened
    context.close()


def turn_to(page: Page, name: str) -> None:
    page.get_by_role("link", name=name, exact=True).click()
    expect(page.get_by_role("heading", name=name, level=1)).to_be_visible()
    until_drawn(page)


def check_blind(page: Page) -> None:
    """Nothing of the page names a mode: its document, and what components keep in their shadows."""
    until_drawn(page)
    shadows = page.evaluate(
        "() => [...document.querySelectorAll('*')].map((e) => e.shadowRoot?.innerHTML ?? '').join('\\n')"
    )
    shown = page.content() + shadows
    assert [name for name in NAMES if name in shown] == []


def check_headings(page: Page) -> None:
    """One first heading, and no level left out after it."""
    until_drawn(page)
    levels = page.get_by_role("heading").evaluate_all("(all) => all.map((e) => Number(e.tagName[1]))")
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))


def test_the_researcher_s_way_through_all_pages(page: Page, rehearsed: Server) -> None:
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    check_sessions(page)
    check_trials(page)
    check_modes(page)
    check_results(page, rehearsed)
    check_study_file(page, rehearsed)
    check_links(page, rehearsed)
    check_withdrawal(page, rehearsed)
    check_unblinded(page)
    assert errors == []
    log = rehearsed.log.read_text()
    assert "Traceback" not in log


def check_sessions(page: Page) -> None:
    check_blind(page)
    check_headings(page)
    turn_to(page, "Sessions")
    row = page.get_by_role("row").filter(has_text="P01").first
    expect(row).to_contain_text("comparing")
    expect(row).to_contain_text("1 of 2")
    check_blind(page)
    check_headings(page)


def check_trials(page: Page) -> None:
    turn_to(page, "Trials")
    page.get_by_text("Include simulated participants").click()
    expect(page.get_by_text("4 of 4 trials.")).to_be_visible()
    table = page.get_by_test_id("stDataFrame")
    expect(table).to_be_visible()
    check_blind(page)
    # The first line's box; lines are painted on a canvas, which tells screen readers what it has painted.
    expect(table.locator("canvas [role=gridcell]").first).to_be_attached()
    table.click(position={"x": 18, "y": 52})
    expect(page.get_by_role("heading", name=re.compile("^S01, comparison 1, method A"))).to_be_visible()
    check_replay(page)
    page.get_by_role("button", name="Later").click()
    expect(page.get_by_role("heading", name=re.compile("method B"))).to_be_visible()
    page.get_by_role("button", name="All trials").click()
    expect(page.get_by_text("4 of 4 trials.")).to_be_visible()


def check_replay(page: Page) -> None:
    expect(page.get_by_text("runs again bit for bit")).to_be_visible()
    slider = page.get_by_role("slider", name="Time")
    expect(slider).to_be_enabled()
    page.get_by_role("button", name="+1 frame").click()
    assert float(slider.input_value()) == pytest.approx(0.04)
    page.get_by_label("Wall", exact=True).focus()
    page.keyboard.press("End")
    end = float(slider.input_value())
    assert end > 5
    assert re.search(
        r"force \d+ N, speed .* m/s, sigma min 0\.\d+", str(slider.get_attribute("aria-valuetext"))
    )
    expect(page.locator(".series .to-come")).to_have_count(3)
    past = page.locator("#past rect")
    assert float(str(past.get_attribute("width"))) > 500
    page.keyboard.press("Home")
    assert float(str(past.get_attribute("width"))) == 0
    page.keyboard.press(" ")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(slider).not_to_have_value("0")
    page.keyboard.press(" ")
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    check_blind(page)
    check_headings(page)


def check_modes(page: Page) -> None:
    turn_to(page, "Modes")
    laps = page.get_by_role("checkbox", name=re.compile("With laps on the maze"))
    page.get_by_text("With laps on the maze").click()
    expect(laps).not_to_be_checked()
    page.get_by_role("button", name="Compare", exact=True).click()
    figure = page.get_by_role("img", name=re.compile("Gain: Zwetschge falls to 0.0"))
    # The bar comes, or it is done already.
    expect(page.get_by_role("button", name="Cancel").or_(figure).first).to_be_visible()
    # It goes on while other pages are shown, which still name no mode.
    turn_to(page, "Sessions")
    check_blind(page)
    turn_to(page, "Modes")
    expect(figure).to_be_visible(timeout=3000 * PATIENCE_S)
    assert figure.evaluate("(image) => image.decode().then(() => image.naturalWidth > 0)")
    expect(page.get_by_role("cell", name="Mirabelle").first).to_be_visible()
    expect(page.get_by_text("No laps were run yet.")).to_be_visible()
    expect(page.get_by_role("table").filter(has_text="lambda0")).to_contain_text("0.001 to 10")
    assert page.get_by_role("cell", name="X", exact=True).count() == 0, "a letter beside a mode's name"
    check_headings(page)


def check_results(page: Page, server: Server) -> None:
    turn_to(page, "Results")
    fit = page.get_by_role("button", name="Fit the full model")
    expect(fit).to_be_disabled()
    check_blind(page)
    check_headings(page)
    page.get_by_text("The report names the modes").click()
    expect(fit).to_be_enabled()
    fit.click()
    again = page.get_by_role("button", name="Fit again")
    expect(page.get_by_role("button", name="Cancel").or_(again).first).to_be_visible()
    # It goes on while other pages are shown.
    turn_to(page, "Links")
    turn_to(page, "Results")
    expect(again).to_be_visible(timeout=3000 * PATIENCE_S)
    expect(page.get_by_role("link", name="Open the report")).to_have_count(0)
    page.get_by_text("The report names the modes").click()
    link = page.get_by_role("link", name="Open the report")
    expect(link).to_have_attribute("href", re.compile("/report/report.html$"))
    report = page.request.get(f"{server.base}/report/report.html")
    assert "Zwetschge" in report.text()
    assert server.ask("/report/report.html").status == 403
    done = [entry.action for entry in server.store.audit_log()]
    assert done[-2:] == ["full fit", "read report"]


def check_study_file(page: Page, server: Server) -> None:
    turn_to(page, "Study file")
    upload = page.locator("input[type=file]")
    upload.set_input_files(candidate(STUDY.replace("levels = 3", "levels = 2")))
    expect(page.get_by_text("Valid, and differs from tiny@1")).to_be_visible()
    expect(page.get_by_role("cell", name="questions[2].levels")).to_be_visible()
    upload.set_input_files(candidate(STUDY.replace('"dls"', '"dsl"')))
    expect(page.get_by_text("dsl", exact=False).first).to_be_visible()
    assert len(server.store.studies()) == 1
    check_headings(page)


def candidate(text: str) -> FilePayload:
    return {"name": "next.toml", "mimeType": "application/toml", "buffer": text.encode()}


def check_links(page: Page, server: Server) -> None:
    turn_to(page, "Links")
    page.get_by_text("For one participant each").click()
    days = page.get_by_label("Valid for days, 0 without end")
    days.fill("7")
    days.press("Enter")
    page.get_by_role("button", name="Make links").click()
    expect(page.get_by_text("Copy them now")).to_be_visible()
    newest = server.store.links(server.store.studies()[0])[-1]
    assert newest.kind == "personal"
    assert newest.expires_at is not None
    assert (newest.expires_at - newest.created_at).days == 7
    check_headings(page)


def check_withdrawal(page: Page, server: Server) -> None:
    turn_to(page, "Sessions")
    page.get_by_role("combobox", name="Participant").click()
    page.get_by_role("option", name="P01").click()
    page.get_by_role("button", name="Withdraw…").click()
    expect(page.get_by_text("These are deleted for good")).to_be_visible()
    page.get_by_role("button", name="Delete their data").click()
    expect(page.get_by_role("row").filter(has_text="withdrawn")).to_have_count(1)
    (person,) = server.store.participants(server.store.studies()[0], source="human")
    assert person.withdrawn_at is not None
    assert server.store.comparisons(participant=person.id) == ()
    assert server.store.audit_log()[-1].action == "withdraw participant"


def check_unblinded(page: Page) -> None:
    turn_to(page, "Data")
    expect(page.get_by_text("modes by letter while the study is blinded")).to_be_visible()
    check_blind(page)
    check_headings(page)
    page.get_by_role("link", name="Overview").click()
    page.get_by_role("button", name="Unblind").click()
    page.get_by_role("button", name="Unblind now").click()
    expect(page.get_by_text("Unblinded: modes are shown by name")).to_be_visible()
    turn_to(page, "Data")
    expect(page.get_by_text("modes by name")).to_be_visible()


@pytest.mark.parametrize("path", ["/replays/x", "/recordings/x", "/report/report.html"])
def test_what_the_console_fetches_is_for_researchers_alone(server: Server, path: str) -> None:
    cookie, _ = server.join()
    assert server.ask(path).status == 403
    assert server.ask(path, cookie=cookie).status == 403
