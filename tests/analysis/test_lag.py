"""Input delay by mode, and what a laggy lap leaves out."""

import math

import numpy as np
import pandas as pd
import pytest

from analysis.lag import LagLimits, mode_delays, without_laggy
from data.errors import InputError
from data.responses import LagTable, QuestionScale, ResponseTable, StuckTable

NAN = math.nan


def lag(*laps: tuple[str, str, float, float, float]) -> LagTable:
    """Laps as (comparison, mode, p95 [ms], ticks, skipped ticks)."""
    return LagTable(
        pd.DataFrame(
            {
                "participant": "p",
                "comparison": comparison,
                "mode": mode,
                "latency_median_ms": p95 / 2,
                "latency_p95_ms": p95,
                "frame_rate_hz": 60.0,
                "ticks": ticks,
                "skipped_ticks": skipped,
            }
            for comparison, mode, p95, ticks, skipped in laps
        )
    )


def answers(*comparisons: str, checks: tuple[str, ...] = ()) -> ResponseTable:
    names = [*comparisons, *checks]
    rows = pd.DataFrame(
        {
            "participant": "p",
            "question": "Q1",
            "mode_a": "M1",
            "mode_b": ["M1" if name in checks else "M2" for name in names],
            "response": "A>B",
            "count": 1,
            "comparison": names,
            "repetition": 1,
            "source": "human",
            "check": [name in checks for name in names],
        }
    )
    return ResponseTable(rows, ("M1", "M2"), (QuestionScale("Q1", "q", "?", 3),), True, False, "x", "t")


def test_delays_are_medians_over_laps_and_skipped_ticks_a_share_of_all_ticks():
    table = lag(("c1", "M1", 20, 1000, 0), ("c1", "M1", 90, 3000, 80), ("c2", "M1", 40, 1000, 20))
    (delay,) = mode_delays(table, ("M1", "M2"))
    assert (delay.mode, delay.laps, delay.measured) == ("M1", 3, 3)
    assert (delay.latency_median_ms, delay.latency_p95_ms, delay.frame_rate_hz) == (20, 40, 60)
    assert delay.skipped_percent == pytest.approx(2.0)


def test_what_was_not_measured_is_in_no_median():
    table = lag(("c1", "M2", NAN, NAN, NAN), ("c1", "M2", 50, 100, 1))
    (delay,) = mode_delays(table, ("M1", "M2"))
    assert (delay.laps, delay.measured, delay.latency_p95_ms, delay.skipped_percent) == (2, 1, 50, 1)
    (unknown,) = mode_delays(lag(("c1", "M2", NAN, NAN, NAN)), ("M2",))
    assert np.isnan([unknown.latency_p95_ms, unknown.skipped_percent]).all()


def test_one_laggy_lap_under_either_mode_leaves_its_comparison_out():
    laps = lag(
        ("c1", "M1", 30, 100, 0),
        ("c1", "M2", 101, 100, 0),
        ("c2", "M1", 100, 100, 0),
        ("c2", "M2", 30, 100, 0),
        ("c3", "M1", NAN, 100, 0),
    )
    stuck = StuckTable(
        pd.DataFrame({"participant": "p", "comparison": ["c1", "c2"], "mode": "M1", "stuck": False})
    )
    kept = without_laggy(answers("c1", "c2", "c3", "c4"), stuck, laps, LagLimits(100.0))
    assert kept.excluded.comparisons == ("c1",)
    assert (kept.excluded.total, kept.excluded.unmeasured) == (4, 2)
    assert kept.table.rows["comparison"].tolist() == ["c2", "c3", "c4"]
    assert kept.stuck.rows["comparison"].tolist() == ["c2"]


@pytest.mark.parametrize(
    ("limits", "left_out"),
    [
        (LagLimits(None, 1.0), ("c2",)),
        (LagLimits(50.0, 1.0), ("c1", "c2")),
        (LagLimits(None, 0.0), ("c2", "c3")),
        (LagLimits(1000.0, 100.0), ()),
    ],
)
def test_skipped_ticks_count_as_a_share_of_a_laps_ticks(limits, left_out):
    laps = lag(("c1", "M1", 60, 1000, 0), ("c2", "M2", 20, 1000, 11), ("c3", "M1", 20, 1000, 10))
    kept = without_laggy(answers("c1", "c2", "c3", "c4"), None, laps, limits)
    assert kept.excluded.comparisons == left_out
    assert kept.stuck is None


def test_attention_checks_are_neither_counted_nor_left_out():
    kept = without_laggy(
        answers("c1", "c2", checks=("k",)), None, lag(("c1", "M1", 90, 1, 0)), LagLimits(50.0)
    )
    assert (kept.excluded.comparisons, kept.excluded.total) == (("c1",), 2)
    assert kept.table.rows["comparison"].tolist() == ["c2", "k"]


def test_limits_that_leave_no_answer_are_wrong_input():
    with pytest.raises(InputError, match=r"all 1 comparisons have a lap with a 95th percentile of the input"):
        without_laggy(answers("c1"), None, lag(("c1", "M1", 90, 1, 0)), LagLimits(50.0))
