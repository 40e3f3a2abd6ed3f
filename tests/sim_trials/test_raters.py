"""Simulated raters answer from what was felt, and only from that."""

import numpy as np
import pytest

from data.errors import InputError
from data.study import Question
from data.study_file import read_study
from sim_trials.raters import (
    Experience,
    Rater,
    answer,
    check_rehearsal,
    draw_rater,
    experience,
    felt_difference,
)

FORCE = Question(name="Q3", wording="Which?", short="most force", levels=5, rehearsal={"force_mean_n": 1.0})
PLAIN = Rater({"force_mean_n": 1.0}, {"force_mean_n": 0.0}, side_bias=0.0, tie_below=0.4, much_above=1.5)


def felt(force: float, stuck: float = 0.0) -> Experience:
    return Experience({"force_mean_n": force}, stuck)


def answers(a: Experience, b: Experience, question: Question = FORCE, number: int = 2000) -> list[str]:
    rng = np.random.default_rng(5)
    return [answer(question, PLAIN, a, b, rng) for _ in range(number)]


def test_the_side_with_more_force_is_named_more_often_the_larger_the_ratio() -> None:
    shares = [
        np.mean([given in ("A>B", "A>>B") for given in answers(felt(20.0 * ratio), felt(20.0))])
        for ratio in (1.0, 1.3, 2.0)
    ]
    assert shares[0] < shares[1] < shares[2]
    assert shares[2] > 0.8


def test_equal_experience_gives_ties_and_no_side_more_often_than_the_other() -> None:
    given = answers(felt(20.0), felt(20.0))
    a = sum(g in ("A>B", "A>>B") for g in given)
    b = sum(g in ("B>A", "B>>A") for g in given)
    assert given.count("A=B") > 400
    # Under equal chances the difference of the two counts has a standard deviation below sqrt(2000).
    assert abs(a - b) < 4 * np.sqrt(2000)


def test_exchanging_the_sides_mirrors_the_felt_difference() -> None:
    assert felt_difference(felt(30.0), felt(20.0), "force_mean_n") == pytest.approx(
        -felt_difference(felt(20.0), felt(30.0), "force_mean_n")
    )
    assert felt_difference(felt(1, 1.0), felt(1, 0.0), "stuck_share") > 0


def test_what_one_side_never_met_is_not_compared() -> None:
    assert felt_difference(felt(30.0), Experience({}, 1.0), "force_mean_n") == 0.0


def test_laps_without_a_metric_are_left_out_of_its_mean() -> None:
    laps = [{"x": 1.0, "y": float("nan")}, {"x": 3.0, "y": 4.0}, {"x": 5.0}]
    condensed = experience(laps, [True, False, False])
    assert condensed.metrics == {"x": 3.0, "y": 4.0}
    assert condensed.stuck_share == pytest.approx(1 / 3)


def test_every_answer_is_on_the_scale_of_its_question() -> None:
    for levels in (2, 3, 5):
        question = FORCE.model_copy(update={"levels": levels})
        given = set(answers(felt(24.0), felt(20.0), question))
        assert given == set(question.scale)


def test_people_differ_and_the_same_seed_is_the_same_person() -> None:
    study = read_study("carmichael2017")
    first, again, other = (draw_rater(study, np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert first == again
    assert first != other


def test_a_metric_that_does_not_exist_is_refused_with_the_valid_ones() -> None:
    study = read_study("carmichael2017")
    question = study.questions[0].model_copy(update={"rehearsal": {"beauty": 1.0}})
    broken = study.model_copy(update={"questions": (question,)})
    with pytest.raises(
        InputError, match=r"questions\.1\.rehearsal: 'beauty' is not one of: force_mean_n, stuck_share"
    ):
        check_rehearsal(broken, ["force_mean_n"])
