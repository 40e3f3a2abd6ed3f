"""Planning: simulated answers follow the planted model, and conclusions are counted as they are drawn."""

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from analysis.model import cumulative_log_probabilities
from analysis.power import (
    Conclusion,
    Plan,
    Scenario,
    cuts_for_ties,
    draw_answers,
    glance,
    power,
    tie_share,
    write_power,
)
from analysis.power.files import FILES
from analysis.power.plan import mode_pairs
from analysis.results import Draws, ModeResult, QuestionFit
from data.answers import SCALES
from data.errors import InputError
from data.responses import QuestionScale
from data.study_file import read_study

STUDY = read_study("carmichael2017")
PLAIN = Scenario(worth=(1.0, 2.0, 4.0), subject_sd=0.0, side_effect=0.3)
SMALL = Plan(STUDY, Scenario((1, 1, 2)), participants=(4, 6), repetitions=(1, 2), replicates=2, seed=2)


@pytest.mark.parametrize(("levels", "cuts"), [(2, ()), (3, (0.5,)), (5, (0.5, 1.5))])
def test_simulated_answers_have_the_probabilities_of_the_planted_model(levels, cuts) -> None:
    scenario = replace(PLAIN, levels=levels, cuts=cuts)
    rows = draw_answers(STUDY, scenario, 3000, np.random.default_rng(1)).rows
    pair = rows[(rows["mode_a"] == "M3") & (rows["mode_b"] == "M1")]
    eta = np.log(4.0) + 0.3
    expected = np.exp(cumulative_log_probabilities(np.array([eta]), np.array(cuts), levels))[0]
    shares = np.array([(pair["response"] == answer).mean() for answer in SCALES[levels]])
    assert shares == pytest.approx(expected, abs=4 * 0.5 / np.sqrt(len(pair)))


def test_answers_follow_the_study_s_own_schedule() -> None:
    study = STUDY.model_copy(update={"protocol": STUDY.protocol.model_copy(update={"attention_checks": 1})})
    rows = draw_answers(study, PLAIN, 4, np.random.default_rng(1)).rows
    assert len(rows) == 4 * 6
    assert (rows["mode_a"] == "M1").sum() == (rows["mode_b"] == "M1").sum()
    assert not (rows["mode_a"] == rows["mode_b"]).any()


@pytest.mark.parametrize("levels", [3, 5])
def test_a_wanted_share_of_ties_is_what_simulated_people_give(levels) -> None:
    people = Scenario((1, 2, 4), levels=levels, cuts=(0.5,) * (levels == 3) + (0.5, 1.5) * (levels == 5))
    cuts = cuts_for_ties(mode_pairs(STUDY), people, 0.3)
    people = replace(people, cuts=cuts)
    assert tie_share(mode_pairs(STUDY), people) == pytest.approx(0.3)
    rows = draw_answers(STUDY, people, 1500, np.random.default_rng(2)).rows
    assert (rows["response"] == "A=B").mean() == pytest.approx(0.3, abs=0.02)


def test_a_scale_without_ties_has_none_to_ask_for() -> None:
    with pytest.raises(InputError, match="2 levels has none"):
        cuts_for_ties(mode_pairs(STUDY), Scenario((1, 1, 2), levels=2, cuts=()), 0.2)


def fit_with(ability: list[list[float]], p_best: tuple[float, ...], *, ranked: bool = True) -> QuestionFit:
    """A fit with these draws, as far as conclusions read it."""
    draws = np.array(ability, dtype=float)[None]
    modes = tuple(ModeResult(f"M{k}", 0, 0, 0, 0, 0, 0, 0, 0, p, 0, ()) for k, p in enumerate(p_best))
    return QuestionFit(
        question=QuestionScale("q", "q", "q", 3),
        ranked=ranked,
        reason="",
        modes=modes,
        pairs=(),
        parameters=(),
        draws=Draws(draws, draws, MappingProxyType({}), np.zeros(draws.shape[:2], dtype=bool)),
        rhat_max=1.0,
        ess_min=1.0,
        divergences=0,
        warnings=(),
        n=1,
        n_participants=1,
        missing_pairs=(),
        hierarchical=True,
    )


THIRD_FIRST = [[-1.0, 0.0, 1.0]] * 99 + [[1.0, 0.0, -1.0]]


@pytest.mark.parametrize(
    ("conclusion", "worth", "verdict"),
    [
        (Conclusion("best"), (1, 1, 2), "right"),
        (Conclusion("best"), (1, 2, 1), "wrong"),
        (Conclusion("best"), (1, 1, 1), "wrong"),
        (Conclusion("best", 0.99), (1, 1, 2), "open"),
        (Conclusion("order"), (1, 2, 3), "right"),
        (Conclusion("order"), (2, 1, 3), "wrong"),
        (Conclusion("order", 0.995), (1, 2, 3), "open"),
        (Conclusion("pair", pair=(0, 1)), (1, 2, 3), "right"),
        (Conclusion("pair", pair=(1, 0)), (1, 2, 3), "right"),
        (Conclusion("pair", pair=(0, 1)), (2, 1, 3), "wrong"),
        (Conclusion("pair", pair=(0, 1)), (1, 1, 3), "wrong"),
    ],
)
def test_a_conclusion_is_right_wrong_or_left_open(conclusion, worth, verdict) -> None:
    assert conclusion.of(fit_with(THIRD_FIRST, (0.01, 0.0, 0.99)), Scenario(worth)) == verdict


