"""Planning in the console and on the command line: what is written, the process that simulates, the page."""

import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd
import pytest
from playwright.sync_api import Page, expect

from analysis.power import Conclusion, glance
from app.cli.main import run
from app.console.power_run import PowerRun
from app.planning import Wish, expectation, plan_of
from data.errors import InputError
from data.study_file import parse_study, read_study
from tests.conftest import PATIENCE_S

from .conftest import TINY_STUDY, Server, serving
from .drawn import until_drawn

if TYPE_CHECKING:
    from playwright.sync_api import Browser

STUDY = read_study("carmichael2017")
TINY = parse_study(TINY_STUDY, "tiny.toml")
SIZES = "2, 3, 400"
"""The first is done soon, the last one not before it is cancelled."""
SMALL = Wish(participants="2,3", replicates=1)


def test_a_plan_is_the_study_s_own_where_nothing_is_written() -> None:
    plan = plan_of(STUDY, Wish())
    assert plan.participants == (7, 14, 21, 28, 42)
    assert plan.repetitions == (2,)
    assert plan.scenario.worth == (1, 1, 2)
    assert (plan.scenario.levels, plan.scenario.cuts) == (3, (0.5,))
    assert plan.conclusion == Conclusion("best", 0.95)


def test_equality_is_planned_for_with_modes_alike_and_sizes_that_can_show_it() -> None:
    plan = plan_of(STUDY, Wish(conclusion="equal"))
    assert plan.conclusion == Conclusion("equal", 0.8)
    assert plan.scenario.worth == (1.0, 1.0, 1.0)
    assert min(plan.participants) > 100
    assert plan.participants[2] == glance(plan).enough
    pair = plan_of(STUDY, Wish(conclusion="M1=M3", participants="60,120", confidence=0.9))
    assert (pair.conclusion, pair.participants) == (Conclusion("equal pair", 0.9, (0, 2)), (60, 120))


def test_two_modes_by_name_are_a_conclusion() -> None:
    assert plan_of(STUDY, Wish(conclusion="M3:M1")).conclusion == Conclusion("pair", 0.95, (2, 0))


def test_a_share_of_ties_becomes_cut_points() -> None:
    few, many = (plan_of(STUDY, Wish(ties=share)).scenario.cuts[0] for share in (0.1, 0.4))
    assert 0 < few < many


@pytest.mark.parametrize(
    ("wish", "said"),
    [
        (Wish(worth="1;2"), "worth: '1;2' is no list of numbers"),
        (Wish(worth="1,2"), "worth: 2 numbers for 3 modes"),
        (Wish(participants="7.5"), "participants: '7.5' is no list of whole numbers"),
        (Wish(participants="-7"), "participants: one or more whole numbers"),
        (Wish(conclusion="M1:M9"), "conclusion: mode: 'M9' is not one of: M1, M2, M3"),
        (
            Wish(conclusion="first"),
            "'first' is not one of: best, order, equal, two modes such as M1:M2 or M1=M2",
        ),
        (Wish(conclusion="M1=M9"), "conclusion: mode: 'M9' is not one of: M1, M2, M3"),
        (Wish(ties=0.2, cuts="0.5"), "ties, cuts: give one of them"),
        (Wish(ties=1.5), "ties: 1.5 is no share"),
    ],
)
def test_what_makes_no_plan_is_told_in_one_line(wish: Wish, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)) as told:
        plan_of(STUDY, wish)
    assert "\n" not in str(told.value)


def test_the_planned_number_is_said_to_be_too_few_with_the_number_and_the_assumption() -> None:
    said = expectation(STUDY)
    found = re.match(
        r"With the planned 7 participants, 6 answers each to a question, about (\d+) % of studies would find "
        r"the best mode, were it twice as good as each of the others; for 80 % it takes about (\d+) ",
        said,
    )
    assert found
    assert 8 <= int(found[1]) <= 16
    assert 38 <= int(found[2]) <= 48


def test_the_check_of_a_study_file_says_what_its_size_is_good_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["study", "check", "carmichael2017"]) == 0
    assert expectation(STUDY) in capsys.readouterr().out


