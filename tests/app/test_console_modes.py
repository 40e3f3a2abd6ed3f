"""The page Modes: what can be compared, the process that works it out, and who gets to see it."""

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from app.atlas import with_every_method, with_modes
from app.atlas_tables import by_method, curves_table, laps_table, names, parameters_table, verdicts
from app.console.mode_bench import ModeBench
from app.console.study_page import study_facts
from app.server.visitors import PARTICIPANT_COOKIE
from app.studies import resolved_modes
from data.study import Study
from data.study_file import parse_study
from sim_trials.loop import COMPLETED, STUCK
from sim_trials.mode_atlas import mode_curves
from sim_trials.mode_laps import LapOfMode, ModeLaps
from sim_trials.modes.registry import METHODS
from tests.conftest import PATIENCE_S

from .conftest import GUIDED_STUDY, SECRETS, TINY_STUDY, Server
from .ear import Ear
from .test_external_runs import LAB_STUDY

if TYPE_CHECKING:
    from playwright.sync_api import Browser


@pytest.fixture
def study() -> Study:
    return with_every_method(parse_study(GUIDED_STUDY, "guided.toml"))


def wait_for(bench: ModeBench) -> None:
    deadline = time.monotonic() + 3 * PATIENCE_S
    while bench.state == "running" and time.monotonic() < deadline:
        time.sleep(0.05)


def test_every_method_can_be_chosen_beside_the_study_s_modes(study: Study) -> None:
    assert study.mode_names == ("Zwetschge", "Mirabelle", *METHODS)
    assert [mode.method for mode in study.modes[2:]] == list(METHODS)


def test_a_mode_named_like_a_method_keeps_its_name() -> None:
    text = GUIDED_STUDY.replace('name = "Zwetschge"', 'name = "transpose"')
    modes = {mode.name: mode.method for mode in with_every_method(parse_study(text, "guided.toml")).modes}
    assert modes["transpose"] == "dls"
    assert modes["transpose.default"] == "transpose"


def test_of_a_robot_in_the_lab_only_known_methods_can_be_chosen() -> None:
    lab = parse_study(LAB_STUDY, "lab.toml")
    assert with_every_method(lab).mode_names == tuple(METHODS)


def test_modes_are_compared_in_the_study_s_order(study: Study) -> None:
    assert with_modes(study, ("transpose", "Mirabelle")).mode_names == ("Mirabelle", "transpose")


def test_laps_are_run_in_another_process_and_kept(study: Study) -> None:
    bench = ModeBench()
    assert bench.atlas(study, ("Mirabelle",)) is None
    bench.start(study, ("Mirabelle",), with_laps=True)
    bench.start(study, ("Zwetschge",), with_laps=True)
    wait_for(bench)
    assert (bench.state, bench.trouble, bench.given) == ("done", "", 2)
    assert bench.atlas(study, ("Zwetschge",)) is None, "one at a time"
    first = bench.atlas(study, ("Mirabelle",))
    assert first is not None
    assert [lap.name for lap in first.laps] == ["Mirabelle"]
    assert "Mirabelle" in first.drawing.alt

    assert bench.missing(study, ("Zwetschge", "Mirabelle")) == ("Zwetschge",), "laps that were run are kept"
    changed = with_every_method(parse_study(GUIDED_STUDY.replace("0.6", "0.7"), "guided.toml"))
    assert bench.missing(changed, ("Mirabelle",)) == ("Mirabelle",), "another study's laps are its own"
    assert bench.atlas(changed, ("Mirabelle",)) is None


def test_a_comparison_whose_process_is_killed_says_so(study: Study) -> None:
    bench = ModeBench()
    bench.start(study, ("Mirabelle",), with_laps=False)
    assert bench._process is not None
    bench._process.kill()
    wait_for(bench)
    assert (bench.state, bench.trouble) == ("failed", "the process that simulated was ended from outside")


