"""Many simulated studies: worths, orders and stuck robots from what a pool of people felt."""

import pandas as pd
import pytest

from app.carmichael2017.claims import ORDERS, of_stuck, of_the_ranks, order_table
from app.carmichael2017.cohorts import OF_THE_STUDY, PLAIN, FeltComparison, Person, cohort_table
from app.studies import open_study
from data.study import Study
from sim_trials.raters import Experience
from sim_trials.reproductions.verdict import Judgement

STRENGTH = {"M1": 1.0, "M2": 4.0, "M3": 2.0}
"""Force by mode; everything else is the same."""


@pytest.fixture(scope="module")
def study() -> Study:
    return open_study("carmichael2017").study


def felt(mode: str) -> Experience:
    named = ("force_mean_n", "force_mean_edge_n", "force_mean_exit_n")
    return Experience(dict.fromkeys(named, 10.0 * STRENGTH[mode]), 0.5 if mode == "M1" else 0.0)


@pytest.fixture(scope="module")
def pool(study: Study) -> tuple[Person, ...]:
    person = tuple(FeltComparison(a, b, felt(a), felt(b)) for a, b in study.pairs for _ in range(2))
    return (person,) * 4


@pytest.fixture(scope="module")
def cohorts(study: Study, pool: tuple[Person, ...]) -> pd.DataFrame:
    return cohort_table(study, pool, 3, 4, seed=1, n_jobs=1)


def test_a_study_has_as_many_comparisons_as_its_people_make(cohorts: pd.DataFrame) -> None:
    assert (cohorts["comparisons"] == 3 * 4).all()
    stuck = cohorts.groupby("mode")["stuck"].unique()
    assert [list(stuck[mode]) for mode in ("M1", "M2", "M3")] == [[12], [0], [0]]


def test_worths_add_up_to_one_in_every_study(cohorts: pd.DataFrame) -> None:
    sums = cohorts.groupby(["cohort", "raters", "question"])["worth"].sum()
    assert sums.to_numpy() == pytest.approx(1.0)


def test_plain_raters_answer_only_what_a_magnitude_stands_for(cohorts: pd.DataFrame) -> None:
    asked = cohorts.groupby("raters")["question"].unique()
    assert list(asked[PLAIN]) == ["Q1", "Q2", "Q3"]
    assert len(asked[OF_THE_STUDY]) == 6


def test_a_force_that_differs_fourfold_is_ranked_as_it_is(cohorts: pd.DataFrame) -> None:
    table = order_table(cohorts).set_index(["question", "raters"])
    for raters in (OF_THE_STUDY, PLAIN):
        assert table.loc[("Q3", raters), "share"] == 1.0
        assert table.loc[("Q3", raters), "commonest"] == "M2 > M3 > M1"


def test_the_same_seed_gives_the_same_studies(
    study: Study, pool: tuple[Person, ...], cohorts: pd.DataFrame
) -> None:
    again = cohort_table(study, pool, 3, 2, seed=1, n_jobs=1)
    first = cohorts[cohorts["cohort"] <= 2].reset_index(drop=True)
    pd.testing.assert_frame_equal(again, first, check_exact=True)
    other = cohort_table(study, pool, 3, 2, seed=2, n_jobs=1)
    assert not other["worth"].equals(first["worth"])


def cohorts_with(question: str, orders: list[tuple[str, ...]]) -> pd.DataFrame:
    """One study an order, whose worths fall in that order on one question and never lead on the others."""
    rows = []
    for number, order in enumerate(orders, start=1):
        for raters, questions in ((OF_THE_STUDY, [o.question for o in ORDERS]), (PLAIN, ["Q1", "Q2", "Q3"])):
            for asked in questions:
                shown = order if asked == question else ("M1", "M2", "M3")
                for place, mode in enumerate(shown):
                    rows.append(
                        (number, raters, asked, mode, (0.6, 0.3, 0.1)[place], 28, 11 * (mode == "M1"))
                    )
    columns = ["cohort", "raters", "question", "mode", "worth", "comparisons", "stuck"]
    return pd.DataFrame(rows, columns=columns)


@pytest.mark.parametrize(
    ("times", "judgement"),
    [
        (10, Judgement.UNDER_ASSUMPTION),
        (8, Judgement.UNDER_ASSUMPTION),
        (5, Judgement.NOT_DETERMINABLE),
        (2, Judgement.CONTRADICTED),
        (0, Judgement.CONTRADICTED),
    ],
)
def test_an_order_is_judged_by_how_many_studies_have_it(times: int, judgement: Judgement) -> None:
    published, other = ("M3", "M2", "M1"), ("M1", "M3", "M2")
    cohorts = cohorts_with("Q5", [published] * times + [other] * (10 - times))
    worth = pd.DataFrame({"question": ["Q5"], "mode": ["M3"], "worth": [1.0]})
    verdicts = of_the_ranks(cohorts, order_table(cohorts), worth)
    found = [verdict for verdict in verdicts if verdict.claim.startswith("Q5")]
    assert [verdict.judgement for verdict in found] == [judgement]


def test_a_stuck_robot_under_m2_stands_against_the_paper() -> None:
    cohorts = cohorts_with("Q1", [("M1", "M2", "M3")] * 3)
    columns = ["mode", "right_y_m", "dwell_s", "participants", "stuck", "rate"]
    rows = [("M1", -1.045, 5.0, 10, 4, 0.4), ("M2", -1.045, 5.0, 10, 0, 0.0), ("M3", -1.045, 5.0, 10, 0, 0.0)]
    surface = pd.DataFrame(rows, columns=columns)
    assert [v.judgement for v in of_stuck(cohorts, surface)] == [Judgement.UNDER_ASSUMPTION] * 2
    surface.loc[1, ["stuck", "rate"]] = (1, 0.1)
    assert "1 with 5 s" in of_stuck(cohorts, surface)[1].ours
    assert "holds in 1 of 2" in of_stuck(cohorts, surface)[1].assumption
    cohorts.loc[cohorts["mode"] == "M2", "stuck"] = 1
    assert of_stuck(cohorts, surface)[1].judgement is Judgement.CONTRADICTED
