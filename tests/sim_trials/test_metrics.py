"""Metrics of laps made by hand, whose values are known without the code."""

from dataclasses import replace

import numpy as np
import pytest

from data.metric_meanings import LAP_METRICS, LONGEST_LOCK, metric_meanings
from data.study import Study
from sim_trials.loop import BLAST, COMPLETED, ENABLE, TICK
from sim_trials.metrics import (
    cursor_speed,
    low_passed_jerk,
    metric_names,
    metrics,
)
from sim_trials.trace import Trace

DT = 0.008


@pytest.fixture
def steady() -> Trace:
    """10 s of the top edge at 0.10 m/s up to the corner, then 2.5 s down the right edge at 0.12 m/s."""
    n, corner = 1564, 1251
    time = np.arange(n) * DT
    ticks = np.zeros(n, TICK)
    ticks["place"] = np.where(time < 10.0, 0.395 + 0.1 * time, 1.395 + 0.12 * (time - 10.0))
    ticks["cursor_y"] = np.where(time < 10.0, -0.045 - 0.1 * time, -1.045)
    ticks["cursor_z"] = np.where(time < 10.0, 0.45, 0.45 - 0.12 * (time - 10.0))
    ticks["handle"][:, 0] = 0.8
    ticks["handle"][:, 1] = ticks["cursor_y"]
    ticks["handle"][:, 2] = ticks["cursor_z"]
    ticks["twist"][:, 1] = np.where(time < 10.0, -0.1, 0.0)
    ticks["twist"][:, 2] = np.where(time < 10.0, 0.0, -0.24)
    ticks["sigma"] = np.where(time < 10.0, 0.3, 0.004)
    ticks["tilt"] = np.radians(np.where(time < 10.0, 0.0, 6.0))
    counts = np.zeros((n, 6), np.int16)
    counts[:, 0], counts[:, 1] = 3 * 128, 4 * 128
    counts[corner:, :2] *= 2
    return Trace(ticks, counts, np.full(n, ENABLE | BLAST, np.uint8), COMPLETED)


def test_steady_lap_has_the_metrics_it_was_made_with(study: Study, steady: Trace) -> None:
    found = metrics(steady, study)
    assert found["duration_s"] == pytest.approx(1564 * DT)
    # The edge begins 3 cm before the corner, 0.3 s earlier.
    assert found["duration_edge_s"] == pytest.approx(2.8, abs=2 * DT)
    assert found["duration_approach_s"] == pytest.approx(3.0, abs=2 * DT)
    assert found["force_mean_approach_n"] == pytest.approx(5.0)
    assert found["force_mean_edge_n"] == pytest.approx((0.3 * 5.0 + 2.5 * 10.0) / 2.8, rel=0.01)
    assert found["force_peak_n"] == pytest.approx(10.0)
    assert found["speed_mean_approach_m_s"] == pytest.approx(0.1)
    assert found["tilt_peak_deg"] == pytest.approx(6.0)
    assert found["tilt_mean_edge_deg"] == pytest.approx(6.0 * 2.5 / 2.8, rel=0.01)
    assert found["sigma_min_approach"] == 0.3
    assert found["sigma_min"] == 0.004
    assert found["near_singularity_s"] == pytest.approx(2.5, abs=2 * DT)
    assert found[LONGEST_LOCK] == pytest.approx(2.5, abs=2 * DT)
    assert found["solid_share"] == pytest.approx(1.0)
    assert found["gain_approach"] == pytest.approx(1.0, rel=1e-6)
    # 0.3 s at 0.10 of 0.10 m/s and 2.5 s at 0.12 of 0.24 m/s, least squares.
    assert found["gain_edge"] == pytest.approx(
        (0.3 * 0.01 + 2.5 * 0.0288) / (0.3 * 0.01 + 2.5 * 0.0576), rel=0.02
    )


def test_a_phase_that_was_not_reached_has_no_metrics(study: Study, steady: Trace) -> None:
    found = metrics(steady, study)
    assert not [name for name in found if "exit" in name]
    assert set(found) <= set(metric_names()) <= set(metric_meanings())


def test_path_counts_as_solid_by_length_and_only_while_blasting(study: Study, steady: Trace) -> None:
    fast = steady.ticks.copy()
    # Half of the way at 0.1 m/s, the other half at 0.4 m/s.
    time = np.arange(1564) * DT
    fast["cursor_y"] = np.where(time < 8.0, -0.1 * time, -0.8 - 0.4 * (time - 8.0))
    fast["cursor_y"] = np.maximum(fast["cursor_y"], -1.6)
    fast["cursor_z"] = 0.45
    assert metrics(replace(steady, ticks=fast), study)["solid_share"] == pytest.approx(0.5, abs=0.02)
    triggers = np.where(time < 8.0, ENABLE | BLAST, ENABLE).astype(np.uint8)
    found = metrics(replace(steady, ticks=fast, triggers=triggers), study)["solid_share"]
    assert found == pytest.approx(1.0, abs=0.02)
    idle = np.full(1564, ENABLE, np.uint8)
    assert "solid_share" not in metrics(replace(steady, triggers=idle), study)


def test_cursor_speed_is_that_of_a_circle() -> None:
    time = np.arange(1000) * DT
    speed = cursor_speed(0.2 * np.cos(0.5 * time), 0.2 * np.sin(0.5 * time))
    np.testing.assert_allclose(speed, 0.1, rtol=1e-3)


def test_jerk_of_a_slow_sine_is_exact_and_of_tremor_is_suppressed() -> None:
    time = np.arange(3000) * DT
    for hz, kept in ((0.5, 1.0), (20.0, 0.01)):
        omega = 2.0 * np.pi * hz
        position = np.column_stack([0.05 * np.sin(omega * time), 0.0 * time, 0.0 * time])
        jerk = low_passed_jerk(position)[500:-500]
        true = 0.05 * omega**3 / np.sqrt(2.0)
        rms = np.sqrt((jerk**2).mean())
        assert rms == pytest.approx(true, rel=0.01) if kept == 1.0 else rms < kept * true
    assert np.isnan(low_passed_jerk(np.zeros((20, 3)))).all()


def test_names_carry_phase_and_unit() -> None:
    names = metric_names()
    assert len(set(names)) == len(names) == 4 * len(LAP_METRICS) + 1
    for name in (
        "force_mean_n",
        "force_mean_edge_n",
        "speed_mean_exit_m_s",
        "gain_approach",
        "sigma_min_edge",
    ):
        assert name in names
