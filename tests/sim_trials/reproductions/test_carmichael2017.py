"""The 2017 paper's equations, text and robot."""

import numpy as np
import pandas as pd
import pytest

from data.study import Study
from sim_trials.modes.registry import resolve
from sim_trials.reproductions.carmichael2017 import claims
from sim_trials.reproductions.carmichael2017.damping import SIGMA_T, TABLE_1, damping_table
from sim_trials.reproductions.carmichael2017.least_damping import DAMPINGS, least_damping_table
from sim_trials.reproductions.carmichael2017.measures import FORCE, measured_table, rises
from sim_trials.reproductions.carmichael2017.reach import perpendicular_reach_m
from sim_trials.reproductions.verdict import Judgement, Verdict


@pytest.fixture(scope="module")
def damping(study: Study) -> pd.DataFrame:
    return damping_table([resolve(mode) for mode in study.modes], study.maze)


def felt(force: dict[str, list[float]]) -> pd.DataFrame:
    """Metrics of people whose mean force by mode is given, the same in every phase."""
    rows = [
        {"participant": f"s{k}", "mode": mode}
        | {FORCE.column(phase): value for phase in ("lap", "approach", "edge", "exit")}
        | dict.fromkeys(("gain", "gain_approach", "gain_edge", "gain_exit"), 1.0)
        | dict.fromkeys([f"jerk_rms{phase}_m_s3" for phase in ("", "_approach", "_edge", "_exit")], 1.0)
        for mode, values in force.items()
        for k, value in enumerate(values)
    ]
    return pd.DataFrame(rows)


def judged(verdicts: tuple[Verdict, ...], words: str) -> Verdict:
    found = [verdict for verdict in verdicts if words in verdict.claim]
    assert len(found) == 1
    return found[0]


def test_table_1_is_what_the_built_in_study_has(study: Study) -> None:
    for mode in study.modes:
        towards, away = TABLE_1[mode.name]
        values = mode.parameters
        assert (values.get("lambda0_towards", values.get("lambda0")), values["sigma_t"]) == (towards, SIGMA_T)
        assert values.get("lambda0_away", values.get("lambda0")) == away


def test_the_modes_on_the_robot_damp_as_the_equations_say(damping: pd.DataFrame) -> None:
    np.testing.assert_allclose(damping["damping"], damping["damping_eq2"], atol=1e-6)
    np.testing.assert_allclose(damping["gain"], damping["gain_eq1"], atol=1e-9)


def test_the_amplification_peaks_where_the_scheduled_damping_lets_it(damping: pd.DataFrame) -> None:
    verdict = judged(claims.of_the_equations(damping), "well-conditioned")
    assert "6.93 (lambda_0 = 0.2, at sigma = 0.119)" in verdict.ours
    assert "5.22 (lambda_0 = 0.6, at sigma = 0.175)" in verdict.ours
    assert verdict.judgement is Judgement.REPRODUCED


def test_what_the_equations_decide(damping: pd.DataFrame) -> None:
    verdicts = claims.of_the_equations(damping)
    assert judged(verdicts, "resists it least").judgement is Judgement.REPRODUCED
    assert judged(verdicts, "plain inverse").judgement is Judgement.UNDER_ASSUMPTION
    assert judged(verdicts, "small displacement").judgement is Judgement.UNDER_ASSUMPTION


def test_only_eleven_of_28_comparisons_are_39_percent() -> None:
    verdict = judged(claims.of_the_text(), "39 %")
    assert "only 11 round to 39 %" in verdict.ours
    assert verdict.judgement is Judgement.REPRODUCED


def test_what_the_paper_says_twice_and_differently_is_contradicted() -> None:
    verdicts = claims.of_the_text()
    for words in ("constant damping", "aligned well", "Q3 is one of the more subjective"):
        assert judged(verdicts, words).judgement is Judgement.CONTRADICTED


def test_nothing_that_only_people_could_tell_is_decided() -> None:
    verdicts = claims.of_the_text()
    for words in ("agreed with each other", "no clear consensus", "because its low damping", "affects what"):
        assert judged(verdicts, words).judgement is Judgement.NOT_DETERMINABLE


def test_a_perpendicular_nozzle_reaches_neither_upper_corner_nor_much_beyond_the_lower(study: Study) -> None:
    maze = study.maze
    assert perpendicular_reach_m(maze, maze.top_z_m) == pytest.approx(-0.962, abs=1e-3)
    assert perpendicular_reach_m(maze, maze.bottom_z_m) == pytest.approx(-1.057, abs=1e-3)


def test_with_too_little_damping_the_elbow_turns_over_and_with_that_of_m1_it_does_not(study: Study) -> None:
    table = least_damping_table(study, [2017]).set_index("lambda0")
    assert tuple(table.index) == DAMPINGS
    assert table.loc[0.001, "elbow_inversions"] == table.loc[0.001, "protective_stops"] == 1
    assert (table.loc[[0.05, 0.1, 0.2], ["elbow_inversions", "protective_stops"]] == 0).all(axis=None)


def test_an_order_needs_more_than_chance_between_the_same_people() -> None:
    apart = felt({"M1": [10.0, 20.0, 30.0], "M2": [11.0, 21.2, 30.9]})
    mixed = felt({"M1": [10.0, 20.0, 30.0], "M2": [14.0, 15.0, 33.0]})
    assert rises(apart, FORCE, "lap", ("M1", "M2"))
    assert not rises(apart, FORCE, "lap", ("M2", "M1"))
    assert not rises(mixed, FORCE, "lap", ("M1", "M2"))


def test_people_count_alike_however_often_they_were_measured() -> None:
    metrics = felt({"M1": [10.0, 20.0]})
    twice = pd.concat([metrics, metrics.iloc[:1]], ignore_index=True)
    cells = measured_table(twice).set_index(["measure", "phase", "mode"])
    assert cells.loc[("force", "lap", "M1"), "mean"] == 15.0
    assert cells.loc[("force", "lap", "M1"), "people"] == 2