def test_the_command_prints_the_curve_and_writes_table_and_figure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "power"
    asked = ["--worth", "1,1,30", "--participants", "3,5", "--replicates", "3", "--jobs", "1"]
    assert run(["power", "--study", "carmichael2017", *asked, "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert re.search(r"3 participants +18 answers +█* +\d+ % right \[\d+, \d+\], \d+ % wrong", printed)
    assert "Simulated for planning, if people are so: worths 1 : 1 : 30" in printed
    table = pd.read_csv(out / "power.csv")
    assert list(table["participants"]) == [3, 5]
    assert (table[["right", "wrong", "open", "unranked"]].sum(axis=1) == 3).all()
    assert sorted(path.name for path in out.iterdir()) == ["power.csv", "power.png", "power.svg"]


def wait_for(run: PowerRun) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while run.state == "running" and time.monotonic() < deadline:
        time.sleep(0.05)


def test_what_makes_no_plan_starts_no_process() -> None:
    run = PowerRun()
    with pytest.raises(InputError):
        run.start(TINY, Wish(worth="1"))
    assert (run.state, run.result) == ("idle", None)


def test_one_calculation_at_a_time_for_all_tabs_and_its_sizes_come_one_by_one() -> None:
    run = PowerRun()
    assert run.start(TINY, SMALL)
    assert not run.start(TINY, Wish(participants="9"))
    assert run.wish == SMALL
    wait_for(run)
    assert (run.state, run.trouble) == ("done", "")
    assert run.given == 2
    assert run.result is not None
    assert [point.participants for point in run.result.points] == [2, 3]


def test_a_cancelled_calculation_leaves_room_for_the_next_and_says_nothing_into_it() -> None:
    run = PowerRun()
    run.start(TINY, Wish(participants="2,50", replicates=500))
    process = run._process
    assert process is not None
    run.cancel()
    assert run.state == "cancelled"
    assert run.start(TINY, SMALL)
    process.join(PATIENCE_S)
    assert not process.is_alive()
    wait_for(run)
    assert run.state == "done"
    assert run.result is not None
    assert [point.replicates for point in run.result.points] == [1, 1]


def test_a_calculation_whose_process_is_killed_says_so() -> None:
    run = PowerRun()
    run.start(TINY, Wish(participants="50", replicates=500))
    assert run._process is not None
    run._process.kill()
    wait_for(run)
    assert (run.state, run.trouble) == ("failed", "the process that simulated was ended from outside")


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Server]:
    with serving(tmp_path, TINY_STUDY) as running:
        yield running


@pytest.mark.browser
def test_the_researcher_plans_a_study_in_the_browser(chromium: "Browser", served: Server) -> None:
    context = chromium.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    page.goto(served.researcher_url)
    expect(page.get_by_text("The page Planning simulates this")).to_be_visible()
    page.get_by_role("link", name="Planning", exact=True).click()
    expect(page.get_by_text("At a glance.")).to_be_visible()
    fill(page, "Worth of", "1, two")
    expect(page.get_by_text("worth: '1, two' is no list of numbers")).to_be_visible()
    expect(page.get_by_role("button", name=re.compile("^Simulate"))).to_have_count(0)
    fill(page, "Worth of", "1, 9")
    fill(page, "Participants to try", SIZES)
    fill(page, "Studies of each size", "10")
    # What was written is there again after another page.
    page.get_by_role("link", name="Links", exact=True).click()
    expect(page.get_by_role("heading", name="Links", level=1)).to_be_visible()
    page.get_by_role("link", name="Planning", exact=True).click()
    expect(page.get_by_label("Participants to try")).to_have_value(SIZES)
    page.get_by_role("button", name="Simulate 30 studies").click()
    expect(page.get_by_text("Simulated studies:")).to_be_visible()
    # A second tab, and a reload, see the same calculation, and can't begin another.
    other = context.new_page()
    other.goto(served.base + "/planning")
    expect(other.get_by_text("A calculation is under way")).to_be_visible()
    expect(other.get_by_label("Participants to try")).to_have_value(SIZES)
    row = other.get_by_role("row").filter(has_text="[").first
    expect(row).to_be_visible()
    other.get_by_role("button", name="Cancel").click()
    expect(other.get_by_text("The calculation was cancelled")).to_be_visible()
    expect(page.get_by_text("The calculation was cancelled")).to_be_visible()
    with other.expect_download() as begun:
        other.get_by_role("button", name="Download the table").click()
    table = pd.read_csv(begun.value.path())
    assert table["participants"].iloc[0] == 2
    assert set(table["replicates"]) == {10}
    assert "Traceback" not in served.log.read_text()
    context.close()


def fill(page: Page, label: str, value: str) -> None:
    field = page.get_by_label(label)
    field.fill(value)
    field.press("Enter")
    expect(field).to_have_value(value)
    until_drawn(page)
