"""What looking early does to the error rate, against figures of independent simulations."""

from itertools import combinations

import numpy as np
import pytest

from analysis.looks import look_errors
from analysis.observed_design import ObservedDesign
from analysis.power.scenario import Scenario

THREE = ((0, 1), (0, 2), (1, 2))


def design(repetitions: int, subject_sd: float = 0.7, *, is_pooled: bool = False) -> ObservedDesign:
    scenario = Scenario((1, 1, 1), 3, (0.5,), subject_sd, 0.1)
    return ObservedDesign(THREE, repetitions, scenario, 40.0, is_pooled)


def mean_errors(asked: ObservedDesign, people: range, chance: float = 0.95) -> tuple[float, float]:
    found = [look_errors(asked, tuple(map(float, people)), chance, seed) for seed in range(5)]
    return float(np.mean([e.once for e in found])), float(np.mean([e.stopping for e in found]))


def test_looks_every_5_from_10_to_60_people_are_wrong_in_10_per_cent() -> None:
    """A prototype's simulation, three levels, 15 comparisons a person, person sd 0.7."""
    _, stopping = mean_errors(design(repetitions=5), range(10, 61, 5))
    assert stopping == pytest.approx(0.10, abs=0.015)


def test_higher_limits_are_wrong_as_rarely_as_the_prototype_found() -> None:
    for chance, wrong in ((0.97, 0.048), (0.98, 0.029), (0.99, 0.012)):
        _, stopping = mean_errors(design(repetitions=5), range(10, 61, 5), chance)
        assert stopping == pytest.approx(wrong, abs=0.015)


def test_looking_after_each_person_by_the_pooled_estimate_raises_3_7_to_about_21_per_cent() -> None:
    """An audit measured 3.7 and 20.7 % by person 40, and did not say of which people or estimate.

    The person sd of 1/3 is chosen so that a single look errs as often; only the second figure is a check.
    """
    once, stopping = mean_errors(design(2, 1 / 3, is_pooled=True), range(1, 41))
    assert once == pytest.approx(0.037, abs=0.006)
    assert stopping == pytest.approx(0.207, abs=0.03)


def test_the_model_of_a_report_errs_less_than_a_pooled_estimate_where_people_differ() -> None:
    hierarchical, pooled = design(2), design(2, is_pooled=True)
    assert mean_errors(hierarchical, range(1, 41))[1] < 0.5 * mean_errors(pooled, range(1, 41))[1]


def test_a_single_look_is_wrong_once() -> None:
    errors = look_errors(design(2), (20.0,))
    assert errors.once == errors.stopping
    assert 0.005 < errors.once < 0.04


def test_the_first_place_of_many_modes_is_judged_against_all_of_them() -> None:
    """Against draws from the posterior itself, of a design with unequal numbers of comparisons."""
    from analysis.looks import _is_named

    pairs = tuple(combinations(range(5), 2))[:8]
    incidence = np.zeros((len(pairs), 5))
    for row, (i, j) in enumerate(pairs):
        incidence[row, [i, j]] = 1.0, -1.0
    covariance = np.linalg.pinv(incidence.T @ incidence + 0.2 * (np.eye(5) - 0.2))
    rng = np.random.default_rng(1)
    ability = 2.0 * rng.standard_normal((200, 5))
    noise = rng.multivariate_normal(np.zeros(5), covariance, size=20_000, method="svd")
    leader = ability.argmax(axis=1)
    chance = np.array(
        [((a + noise).argmax(axis=1) == k).mean() for a, k in zip(ability, leader, strict=True)]
    )
    clear = np.abs(chance - 0.8) > 0.03
    assert 0.2 < (chance > 0.8).mean() < 0.8
    assert np.array_equal(_is_named(ability, covariance, 0.8)[clear], (chance > 0.8)[clear])
