"""Every metric that a trial can have is described, and nothing else is."""

from dataclasses import replace

from app.server.live.quality import TrialQuality
from app.server.live.wire import ENABLE_BUTTON, InputFrame
from data.metric_meanings import metric_meanings
from data.store.evidence import LAG_METRICS, LAP_TIME
from sim_trials.metrics import metric_names


def connection_metrics() -> set[str]:
    """What the server stores of a guided lap besides the lap's own metrics, when all was measured."""
    quality = TrialQuality()
    blank = InputFrame(ENABLE_BUTTON, "mouse", 1, 0.0, 0.0, 0.0, 0.0, 40.0, 0, 0.0)
    for number in range(3):
        quality.note(replace(blank, seq=number + 1, frames=60 * number, client_ms=1000.0 * number))
    return set(quality.metrics(ticks=375, skipped=1, lap=1))


def test_each_metric_has_a_meaning_and_a_unit_and_each_meaning_a_metric() -> None:
    written = set(metric_names()) | connection_metrics()
    described = metric_meanings()
    assert set(described) == written
    assert set(LAG_METRICS) | {LAP_TIME} <= written
    assert all(about.meaning and about.unit for about in described.values())
    assert len({about.meaning for about in described.values()}) == len(described)


def test_a_unit_agrees_with_the_name_it_stands_in() -> None:
    units = {name: about.unit for name, about in metric_meanings().items()}
    assert units["jerk_rms_edge_m_s3"] == "m/s3"
    assert units["speed_mean_m_s"] == "m/s"
    assert units["latency_p95_ms"] == "ms"
    assert units["force_peak_exit_n"] == "N"
    assert units["gain_edge"] == units["solid_share"] == units["skipped_ticks"] == "1"
