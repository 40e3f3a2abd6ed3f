"""Planning: simulated answers follow the planted model, and conclusions are counted as they are drawn."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.model import cumulative_log_probabilities
from analysis.power import FILES, Scenario, power, simulate_answers, write_power
from data.answers import SCALES
from data.errors import InputError
from data.study_file import read_study

STUDY = read_study("carmichael2017")
PLAIN = Scenario(worth=(1.0, 2.0, 4.0), subject_sd=0.0, side_effect=0.3)


@pytest.mark.parametrize(("levels", "cuts"), [(2, ()), (3, (0.5,)), (5, (0.5, 1.5))])
def test_simulated_answers_have_the_probabilities_of_the_planted_model(levels, cuts) -> None:
    scenario = replace(PLAIN, levels=levels, cuts=cuts)
    rows = simulate_answers(STUDY, scenario, 3000, np.random.default_rng(1)).rows
    pair = rows[(rows["mode_a"] == "M3") & (rows["mode_b"] == "M1")]
    eta = np.log(4.0) + 0.3
    expected = np.exp(cumulative_log_probabilities(np.array([eta]), np.array(cuts), levels))[0]
    shares = np.array([(pair["response"] == answer).mean() for answer in SCALES[levels]])
    assert shares == pytest.approx(expected, abs=4 * 0.5 / np.sqrt(len(pair)))


def test_answers_follow_the_study_s_own_schedule() -> None:
    study = STUDY.model_copy(update={"protocol": STUDY.protocol.model_copy(update={"attention_checks": 1})})
    rows = simulate_answers(study, PLAIN, 4, np.random.default_rng(1)).rows
    assert len(rows) == 4 * 6
    assert (rows["mode_a"] == "M1").sum() == (rows["mode_b"] == "M1").sum()
    assert not (rows["mode_a"] == rows["mode_b"]).any()


def test_a_mode_far_above_the_others_is_found_and_equals_hardly_ever_are() -> None:
    clear = power(STUDY, Scenario((1, 1, 40), subject_sd=0.2), [8], replicates=6, seed=1, n_jobs=1)
    assert (clear.points[0].right, clear.points[0].wrong) == (6, 0)
    even = power(STUDY, Scenario((1, 1, 1.001)), [7], replicates=6, seed=1, n_jobs=1)
    assert even.points[0].right <= 2
    assert clear.enough(0.8) == 8
    assert even.enough(0.8) is None


def test_the_result_does_not_depend_on_the_number_of_processes(tmp_path) -> None:
    scenario = Scenario((1, 1, 2))
    one, two = (power(STUDY, scenario, [4, 6], replicates=3, seed=2, n_jobs=n) for n in (1, 2))
    assert one == two
    paths = write_power(one, 0.8, tmp_path / "out")
    assert [path.name for path in paths] == list(FILES)
    assert all(path.stat().st_size > 0 for path in paths)


@pytest.mark.parametrize(
    ("scenario", "said"),
    [
        (Scenario((1, 2)), "2 numbers for 3 modes: M1, M2, M3"),
        (Scenario((1, 2, 2)), "share the highest worth"),
        (Scenario((1, 2, -3)), "positive number"),
        (Scenario((1, 2, 3), levels=4), "4 is not one of: 2, 3, 5"),
        (Scenario((1, 2, 3), levels=5), "5 levels need 2 increasing positive numbers, not 0.5"),
        (Scenario((1, 2, 3), levels=5, cuts=(1.0, 0.5)), "increasing"),
    ],
)
def test_assumptions_that_make_no_study_are_refused_before_any_work(scenario, said) -> None:
    with pytest.raises(InputError, match=said):
        power(STUDY, scenario, [7], replicates=10, seed=1, n_jobs=1)
