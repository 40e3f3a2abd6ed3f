"""A robot in the lab: a participant and an operator in two browsers, then the stuck rates of the report."""

import csv
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import Page, expect

from data.store import Store

from .conftest import Server, serving
from .ear import Ear
from .test_external_runs import LAB_STUDY

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
SECRETS = ("Zwetschge", "Mirabelle", "Quitte", "Holler", "Zweifelhaft", "lambda")


def test_a_session_in_the_lab_ends_in_a_report_with_stuck_rates(chromium: "Browser", tmp_path: Path) -> None:
    with serving(tmp_path, LAB_STUDY) as server:
        researcher, participant = chromium.new_context(), chromium.new_context()
        operator, page = researcher.new_page(), participant.new_page()
        ear = Ear(page, SECRETS)
        operator.goto(server.researcher_url)
        operator.get_by_role("link", name="Operator").click()
        expect(operator.get_by_role("heading", name="Nobody is in a session")).to_be_visible()

        page.goto(server.participant_url)
        page.get_by_role("button", name="I agree to take part").click()
        page.get_by_role("button", name="Continue").click()
        expect(page.get_by_role("heading", name="Comparison 1 of 1")).to_be_visible()
        expect(page.get_by_role("radio", name="Method A", exact=True)).to_be_checked()
        says(page, "The operator is preparing method A")
        run_one(operator, page, "A", "Stuck")
        says(page, "The robot is being reset")
        run_one(operator, page, "A", "Done")

        answer = page.get_by_role("button", name="Answer the questions")
        expect(answer).to_be_disabled()
        answer.click(force=True)
        page.get_by_role("radiogroup", name="Method", exact=True).get_by_role(
            "radio", name="Method B"
        ).check()
        says(page, "The operator is preparing method B")
        begin(operator, page, "B")
        page.reload()
        says(page, "You are guiding with method B")
        second_window = researcher.new_page()
        second_window.goto(f"{server.base}/operator")
        expect(
            second_window.get_by_role("heading", name=re.compile("Running: .* as method B"))
        ).to_be_visible()
        ear.look()
        expect(page.get_by_text("You can answer")).to_be_visible()
        answer.click()
        page.get_by_role("radiogroup", name="Which method felt safest to use?").get_by_role(
            "radio"
        ).first.check()
        page.get_by_role("button", name="Submit answers").click()
        expect(page.get_by_role("heading", name="Thank you")).to_be_visible()
        ear.look()
        page.goto(f"{server.base}/operator")
        expect(page.get_by_role("heading", name="Please open your link")).to_be_visible()
        ear.look()
        for window in (operator, second_window):
            expect(window.get_by_role("heading", name="Nobody is in a session")).to_be_visible()
        assert ear.secrets_heard() == []
        assert ear.errors == []
        check_store(server)
        check_no_simulator(server)
        participant.close()
        researcher.close()
    assert "Traceback" not in server.log.read_text()
    check_report(tmp_path)


def begin(operator: Page, page: Page, slot: str) -> None:
    """The operator loads what is wanted and starts the run; the participant sees both."""
    expect(operator.get_by_role("heading", name=f"method {slot}")).to_be_visible()
    operator.get_by_role("button", name="Loaded").click()
    says(page, f"Method {slot} is ready")
    operator.get_by_role("button", name="Start").click()
    says(page, f"You are guiding with method {slot}")


def run_one(operator: Page, page: Page, slot: str, ending: str) -> None:
    if operator.get_by_role("button", name="Loaded").is_enabled():
        begin(operator, page, slot)
    expect(operator.get_by_label("time of this run")).to_have_text(re.compile("[1-9]$"))
    operator.get_by_role("button", name=ending).click()
    expect(operator.get_by_role("cell", name=ending, exact=True).first).to_be_visible()


def says(page: Page, text: str) -> None:
    expect(page.get_by_role("heading", name=text)).to_be_visible()


def check_store(server: Server) -> None:
    (study,) = server.store.studies()
    (comparison,) = server.store.comparisons(study)
    trials = server.store.trials(comparison=comparison.id)
    assert [(t.slot, t.number, t.source, t.outcome) for t in trials] == [
        ("A", 1, "external", "stuck"), ("A", 2, "external", "completed"), ("B", 1, "external", "abandoned"),
    ]  # fmt: skip
    assert [(e.kind, e.definition) for e in trials[0].events] == [("stuck", "operator/1")]
    assert trials[0].events[0].time_s == trials[0].duration_s >= 1.0
    for slot in ("A", "B"):
        assert sum(t.duration_s for t in trials if t.slot == slot) >= 1.95
    assert [switch.slot for switch in server.store.switches(comparison.id)] == ["B"]
    assert len(server.store.responses(comparison.id)) == 1


def check_no_simulator(server: Server) -> None:
    """Neither the server has loaded the simulator, nor has it workers that would."""
    process = Path(f"/proc/{server.process.pid}")
    if process.is_dir():
        mapped = (process / "maps").read_text()
        assert "mujoco" not in mapped
        assert "llvmlite" not in mapped
        children = (process / "task" / str(server.process.pid) / "children").read_text().split()
        assert not [
            child for child in children if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()
        ]


def check_report(folder: Path) -> None:
    from app.reporting import Request, make_report
    from data.export import export_study

    store_path = folder / "study.sqlite"
    make_report(Request(folder / "report", store=str(store_path), pooled=True))
    with Store.open(store_path) as store:
        (comparison,) = store.comparisons()
        export_study(store, store.study(), folder / "export")
    with (folder / "report" / "stuck.csv").open(encoding="utf-8") as file:
        rows = {row["mode"]: (row["comparisons"], row["stuck"]) for row in csv.DictReader(file)}
    assert rows == {comparison.mode_a: ("1", "1"), comparison.mode_b: ("1", "0")}
    with (folder / "export" / "trials.csv").open(encoding="utf-8") as file:
        outcomes = [row["outcome"] for row in csv.DictReader(file)]
    assert outcomes == ["stuck", "completed", "abandoned"]
