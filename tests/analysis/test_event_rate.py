"""Rates over people against brute force, and on grids that reach farther and are finer."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.hermite_e import hermegauss

from analysis.event_likelihood import Exposures
from analysis.event_rate import (
    LOG_RATE_SD,
    MEDIAN_RATE,
    SPREAD_SCALE,
    USUAL,
    RatePosterior,
    exposures,
    rate_of_comparisons,
    rate_over_people,
)

MINUTES = 53 / 28
"""Of a comparison in a study of 28 comparisons and 53 minutes under a mode."""
LAYOUTS = {
    "none of 28": [(0, 4)] * 7,
    "11 of 28, all alike": [(2, 4), (1, 4), (2, 4), (1, 4), (2, 4), (1, 4), (2, 4)],
    "11 of 28, in four people": [(4, 4), (4, 4), (2, 4), (1, 4), (0, 4), (0, 4), (0, 4)],
    "all of 28": [(4, 4)] * 7,
    "none of 400": [(0, 4)] * 100,
}


def layout(people: list[tuple[int, int]], minutes: float = MINUTES) -> Exposures:
    """``(with an event, comparisons)`` of each person."""
    person = np.concatenate([np.full(n, k) for k, (_, n) in enumerate(people)])
    has_event = np.concatenate([np.arange(n) < k for k, n in people])
    return Exposures(person, has_event, np.full(len(person), minutes))


def uneven() -> Exposures:
    """Twenty people with different lengths of comparisons, none of them the same."""
    rng = np.random.default_rng(3)
    person = np.repeat(np.arange(20), 3)
    rate = 0.2 * np.exp(rng.normal(size=20))[person]
    minutes = rng.lognormal(0.6, 0.5, 60)
    return Exposures(person, rng.random(60) < -np.expm1(-rate * minutes), minutes)


def weighted_draws(data: Exposures, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Draws of the priors with their likelihood, own rates by Gauss-Hermite quadrature person by person."""
    rng = np.random.default_rng(11)
    log_rate = np.log(MEDIAN_RATE) + LOG_RATE_SD * rng.normal(size=n)
    spread = np.abs(SPREAD_SCALE * rng.normal(size=n))
    z, weight = hermegauss(50)
    rate = np.exp(log_rate[:, None] + spread[:, None] * z)
    log_likelihood = np.zeros(n)
    of_kind: dict[tuple[tuple[float, bool], ...], np.ndarray] = {}
    for person in range(data.person.max() + 1):
        own = data.person == person
        key = tuple(sorted(zip(data.minutes[own], data.has_event[own], strict=True)))
        if key not in of_kind:
            each = np.ones_like(rate)
            for minutes, has_event in key:
                nothing = np.exp(-rate * minutes)
                each *= 1.0 - nothing if has_event else nothing
            of_kind[key] = np.log(each @ (weight / weight.sum()) + 1e-300)
        log_likelihood += of_kind[key]
    weights = np.exp(log_likelihood - log_likelihood.max())
    return log_rate, spread, weights / weights.sum()


def share_of(log_rate: np.ndarray, spread: np.ndarray, minutes: float) -> np.ndarray:
    z, weight = hermegauss(50)
    return -np.expm1(-minutes * np.exp(log_rate[:, None] + spread[:, None] * z)) @ (weight / weight.sum())


def numbers(posterior: RatePosterior) -> np.ndarray:
    """Everything that is printed: means and ends of intervals of the rate and of the share."""
    rate, share = posterior.rate(), posterior.share(MINUTES)
    return np.array([rate.mean, *rate.hdi(), share.mean, *share.hdi()])