def test_a_comparison_can_be_cancelled(study: Study) -> None:
    bench = ModeBench()
    bench.start(study, ("Mirabelle",), with_laps=True)
    process = bench._process
    bench.cancel()
    assert process is not None
    process.join(PATIENCE_S)
    assert (bench.state, process.is_alive()) == ("cancelled", False)
    assert bench.missing(study, ("Mirabelle",)) == ("Mirabelle",)


def test_the_table_says_what_the_curves_show(study: Study) -> None:
    modes = resolved_modes(with_modes(study, ("Mirabelle", "condition_scaling")), "guided")
    curves = [mode_curves(mode, study.maze) for mode in modes]
    cells = curves_table(curves)
    rows = {(row[0], row[1]): dict(zip(cells.head, row, strict=True)) for row in cells.rows}
    at = abs(curves[0].sigma - 0.1).argmin()
    assert rows["Mirabelle", "in"]["Gain at \u03c3 0.1"] == f"{curves[0].towards.gain[at]:.3f}"
    assert rows["Mirabelle", "in"]["\u03bb at \u03c3 0.1"] == f"{curves[0].towards.damping[at]:.2f}"
    assert rows["condition_scaling", "out"]["\u03bb at \u03c3 0.02"] == "\u221e", "it stands still there"


def test_modes_under_which_laps_are_done_are_told_together_and_the_others_one_by_one() -> None:
    lap = LapOfMode(COMPLETED, 40.0, 0.5, 0.0, 17.0, 0.5, 0.3)
    stuck = replace(lap, ending=STUCK, last_sigma=0.004, force_edge_n=float("nan"))
    laps = (
        ModeLaps("M1", (lap, stuck), "stuck", 20.0),
        ModeLaps("M2", (lap, lap), "completed", 40.0),
        ModeLaps("M3", (lap, lap), "completed", 39.0),
    )
    assert verdicts(laps) == (
        "M1: 1 of 2 laps get stuck in elbow-lock (sigma 0.004); the live lap gets stuck.",
        "Laps are done under M2, M3.",
    )
    first = dict(zip(laps_table(laps).head, laps_table(laps).rows[0], strict=True))
    assert (first["Done"], first["Stuck"], first["Ended otherwise"]) == ("1 of 2", "1 of 2", "0 of 2")
    assert (first["Edge force [N]"], first["Live lap"]) == ("17.0", "stuck after 20\u00a0s")


def test_modes_of_one_method_share_a_rule_and_a_table(study: Study) -> None:
    modes = resolved_modes(with_modes(study, ("Zwetschge", "Mirabelle", "transpose")), "guided")
    alike, alone = by_method(modes)
    assert (names(alike), names(alone)) == ("Zwetschge, Mirabelle", "")
    cells = parameters_table(alike)
    assert cells.head == ("Parameter", "Zwetschge", "Mirabelle", "Range", "Meaning")
    assert cells.rows[0][:4] == ("lambda0", "0.2", "0.6", "0.001 to 10")


def test_laps_per_method_are_a_fact_of_watched_studies_alone() -> None:
    facts = {
        source: dict(study_facts(parse_study(text, "study.toml")))
        for source, text in (("observed", TINY_STUDY), ("guided", GUIDED_STUDY), ("external", LAB_STUDY))
    }
    assert facts["observed"]["Laps per method and comparison"] == "1"
    assert "Laps per method and comparison" not in facts["guided"]
    assert "Laps per method and comparison" not in facts["external"]


@pytest.mark.browser
def test_a_participant_who_asks_for_the_page_hears_of_no_mode(chromium: "Browser", server: Server) -> None:
    cookie, _ = server.join()
    context = chromium.new_context()
    context.add_cookies([{"name": PARTICIPANT_COOKIE, "value": cookie, "url": server.base}])
    page = context.new_page()
    ear = Ear(page, SECRETS)
    page.goto(f"{server.base}/modes")
    expect(page.get_by_role("heading", name="Please open your link")).to_be_visible()
    ear.look()
    context.close()
    assert ear.secrets_heard() == []
