"""Two modes' stuck rates: what these people's comparisons say, and what they say of people in general."""

from itertools import product

import numpy as np
import pytest

from analysis.stuck import stuck_rates
from analysis.stuck_contrasts import exact_p, p_exchanged, stuck_contrasts
from tests.analysis.test_stuck import ELEVEN, NONE, events

FOUR_PEOPLE = [(4, 4), (4, 4), (2, 4), (1, 4), (0, 4), (0, 4), (0, 4)]
"""Eleven of 28 again, in four of seven people."""


def contrast_of(first, second):
    table = events({"M1": first, "M2": second}, exposure_s=60 * 53 / 28)
    (contrast,) = stuck_contrasts(table, stuck_rates(table))
    return contrast


def test_two_modes_are_told_apart_exactly():
    contrast = contrast_of(ELEVEN, NONE)
    assert contrast.p_fisher == pytest.approx(2.884e-4, rel=1e-3)
    rng = np.random.default_rng(1)
    sampled = (rng.beta(12, 18, 10**6) > rng.beta(1, 29, 10**6)).mean()
    assert contrast.p_i_above_j == pytest.approx(sampled, abs=1e-4)


def test_four_people_are_sure_of_themselves_and_say_less_of_people_in_general():
    contrast = contrast_of(FOUR_PEOPLE, NONE)
    assert contrast.p_fisher == pytest.approx(2.884e-4, rel=1e-3)
    assert contrast.p_within_people == pytest.approx(4.373e-5, rel=1e-3)
    assert contrast.p_i_above_j == pytest.approx(0.99994, abs=1e-5)
    # Had the modes been exchanged for any of the four, two choices of 2 ** 4 are as far apart.
    assert contrast.p_by_people == pytest.approx(0.125)
    assert (contrast.people_i_higher, contrast.people_j_higher) == (4, 0)
    assert contrast.p_i_above_j_people == pytest.approx(0.9971, abs=3e-4)
    # The chance to be wrong is fifty times that of the independent comparisons.
    assert (1 - contrast.p_i_above_j_people) > 40 * (1 - contrast.p_i_above_j)


def test_the_chance_in_people_in_general_is_that_of_draws_from_both_posteriors():
    table = events({"M1": [(1, 4), (0, 4), (2, 4), (0, 4)], "M2": [(0, 4), (0, 4), (1, 4), (0, 4)]})
    rates = stuck_rates(table)
    (contrast,) = stuck_contrasts(table, rates)
    rng = np.random.default_rng(2)
    first, second = (rate.share_of_people.quantile(rng.random(400_000)) for rate in rates)
    assert contrast.p_i_above_j_people == pytest.approx((first > second).mean(), abs=4e-3)


def test_exchanging_the_order_of_the_modes_exchanges_what_is_said():
    there, back = contrast_of(ELEVEN, FOUR_PEOPLE), contrast_of(FOUR_PEOPLE, ELEVEN)
    assert back.p_i_above_j_people == pytest.approx(1 - there.p_i_above_j_people, abs=1e-3)
    assert back.p_by_people == pytest.approx(there.p_by_people)
    assert (back.people_i_higher, back.people_j_higher) == (there.people_j_higher, there.people_i_higher)


def test_one_stratum_is_fishers_test_and_strata_follow_each_person():
    assert exact_p(np.array([[11, 28]]), np.array([[0, 28]])) == pytest.approx(2.884e-4, rel=1e-3)
    # One person always stuck, one never: between modes nothing differs within either.
    assert exact_p(np.array([[4, 4], [0, 4]]), np.array([[4, 4], [0, 4]])) == pytest.approx(1.0)
    # Each of three people is stuck in the one comparison with the first mode alone: (1/2) ** 3, two-sided.
    once, never = np.array([[1, 1]] * 3), np.array([[0, 1]] * 3)
    assert exact_p(once, never) == pytest.approx(0.25)
    # People who had one mode alone, or were stuck in all or nothing, leave it as it is.
    more = np.array([[3, 4], [0, 2]]), np.array([[0, 0], [0, 5]])
    assert exact_p(np.concatenate([once, more[0]]), np.concatenate([never, more[1]])) == pytest.approx(0.25)


@pytest.mark.parametrize("seed", range(4))
def test_the_test_by_people_counts_every_choice_of_signs(seed):
    rng = np.random.default_rng(seed)
    n = rng.integers(1, 7, size=(2, 9))
    k = rng.binomial(n, 0.4)
    differences = k[0] / n[0] - k[1] / n[1]
    signs = np.array(list(product([-1, 1], repeat=9)))
    expected = (np.abs(signs @ differences) >= abs(differences.sum()) - 1e-9).mean()
    assert p_exchanged(np.stack([k[0], n[0]], 1), np.stack([k[1], n[1]], 1)) == pytest.approx(expected)


def test_many_people_with_many_numbers_of_comparisons_stay_cheap():
    rng = np.random.default_rng(5)
    n = rng.integers(1, 30, size=(2, 400))
    k = rng.binomial(n, 0.4)
    differences = k[0] / n[0] - k[1] / n[1]
    signs = rng.choice([-1, 1], size=(20_000, 400))
    sampled = (np.abs(signs @ differences) >= abs(differences.sum())).mean()
    p = p_exchanged(np.stack([k[0], n[0]], 1), np.stack([k[1], n[1]], 1))
    assert p == pytest.approx(sampled, abs=0.015)


def test_people_who_had_one_mode_alone_say_nothing_of_the_difference():
    first, second = np.array([[2, 2], [1, 1], [3, 4]]), np.array([[0, 0], [0, 1], [0, 4]])
    assert p_exchanged(first, second) == pytest.approx(0.5)
    assert p_exchanged(first[:1], second[:1]) == 1.0
