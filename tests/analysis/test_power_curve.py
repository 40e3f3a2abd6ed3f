"""From counted studies to a number of participants, and the estimate that needs no simulation."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.special import ndtr

from analysis.power import Conclusion, Plan, Power, PowerPoint, Scenario, fitted_curve, glance, sentences
from analysis.power.glance import person_information
from analysis.power.plan import mode_pairs
from data.study_file import read_study

from .conftest import REFERENCE

STUDY = read_study("carmichael2017")
PLAN = Plan(STUDY, Scenario((1, 1, 2)), (7, 14, 20, 30, 45), (2,), replicates=500)
SIZES = (7, 14, 20, 30, 45)


@pytest.fixture(scope="module")
def recorded() -> pd.DataFrame:
    """What the command found with 500 replicates of each size; analysis/README.md has the command."""
    return pd.read_csv(REFERENCE / "power_carmichael2017.csv")


def counted(right: tuple[int, ...], wrong: int = 0, sizes: tuple[int, ...] = SIZES) -> Power:
    """A result in which so many of 500 studies of each size were right."""
    points = []
    for size, count in zip(sizes, right, strict=True):
        found = ["right"] * count + ["wrong"] * wrong + ["open"] * (500 - count - wrong)
        points.append(PowerPoint.of(2, size, 6 * size, found))
    return Power(PLAN, tuple(points))


def test_the_curve_recovers_the_line_that_counts_were_drawn_from() -> None:
    rng, hits, n = np.random.default_rng(4), 0, 200
    truth = ndtr(-2.2 + 0.45 * np.sqrt(SIZES))
    needed = next(k for k in range(1, 200) if ndtr(-2.2 + 0.45 * np.sqrt(k)) >= 0.8)
    for _ in range(n):
        curve = fitted_curve(SIZES, rng.binomial(100, truth), [100] * 5)
        assert curve is not None
        enough = curve.enough(0.8)
        assert enough is not None
        hits += enough.low <= needed and (enough.high is None or needed <= enough.high)
    assert hits / n > 0.9


def test_points_that_scatter_more_than_counts_do_widen_the_band() -> None:
    smooth, rough = (
        fitted_curve(SIZES, right, [500] * 5)
        for right in ((65, 150, 215, 310, 410), (65, 250, 115, 410, 310))
    )
    assert smooth is not None
    assert rough is not None
    assert np.trace(rough.covariance) > 10 * np.trace(smooth.covariance)


def test_shares_of_nothing_and_of_everything_still_make_a_curve() -> None:
    for right in ((0, 0, 0, 0, 0), (500,) * 5, (0, 0, 500, 500, 500)):
        curve = fitted_curve(SIZES, right, [500] * 5)
        assert curve is not None
        assert np.isfinite([curve.intercept, curve.slope]).all()
        low, high = curve.band(np.array(SIZES))
        assert (low <= high).all()


@pytest.mark.parametrize(
    ("right", "said"),
    [
        (
            (65, 150, 215, 310, 410),
            r"^4\d \[\d\d, \d\d\] participants are enough for 80 % right conclusions.$",
        ),
        ((30, 65, 95, 150, 215), r"^45 participants are too few .* about 9\d \[\d+, 1\d\d\] are enough"),
        ((0, 0, 0, 0, 0), "does not rise clearly enough"),
        ((450, 500, 500, 500, 500), "^7 participants are more than enough"),
    ],
)
def test_the_answer_says_how_many_and_whether_so_many_were_tried(right, said) -> None:
    (sentence,) = sentences(counted(right))
    assert pd.Series([sentence]).str.contains(said).all(), sentence


def test_where_nothing_is_planted_every_conclusion_is_called_wrong() -> None:
    result = counted((0,) * 5, wrong=25)
    even = replace(result, plan=replace(PLAN, scenario=Scenario((1, 1, 1))))
    assert sentences(even)[0].startswith(
        "None is planted as better, so every conclusion is wrong; 5 % [3, 7]"
    )


def test_a_single_size_gets_its_share_and_no_curve() -> None:
    (sentence,) = sentences(counted((65,), sizes=(7,)))
    assert sentence == "13 % [10, 16] of studies with 7 participants come to the right conclusion."


def test_more_participants_were_never_found_to_be_worse(recorded: pd.DataFrame) -> None:
    assert recorded["participants"].is_monotonic_increasing
    assert (recorded["right_share"].diff().dropna() > 0).all()
    assert (recorded["wrong_share"] < 0.05).all()


def test_the_estimate_at_a_glance_is_near_what_was_simulated(recorded: pd.DataFrame) -> None:
    expected = np.array([glance(PLAN).share(n) for n in recorded["participants"]])
    assert expected == pytest.approx(recorded["right_share"].to_numpy(), abs=0.06)


def test_at_a_glance_more_people_answers_and_agreement_help() -> None:
    at = glance(PLAN)
    shares = [at.share(n) for n in range(1, 100, 7)]
    assert shares == sorted(shares)
    assert glance(PLAN, 4).share(14) > glance(PLAN, 2).share(14) > glance(PLAN, 1).share(14)
    apart = replace(PLAN, scenario=replace(PLAN.scenario, subject_sd=2.0))
    assert glance(apart).share(14) < at.share(14)
    enough = at.enough
    assert enough is not None
    assert at.share(enough - 1) < 0.8 <= at.share(enough)


def test_at_a_glance_nothing_is_found_where_nothing_is_planted() -> None:
    even = replace(PLAN, scenario=Scenario((1, 1, 1)))
    assert glance(even).share(1000) == 0.0
    assert glance(even).enough is None


def test_at_a_glance_the_order_takes_more_people_than_the_best_and_a_pair_fewer() -> None:
    people = replace(PLAN, scenario=Scenario((1, 2, 4)))
    best, order, pair = (
        glance(replace(people, conclusion=c)).share(14)
        for c in (Conclusion("best"), Conclusion("order"), Conclusion("pair", pair=(0, 2)))
    )
    assert order < best < pair


def test_a_person_s_information_is_that_of_bradley_and_terry_where_people_agree() -> None:
    """Two equal modes, two answers, no differences between people: each answer tells p (1 - p) = 1/4."""
    information = person_information([(0, 1)], Scenario((1, 1), 2, (), subject_sd=0.0, side_effect=0.0), 2)
    # The free coordinate is the difference divided by the square root of 2.
    assert information == pytest.approx(np.diag([2 * 0.25 * 2, 2 * 0.25]))


def test_pairs_are_by_the_places_of_their_modes() -> None:
    assert mode_pairs(STUDY) == ((0, 1), (0, 2), (1, 2))
