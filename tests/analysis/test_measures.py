"""Means of metrics over few people: their intervals hold what they say."""

from math import isnan

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.measures import mode_measures
from data.responses import MetricTable

FORCE, GAIN, LOCK = "force_mean_edge_n", "gain_exit", "longest_lock_s"
SETS = 3000


def laps(values, metric):
    """One lap a person and mode: values of shape (person, mode)."""
    rows = [(f"p{p}", f"c{p}", f"M{k}", x) for p, own in enumerate(values) for k, x in enumerate(own)]
    return MetricTable(pd.DataFrame(rows, columns=["participant", "comparison", "mode", metric]))


def measured(values, metric):
    return mode_measures(laps(values, metric), [f"M{k}" for k in range(np.shape(values)[1])])


@pytest.mark.parametrize(("metric", "is_skewed"), [(GAIN, False), (FORCE, True)])
@pytest.mark.parametrize("people", [3, 7, 20])
def test_of_seven_people_the_94_percent_interval_holds_94_percent(metric, is_skewed, people):
    values = np.random.default_rng(people).normal(size=(people, SETS))
    own = measured(np.exp(values) if is_skewed else values, metric)
    true = 1.0 if is_skewed else 0.0
    held = sum(m.low <= true <= m.high for m in own)
    least, most = stats.binom.ppf([0.0005, 0.9995], SETS, 0.94)
    assert len(own) == SETS
    assert least <= held <= most


def test_a_persons_many_laps_count_as_one_value():
    rows = laps(np.array([[1.0], [2.0], [4.0]]), GAIN).rows
    often = pd.concat([rows, *[rows[rows["participant"] == "p2"]] * 9])
    assert mode_measures(MetricTable(often), ("M0",)) == mode_measures(MetricTable(rows), ("M0",))


def test_the_mean_of_what_cannot_be_negative_is_geometric_with_students_interval_of_the_logs():
    (force,) = measured([[10.0], [20.0], [40.0], [80.0]], FORCE)
    logs = np.log([10, 20, 40, 80])
    low, high = stats.t.interval(0.94, 3, logs.mean(), stats.sem(logs))
    assert (force.mean, force.mean_kind) == (pytest.approx(10 * 8**0.5), "geometric")
    assert (force.low, force.high) == (pytest.approx(np.exp(low)), pytest.approx(np.exp(high)))


def test_people_at_zero_are_counted_and_left_out_of_a_geometric_mean():
    values = [[0.0, 3.0], [0.0, 0.0], [0.0, 12.0], [0.0, 6.0]]
    never, sometimes = measured(values, LOCK)
    assert (never.mean, never.participants, never.zeros) == (0.0, 0, 4)
    assert isnan(never.low)
    assert (sometimes.mean, sometimes.participants, sometimes.zeros) == (pytest.approx(6.0), 3, 1)
    assert 0 < sometimes.low < 6 < sometimes.high


@pytest.mark.parametrize("values", [[[5.0]], [[5.0], [6.0]], [[5.0], [5.0], [5.0]]])
def test_two_people_or_equal_ones_give_no_interval(values):
    (force,) = measured(values, FORCE)
    assert isnan(force.low)
    assert isnan(force.high)
