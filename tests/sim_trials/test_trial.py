"""A lap as a whole: repeatable, halted by the physics alone, run again bit for bit from its inputs."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from data.errors import InputError
from data.study import Mode, Study
from sim_trials.events import stop_tick, stuck_tick
from sim_trials.loop import COMPLETED, STOPPED, STUCK, lap_loop
from sim_trials.metrics import metric_names
from sim_trials.operators import draw_operator
from sim_trials.recording import ReplayError
from sim_trials.trial import TrialResult, replay, replay_trace, run_trial, simulate

FirstLap = Callable[[str], TrialResult]
STUCK_OPERATOR = 6
"""Of the laps that the fixtures run."""


def with_modes(study: Study, *modes: Mode) -> Study:
    return study.model_copy(update={"modes": modes})


def with_dwell(study: Study, dwell_s: float) -> Study:
    return study.model_copy(update={"stuck": study.stuck.model_copy(update={"dwell_s": dwell_s})})


def test_the_robot_gets_stuck_under_m1_and_not_under_m2_or_m3(first_lap: FirstLap) -> None:
    results = {mode: first_lap(mode) for mode in ("M1", "M2", "M3")}
    assert {mode: result.outcome for mode, result in results.items()} == {
        "M1": "stuck", "M2": "completed", "M3": "completed",
    }  # fmt: skip
    (event,) = results["M1"].events
    assert (event.kind, event.phase, event.definition) == ("stuck", "edge", "sigma-dwell/1")
    assert event.sigma_min < 0.005
    assert event.time_s == pytest.approx(results["M1"].duration_s, abs=0.0081)
    assert not results["M2"].events
    assert not results["M3"].events


def test_the_same_seed_gives_the_same_lap_to_the_last_bit(study: Study, first_lap: FirstLap) -> None:
    operator = draw_operator(STUCK_OPERATOR)
    run_trial(study, "M3", draw_operator(9), seed=9)
    assert run_trial(study, "M1", operator, seed=STUCK_OPERATOR) == first_lap("M1")
    assert run_trial(study, "M1", operator, seed=0) != first_lap("M1")


def test_m1_with_the_damping_of_m2_gives_the_lap_of_m2_bit_for_bit(study: Study, first_lap: FirstLap) -> None:
    changed = with_modes(study, Mode(name="M1", method="dls", parameters={"lambda0": 0.6, "sigma_t": 0.25}))
    lap = run_trial(changed, "M1", draw_operator(STUCK_OPERATOR), seed=STUCK_OPERATOR)
    expected = first_lap("M2")
    assert lap.recording.counts.tobytes() == expected.recording.counts.tobytes()
    assert lap.recording.states.tobytes() == expected.recording.states.tobytes()
    assert lap.metrics == expected.metrics


def test_modes_meet_the_same_hand_until_the_damping_begins(first_lap: FirstLap) -> None:
    m1, m2 = first_lap("M1").recording, first_lap("M2").recording
    first_damped = int(np.argmax(m1.states["sigma"] < 0.25)) * 5
    assert first_damped > 500
    np.testing.assert_array_equal(m1.counts[:first_damped], m2.counts[:first_damped])
    assert np.any(
        m1.counts[first_damped : first_damped + 500] != m2.counts[first_damped : first_damped + 500]
    )


@pytest.mark.parametrize("mode", ["M1", "M3"])
def test_replay_of_the_inputs_gives_the_same_result_bit_for_bit(
    study: Study, first_lap: FirstLap, mode: str
) -> None:
    result = first_lap(mode)
    assert replay(result.recording, study) == result
    full_rate = simulate(study, mode, draw_operator(STUCK_OPERATOR), seed=STUCK_OPERATOR)
    assert replay_trace(result.recording, study).ticks.tobytes() == full_rate.ticks.tobytes()


def test_replay_notices_an_altered_input(study: Study, first_lap: FirstLap) -> None:
    recording = first_lap("M3").recording
    counts = recording.counts.copy()
    counts[1000, 1] += 2000
    with pytest.raises(ReplayError, match="differs from the recording"):
        replay(replace(recording, counts=counts), study)


def test_replay_refuses_another_study(study: Study, first_lap: FirstLap) -> None:
    with pytest.raises(InputError, match=r"made for study 'carmichael2017'"):
        replay(first_lap("M3").recording, with_dwell(study, 4.0))


def test_the_loop_halts_where_the_definitions_say(study: Study) -> None:
    stuck = simulate(study, "M1", draw_operator(STUCK_OPERATOR), seed=STUCK_OPERATOR)
    sigma = stuck.ticks["sigma"]
    assert stuck.ending == STUCK
    assert stuck_tick(sigma, study.stuck) == sigma.size - 1
    earlier = simulate(with_dwell(study, 3.0), "M1", draw_operator(STUCK_OPERATOR), seed=STUCK_OPERATOR)
    assert earlier.ending == STUCK
    assert stuck_tick(sigma, with_dwell(study, 3.0).stuck) == earlier.ticks.size - 1
    assert earlier.ticks.tobytes() == stuck.ticks[: earlier.ticks.size].tobytes()
    done = simulate(study, "M2", draw_operator(STUCK_OPERATOR), seed=STUCK_OPERATOR)
    assert done.ending == COMPLETED
    assert stuck_tick(done.ticks["sigma"], study.stuck) is None


def test_the_plain_inverse_inverts_the_elbow_and_ends_in_a_protective_stop(study: Study) -> None:
    bare = Mode(name="bare", method="dls", parameters={"lambda0": 0.001, "sigma_t": 0.001})
    changed = with_modes(study, bare)
    result = run_trial(changed, "bare", draw_operator(0), seed=0)
    trace = replay_trace(result.recording, changed)
    assert trace.ending == STOPPED
    assert result.outcome == "failed"
    assert [event.kind for event in result.events] == ["elbow_inversion", "protective_stop"]
    assert [event.definition for event in result.events] == ["elbow-sign/1", "joint-speed/1"]
    assert stop_tick(trace.ticks["qdot"]) == trace.ticks.size - 1


def test_one_compiled_loop_serves_all_modes(first_lap: FirstLap) -> None:
    for mode in ("M1", "M2", "M3"):
        first_lap(mode)
    assert len(lap_loop().signatures) == 1


def test_a_lap_is_painted_mostly_solid_and_every_metric_is_known(first_lap: FirstLap) -> None:
    for mode in ("M2", "M3"):
        metrics = first_lap(mode).metrics
        assert metrics["solid_share"] > 0.9
        assert set(metrics) == set(metric_names())
    assert "force_mean_exit_n" not in first_lap("M1").metrics
    assert set(first_lap("M1").metrics) < set(metric_names())


def test_damping_is_felt_as_in_the_2017_study(first_lap: FirstLap) -> None:
    heavy, asymmetric = first_lap("M2").metrics, first_lap("M3").metrics
    assert heavy["gain_approach"] == pytest.approx(asymmetric["gain_approach"], rel=0.05)
    assert asymmetric["gain_exit"] > 1.5 * heavy["gain_exit"]
    assert asymmetric["force_mean_exit_n"] < 0.8 * heavy["force_mean_exit_n"]


def test_an_unknown_mode_is_refused_with_the_valid_ones(study: Study) -> None:
    with pytest.raises(InputError, match="M1, M2, M3"):
        run_trial(study, "M4", draw_operator(0), seed=0)