CLOSE = [[-0.05, 0.0, 0.05]] * 90 + [[-0.3, 0.0, 0.3]] * 10


@pytest.mark.parametrize(
    ("conclusion", "worth", "verdict"),
    [
        (Conclusion("equal", 0.8), (1, 1, 1), "right"),
        (Conclusion("equal", 0.8), (1, 1.1, 1.15), "right"),
        (Conclusion("equal", 0.8), (1, 1, 1.3), "wrong"),
        (Conclusion("equal", 0.95), (1, 1, 1), "open"),
        (Conclusion("equal pair", 0.8, (0, 1)), (1, 1, 2), "right"),
        (Conclusion("equal pair", 0.8, (0, 2)), (1, 1, 2), "wrong"),
    ],
)
def test_equality_is_concluded_from_every_pair_that_it_is_about(conclusion, worth, verdict) -> None:
    assert conclusion.of(fit_with(CLOSE, (0.3, 0.3, 0.4)), Scenario(worth)) == verdict


def test_equality_at_a_glance_needs_more_than_a_hundred_people_where_a_best_mode_needs_forty() -> None:
    equal = Plan(STUDY, Scenario((1, 1, 1)), (7,), (2,), Conclusion("equal pair", 0.8, (0, 1)))
    shares = [glance(equal).share(n) for n in (20, 60, 120, 240)]
    assert shares[:2] == [0.0, 0.0]
    assert 0.3 < shares[2] < 0.6
    assert shares[3] > 0.7
    assert 200 < glance(equal).enough < 320
    apart = replace(equal, scenario=Scenario((1, 2, 1)))
    assert glance(apart).share(240) == 0.0


def test_a_study_that_cannot_be_ranked_concludes_nothing() -> None:
    fit = fit_with(THIRD_FIRST, (0.01, 0.0, 0.99), ranked=False)
    assert Conclusion().of(fit, Scenario((1, 1, 2))) == "unranked"


def test_a_mode_far_above_the_others_is_found_and_equals_hardly_ever_are() -> None:
    clear = Plan(STUDY, Scenario((1, 1, 40), subject_sd=0.2), (8,), (2,), replicates=6, seed=1)
    (found,) = power(clear).points
    assert (found.right, found.wrong, found.open, found.unranked) == (6, 0, 0, 0)
    (even,) = power(Plan(STUDY, Scenario((1, 1, 1)), (7,), (2,), replicates=20, seed=1)).points
    assert even.right == 0
    assert even.wrong < 20 / 3
    assert even.wrong + even.open == 20


def test_the_result_does_not_depend_on_the_number_of_processes(tmp_path) -> None:
    arrived = []
    one = power(SMALL, n_jobs=1, each=arrived.append)
    assert power(SMALL, n_jobs=2) == one
    assert tuple(arrived) == one.points
    assert [(p.repetitions, p.participants, p.answers) for p in one.points] == [
        (1, 4, 12), (1, 6, 18), (2, 4, 24), (2, 6, 36),
    ]  # fmt: skip
    paths = write_power(one, tmp_path / "out")
    assert [path.name for path in paths] == list(FILES)
    assert all(path.stat().st_size > 0 for path in paths)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"scenario": Scenario((1, 2))}, "2 numbers for 3 modes"),
        ({"scenario": Scenario((1, 2, -3))}, "positive number"),
        ({"scenario": Scenario((1, 2, float("nan")))}, "positive number"),
        ({"scenario": Scenario((1, 2, 1e9))}, "a million times"),
        ({"scenario": Scenario((1, 2, 3), levels=10)}, "10 is not one of: 2, 3, 4, 5, 6, 7, 8, 9"),
        ({"scenario": Scenario((1, 2, 3), levels=5)}, "5 levels need 2 increasing positive numbers, not 0.5"),
        ({"scenario": Scenario((1, 2, 3), levels=5, cuts=(1.0, 0.5))}, "increasing"),
        ({"scenario": Scenario((1, 2, 3), subject_sd=float("nan"))}, "subject_sd: nan is not between"),
        ({"scenario": Scenario((1, 2, 3), side_effect=11)}, "side_effect: 11 is not between"),
        ({"conclusion": Conclusion("order")}, "no order to be found"),
        ({"conclusion": Conclusion("best", 1.0)}, "confidence: 1 is not between"),
        ({"participants": (7, 0)}, "participants: one or more whole numbers from 1"),
        ({"repetitions": ()}, "repetitions: one or more whole numbers from 1"),
        ({"participants": (100_000,)}, "more than 20000 answers"),
        ({"wanted": 1.0}, "wanted: 1 is no share"),
        ({"replicates": 0}, "replicates: 0 is not between"),
    ],
)
def test_a_plan_that_makes_no_study_is_refused_before_any_work(changes, said) -> None:
    with pytest.raises(InputError, match=said):
        power(replace(SMALL, **changes))