# Mean and 94 % HDI of the median person's rate a minute, then of the share of comparisons.
PINNED = {
    "none of 28": (0.0135018, 2.1463e-05, 0.0389636, 0.0411915, 5.262e-05, 0.121847),
    "11 of 28, all alike": (0.254615, 0.0984336, 0.422484, 0.385475, 0.209393, 0.56542),
    "11 of 28, in four people": (0.267047, 0.00270053, 0.6979, 0.412903, 0.180698, 0.650355),
    "all of 28": (12.521, 0.462351, 36.0888, 0.971178, 0.881088, 1.0),
    "none of 400": (0.0014027, 1.6514e-05, 0.00356557, 0.00342018, 5.275e-05, 0.00840335),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_rates_over_people_have_their_known_values(name):
    assert numbers(rate_over_people(layout(LAYOUTS[name]))) == pytest.approx(PINNED[name], rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("name", [*LAYOUTS, "different lengths"])
def test_a_grid_twice_as_fine_that_reaches_twice_as_far_says_the_same(name):
    data = uneven() if name == "different lengths" else layout(LAYOUTS[name])
    wide = replace(USUAL, rates=2 * USUAL.rates, spreads=2 * USUAL.spreads, drop=2 * USUAL.drop)
    for posterior in (rate_over_people, rate_of_comparisons):
        usual, finer = posterior(data), posterior(data, wide)
        assert finer.log_rate[0] < usual.log_rate[0] < usual.log_rate[-1] < finer.log_rate[-1]
        assert numbers(usual) == pytest.approx(numbers(finer), rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("name", LAYOUTS)
def test_rates_over_people_are_those_of_brute_force(name):
    data = layout(LAYOUTS[name])
    log_rate, spread, weight = weighted_draws(data, 100_000)
    rate, share = np.exp(log_rate), share_of(log_rate, spread, MINUTES)
    effective = 1.0 / (weight**2).sum()
    assert effective > 500
    posterior = rate_over_people(data)
    for table, values in ((posterior.rate(), rate), (posterior.share(MINUTES), share)):
        # Compared on the logarithm: a draw of the rate itself may be any number of times its mean.
        mean = weight @ np.log(values)
        sd = np.sqrt(weight @ (np.log(values) - mean) ** 2)
        at = (np.arange(2000) + 0.5) / 2000
        assert np.log(table.quantile(at)).mean() == pytest.approx(
            mean, abs=5 * sd / np.sqrt(effective) + 0.01
        )
        low, high = table.hdi()
        held = weight[(values >= low) & (values <= high)].sum()
        assert held == pytest.approx(0.94, abs=5 * np.sqrt(0.94 * 0.06 / effective) + 0.002)
        assert weight @ values == pytest.approx(
            table.mean, abs=5 * np.sqrt((weight**2) @ (values - table.mean) ** 2) + 1e-3 * table.mean
        )


def test_a_mode_without_an_event_is_not_far_above_three_divided_by_the_time():
    # With no event in T minutes a rate above 3 / T has a chance of 5 % at most to be missed.
    for people, upper in ((7, 1.5), (100, 2.0)):
        low, high = rate_over_people(layout([(0, 4)] * people)).rate().hdi()
        assert low < 0.01 * high
        assert 0.4 < high / (3.0 / (people * 4 * MINUTES)) < upper


def test_one_rate_for_all_is_the_posterior_of_a_binomial_count():
    posterior = rate_of_comparisons(layout(LAYOUTS["11 of 28, all alike"]))
    log_rate = np.linspace(-12.0, 6.0, 200_001)
    chance = -np.expm1(-np.exp(log_rate) * MINUTES)
    log_p = 11 * np.log(chance) - 17 * np.exp(log_rate) * MINUTES
    log_p -= 0.5 * ((log_rate - np.log(MEDIAN_RATE)) / LOG_RATE_SD) ** 2
    weight = np.exp(log_p - log_p.max())
    assert posterior.rate().mean == pytest.approx(weight @ np.exp(log_rate) / weight.sum(), rel=1e-6)
    assert posterior.share(MINUTES).mean == pytest.approx(weight @ chance / weight.sum(), rel=1e-6)


def test_a_comparison_counts_once_however_often_it_happened():
    # Every comparison with an event says only that the rate is not low: the upper end is the prior's.
    few, many = (rate_of_comparisons(layout([(4, 4)] * people)).rate() for people in (7, 700))
    assert few.hdi()[1] > 9.0
    assert many.hdi()[1] > 9.0
    assert many.hdi()[0] > 2.0 * few.hdi()[0]


def test_people_who_are_alike_are_counted_as_one_by_one():
    alike = layout([(2, 4), (2, 4), (0, 4), (1, 4)])
    # Seventeen lengths that differ in the tenth digit are too many to look for people who are alike.
    apart = replace(alike, minutes=alike.minutes * (1.0 + 1e-10 * np.arange(16)))
    more = Exposures(
        np.concatenate([apart.person, [4]]), np.append(apart.has_event, False), np.append(apart.minutes, 1e-9)
    )
    assert len(np.unique(more.minutes)) == 17
    assert numbers(rate_over_people(more)) == pytest.approx(numbers(rate_over_people(alike)), rel=1e-3)


def test_lengths_that_are_not_known_take_the_median_of_those_that_are():
    people = np.array(["a", "a", "b", "b"], dtype=object)
    has_event = np.array([True, False, False, False])
    data, usual = exposures(people, has_event, np.array([1.0, np.nan, 3.0, 0.0]))
    assert usual == 2.0
    assert data.minutes.tolist() == [1.0, 2.0, 3.0, 2.0]
    assert data.person.tolist() == [0, 0, 1, 1]
    assert exposures(people, has_event, np.full(4, np.nan))[1] == 2.0


def test_a_thousand_people_are_a_matter_of_the_grid_alone():
    data = layout([(1, 4), (0, 4), (2, 4), (0, 4)] * 250)
    posterior = rate_over_people(data)
    low, high = posterior.share(MINUTES).hdi()
    assert posterior.log_density.shape == (USUAL.rates, USUAL.spreads)
    # Between people of shares 0, 1/4 and 1/2 in these numbers the mean is 3/16.
    assert low < 3 / 16 < high
    assert high - low < 0.03
