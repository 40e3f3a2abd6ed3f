"""Tests of many things on the same people: the whole list has the error rate that it says."""

from itertools import product

import numpy as np
import pytest

from analysis.sign_flips import flipped_tests

CONTRIBUTIONS = np.array(
    [
        [2.0, 0.3, -1.0],
        [1.5, -0.2, -0.4],
        [0.9, 0.8, -0.7],
        [1.1, 0.1, 0.2],
        [0.7, -0.6, -1.3],
        [1.3, 0.4, 0.5],
    ]
)


def scores(contributions):
    return np.abs(contributions.sum(axis=0)) / np.sqrt((contributions**2).sum(axis=0))


def test_p_values_are_those_of_all_patterns_of_signs_gone_through_by_hand():
    every = [scores(np.array(signs)[:, None] * CONTRIBUTIONS) for signs in product([1, -1], repeat=6)]
    observed = scores(CONTRIBUTIONS)
    flipped = flipped_tests(CONTRIBUTIONS, seed=1)
    alone = np.mean(np.array(every) >= observed - 1e-9, axis=0)
    np.testing.assert_allclose(flipped.alone, alone)
    assert flipped.alone[0] == 2 / 64

    by_size = np.argsort(-observed)
    least = 0.0
    for place, test in enumerate(by_size):
        largest_left = np.array(every)[:, by_size[place:]].max(axis=1)
        least = max(least, np.mean(largest_left >= observed[test] - 1e-9))
        assert flipped.in_list[test] == pytest.approx(least)


def test_people_without_a_contribution_change_nothing():
    with_others = np.vstack([CONTRIBUTIONS, np.zeros((20, 3))])
    one, other = flipped_tests(CONTRIBUTIONS, seed=1), flipped_tests(with_others, seed=2)
    np.testing.assert_array_equal(one.in_list, other.in_list)


def test_random_flips_of_many_people_say_what_all_flips_say():
    rng = np.random.default_rng(4)
    twelve = rng.normal(0.4, 1.0, (12, 5))
    thirteen = np.vstack([twelve, np.full((1, 5), 1e-12)])
    np.testing.assert_allclose(
        flipped_tests(twelve, seed=1).in_list, flipped_tests(thirteen, seed=1).in_list, atol=0.03
    )


def test_one_test_that_is_repeated_a_hundred_times_stays_as_clear_as_it_is_alone():
    repeated = np.repeat(CONTRIBUTIONS[:, :1], 100, axis=1)
    assert flipped_tests(repeated, seed=1).in_list == pytest.approx(np.full(100, 2 / 64))


def test_a_test_to_which_nobody_contributes_never_passes():
    flipped = flipped_tests(np.column_stack([CONTRIBUTIONS[:, 0], np.zeros(6)]), seed=1)
    assert flipped.in_list[1] == 1.0
