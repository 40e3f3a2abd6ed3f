"""Stuck rates against exact distributions."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import beta, gamma

from analysis.stuck import stuck_rates
from analysis.stuck_contrasts import exact_p, stuck_contrasts
from data.responses import StuckTable


def events(stuck: dict[str, list[tuple[int, int]]], exposure_s: float = 60.0) -> StuckTable:
    """``(stuck, comparisons)`` by mode and participant."""
    rows = [
        (f"p{s}", f"p{s}.c{c}", mode, c < k, exposure_s)
        for mode, people in stuck.items()
        for s, (k, n) in enumerate(people)
        for c in range(n)
    ]
    return StuckTable(
        pd.DataFrame(rows, columns=["participant", "comparison", "mode", "stuck", "exposure_s"])
    )


ELEVEN = [(2, 4), (1, 4), (2, 4), (1, 4), (2, 4), (1, 4), (2, 4)]
NONE = [(0, 4)] * 7


def test_eleven_of_twenty_eight_has_the_known_interval():
    rates = stuck_rates(events({"M1": ELEVEN, "M2": NONE}))
    assert [(r.mode, r.comparisons, r.stuck) for r in rates] == [("M1", 28, 11), ("M2", 28, 0)]
    assert rates[0].rate_mean == pytest.approx(0.4)
    assert (rates[0].rate_hdi_low, rates[0].rate_hdi_high) == pytest.approx((0.237, 0.565), abs=6e-4)
    assert rates[1].rate_mean == pytest.approx(1 / 30)
    assert (rates[1].rate_hdi_low, rates[1].rate_hdi_high) == pytest.approx((0.0, 0.093), abs=6e-4)


@pytest.mark.parametrize("stuck", [0, 1, 5, 27, 28])
def test_intervals_hold_94_percent_and_no_shorter_one_does(stuck):
    (rate,) = stuck_rates(events({"M1": [(stuck, 28)]}))
    posterior = beta(1 + stuck, 29 - stuck)
    low, high = rate.rate_hdi_low, rate.rate_hdi_high
    assert posterior.cdf(high) - posterior.cdf(low) == pytest.approx(0.94, abs=1e-8)
    starts = np.linspace(0, 0.06, 601)
    assert high - low <= (posterior.ppf(starts + 0.94) - posterior.ppf(starts)).min() + 1e-6
    per_minute = gamma(1 + stuck, scale=1 / 28)
    held = per_minute.cdf(rate.per_minute_hdi_high) - per_minute.cdf(rate.per_minute_hdi_low)
    assert held == pytest.approx(0.94, abs=1e-8)
    assert rate.per_minute_mean == pytest.approx(per_minute.mean())


def test_people_who_differ_widen_the_rate_of_the_population():
    alike = stuck_rates(events({"M1": [(2, 4)] * 8}))[0].between
    apart = stuck_rates(events({"M1": [(4, 4), (0, 4)] * 4}))[0].between
    assert apart.sd > 1.3 * alike.sd
    assert alike.mean == pytest.approx(0.5, abs=1e-6)
    assert apart.mean == pytest.approx(0.5, abs=1e-6)


def test_a_comparison_each_says_what_independent_comparisons_say():
    # With one comparison a person the correlation has no bearing, and the rate is Beta(1 + k, 1 + n - k).
    between = stuck_rates(events({"M1": [(1, 1)] * 3 + [(0, 1)] * 9}))[0].between
    exact = beta(4, 10)
    assert between.mean == pytest.approx(exact.mean(), abs=1e-4)
    assert between.sd == pytest.approx(exact.std(), abs=1e-4)
    assert exact.cdf(between.hdi_high) - exact.cdf(between.hdi_low) == pytest.approx(0.94, abs=2e-3)


def test_two_modes_are_told_apart_exactly():
    table = events({"M1": ELEVEN, "M2": NONE})
    (contrast,) = stuck_contrasts(table, stuck_rates(table))
    assert contrast.p_fisher == pytest.approx(2.884e-4, rel=1e-3)
    rng = np.random.default_rng(1)
    sampled = (rng.beta(12, 18, 10**6) > rng.beta(1, 29, 10**6)).mean()
    assert contrast.p_i_above_j == pytest.approx(sampled, abs=1e-4)


def test_no_exposure_has_no_rate_per_minute():
    (rate,) = stuck_rates(events({"M1": [(1, 4)]}, exposure_s=0.0))
    assert np.isnan(rate.per_minute_mean)


def test_one_stratum_is_fishers_test_and_strata_follow_each_person():
    assert exact_p(np.array([[11, 28]]), np.array([[0, 28]])) == pytest.approx(2.884e-4, rel=1e-3)
    # One person always stuck, one never: between modes nothing differs within either.
    assert exact_p(np.array([[4, 4], [0, 4]]), np.array([[4, 4], [0, 4]])) == pytest.approx(1.0)
    # Each of three people is stuck in the one comparison with the first mode alone: (1/2) ** 3, two-sided.
    once, never = np.array([[1, 1]] * 3), np.array([[0, 1]] * 3)
    assert exact_p(once, never) == pytest.approx(0.25)


def test_people_who_differ_widen_the_rate_per_minute_too():
    alike = stuck_rates(events({"M1": [(2, 4)] * 8}))[0].per_minute_between
    apart = stuck_rates(events({"M1": [(4, 4), (0, 4)] * 4}))[0].per_minute_between
    assert alike is not None
    assert apart is not None
    assert apart.sd > 1.1 * alike.sd
    assert alike.hdi_low < 16 / 32 < alike.hdi_high
