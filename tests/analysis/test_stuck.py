"""Stuck rates against exact distributions."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import beta

from analysis.results import Quantity
from analysis.stuck import stuck_rates
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


def printed(rate: Quantity) -> tuple[float, float, float]:
    return rate.mean, rate.hdi_low, rate.hdi_high


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


def test_events_over_people_and_per_minute_come_from_one_posterior():
    rate, none = stuck_rates(events({"M1": ELEVEN, "M2": NONE}, exposure_s=60 * 53 / 28))
    assert (rate.participants, rate.participants_stuck) == (7, 7)
    assert (none.participants, none.participants_stuck) == (7, 0)
    assert rate.exposure_min == pytest.approx(53.0)
    assert printed(rate.between) == pytest.approx((0.3855, 0.2094, 0.5654), abs=3e-4)
    assert printed(rate.per_minute_between) == pytest.approx((0.2546, 0.0984, 0.4225), abs=3e-4)
    assert printed(none.between) == pytest.approx((0.0412, 0.0001, 0.1219), abs=1e-4)
    assert printed(none.per_minute_between) == pytest.approx((0.0135, 0.0000, 0.0390), abs=1e-4)


def test_a_hundred_people_without_an_event_have_a_rate_near_zero():
    (rate,) = stuck_rates(events({"M1": [(0, 4)] * 100}, exposure_s=60 * 53 / 28))
    assert printed(rate.between) == pytest.approx((0.0034, 0.0001, 0.0084), abs=1e-4)
    assert printed(rate.per_minute_between) == pytest.approx((0.0014, 0.0000, 0.0036), abs=1e-4)


def test_people_who_differ_widen_the_rates_in_people_in_general():
    alike, apart = (stuck_rates(events({"M1": people}))[0] for people in ([(2, 4)] * 8, [(4, 4), (0, 4)] * 4))
    assert apart.between.sd > 1.3 * alike.between.sd
    assert apart.per_minute_between.sd > 1.1 * alike.per_minute_between.sd
    assert alike.between.hdi_low < 0.5 < alike.between.hdi_high
    assert alike.per_minute_between.hdi_low < np.log(2) < alike.per_minute_between.hdi_high
    # These comparisons are the same 16 of 32, whoever they were.
    assert apart.per_minute.mean == pytest.approx(alike.per_minute.mean, rel=1e-9)
    assert apart.rate_mean == alike.rate_mean


def test_minutes_count_only_where_they_are_known():
    table = events({"M1": [(1, 4)] * 4})
    table.rows.loc[::2, "exposure_s"] = np.nan
    (rate,) = stuck_rates(table)
    assert rate.exposure_min == pytest.approx(8.0)
    # The other comparisons count as long as these, not as events in no time.
    (known,) = stuck_rates(events({"M1": [(1, 4)] * 4}))
    assert rate.per_minute.mean == pytest.approx(known.per_minute.mean)


def test_no_exposure_has_no_rate_per_minute():
    (rate,) = stuck_rates(events({"M1": [(1, 4)] * 3}, exposure_s=0.0))
    assert rate.per_minute is None
    assert rate.per_minute_between is None
    assert rate.between is not None


def test_nothing_follows_for_people_in_general_if_nobody_knows_who_they_were():
    table = events({"M1": [(3, 8)]})
    (rate,) = stuck_rates(replace(table, rows=table.rows.assign(participant="")))
    assert (rate.participants, rate.between, rate.per_minute_between) == (0, None, None)
    assert rate.per_minute is not None


def test_a_mode_without_comparisons_has_no_rate_over_people():
    (rate,) = stuck_rates(events({"M1": NONE}), ("M2",))
    assert (rate.comparisons, rate.between, rate.per_minute) == (0, None, None)
    assert (rate.rate_hdi_low, rate.rate_hdi_high) == pytest.approx((0.0, 0.94))
