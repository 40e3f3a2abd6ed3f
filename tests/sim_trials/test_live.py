"""A lap under a person's hand: it can be run again bit for bit, it rests, it ends, and it tells nothing."""

import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data.errors import ElbowroomError, InputError
from data.study import Mode, Study
from sim_trials.frames import frames
from sim_trials.guidance import HAND
from sim_trials.live import LONGEST_LIVE_LAP_S, HandInput, LiveTrial, LiveView, warm_up
from sim_trials.loop import BLAST, ENABLE, STUCK, TIMED_OUT
from sim_trials.metrics import metrics
from sim_trials.modes.registry import method_names
from sim_trials.recording import ReplayError, read
from sim_trials.scripted_hand import ScriptedHand
from sim_trials.trial import finish, replay, replay_trace

DT = 0.008
START = HandInput(0.35, 0.45)


def guided(study: Study, mode: str, *, longest_s: float = 200.0) -> tuple[LiveTrial, list[LiveView]]:
    """A lap of the scripted hand, and what was to be seen after each tick."""
    trial, hand = LiveTrial(study, mode), ScriptedHand(study)
    views = [trial.view]
    while trial.ending is None and trial.time_s < longest_s:
        trial.advance(hand.aim(trial.view, DT))
        views.append(trial.view)
    trial.abandon()
    return trial, views


def held(trial: LiveTrial, y: float, z: float, seconds: float, *, blast: bool = False) -> None:
    for _ in range(round(seconds / DT)):
        trial.advance(HandInput(y, z, enable=True, blast=blast))


def released(trial: LiveTrial, seconds: float) -> None:
    for _ in range(round(seconds / DT)):
        trial.advance(START)


@pytest.mark.parametrize("mode", ["M1", "M3"])
def test_a_finished_lap_is_the_guided_one_bit_for_bit(study: Study, mode: str, tmp_path: Path) -> None:
    trial, views = guided(study, mode)
    result = finish(study, mode, pickle.loads(pickle.dumps(trial.inputs)), lap=2, seed=5)
    trace = replay_trace(result.recording, study)
    assert trace.ending == trial.ending
    assert trace.ticks.size == trial.ticks == len(views)
    # What is drawn after a tick is the state at the beginning of the next.
    drawn = np.array([view.q_rad for view in views[:-1]])
    assert drawn.tobytes() == trace.ticks["q"][1:].tobytes()
    cursors = np.array([(view.cursor_y_m, view.cursor_z_m) for view in views[:-1]])
    np.testing.assert_array_equal(cursors[:, 0], trace.ticks["cursor_y"][1:])
    np.testing.assert_array_equal(cursors[:, 1], trace.ticks["cursor_z"][1:])
    result.recording.write(tmp_path / "lap.parquet")
    assert read(tmp_path / "lap.parquet") == result.recording
    assert replay(read(tmp_path / "lap.parquet"), study) == result
    assert result.outcome == ("stuck" if mode == "M1" else "completed")
    assert [event.kind for event in result.events] == (["stuck"] if mode == "M1" else [])


def test_every_method_can_be_guided_and_run_again(study: Study) -> None:
    changed = study.model_copy(
        update={"modes": tuple(Mode(name=f"X{i}", method=m) for i, m in enumerate(method_names()))}
    )
    warm_up(changed)
    for mode in changed.mode_names:
        trial = LiveTrial(changed, mode)
        held(trial, -0.95, 0.45, 6.0)
        drawn = trial.view.q_rad
        trial.abandon()
        result = finish(changed, mode, trial.inputs, lap=1)
        before_last = replay_trace(result.recording, changed).ticks["q"][-1]
        assert np.abs(before_last - drawn).max() < 0.02
        assert result.metrics["sigma_min"] < 0.2
        assert replay(result.recording, changed) == result


def test_trials_in_one_process_do_not_disturb_each_other(study: Study) -> None:
    alone = {mode: LiveTrial(study, mode) for mode in ("M1", "M2")}
    for trial in alone.values():
        held(trial, -0.95, 0.45, 5.0)
    together = {mode: LiveTrial(study, mode) for mode in ("M1", "M2")}
    for _ in range(round(5.0 / DT)):
        for trial in together.values():
            trial.advance(HandInput(-0.95, 0.45, enable=True))
    for mode in alone:
        assert together[mode].view == alone[mode].view
    assert alone["M1"].view != alone["M2"].view


def test_m1_with_the_damping_of_m2_feels_like_m2_to_the_last_bit(study: Study) -> None:
    heavy = Mode(name="M1", method="dls", parameters={"lambda0": 0.6, "sigma_t": 0.25})
    changed = study.model_copy(update={"modes": (heavy,)})
    assert guided(changed, "M1", longest_s=20.0)[1] == guided(study, "M2", longest_s=20.0)[1]


def test_what_is_seen_names_neither_mode_nor_singularity() -> None:
    assert LiveView._fields == (
        "time_s", "cursor_y_m", "cursor_z_m", "tilt_y_deg", "tilt_z_deg", "hand_y_m", "hand_z_m", "pull",
        "speed_m_s", "share", "q_rad", "is_enabled", "is_spraying", "is_resting",
    )  # fmt: skip


def test_what_is_seen_is_what_the_hand_does(study: Study) -> None:
    trial = LiveTrial(study, "M2")
    for k in range(500):
        trial.advance(HandInput(0.35 - 0.1 * DT * k, 0.45, 0.0, 6.0, enable=True, blast=True))
    view = trial.view
    assert (view.hand_y_m, view.hand_z_m) == (0.35 - 0.1 * DT * 499, 0.45)
    # The robot is pulled along at 0.1 m/s, as 10 N do, and the nozzle has come to lean.
    assert view.speed_m_s == pytest.approx(0.1, rel=0.05)
    assert view.pull == pytest.approx(10.0 / HAND.force_cap_n, rel=0.1)
    assert view.tilt_z_deg == pytest.approx(6.0, abs=0.1)
    assert view.tilt_y_deg == pytest.approx(0.0, abs=0.1)
    assert 0.0 < view.share < 0.2
    assert view.is_enabled
    assert view.is_spraying
    trial.advance(START)
    assert not trial.view.is_enabled
    assert (trial.view.hand_y_m, trial.view.hand_z_m) == (trial.view.cursor_y_m, trial.view.cursor_z_m)


def test_a_robot_that_nobody_holds_comes_to_rest_and_its_clock_stands_still(study: Study) -> None:
    trial = LiveTrial(study, "M3")
    assert trial.is_resting
    released(trial, 2.0)
    assert trial.ticks == 1
    held(trial, 0.0, 0.45, 2.0)
    assert not trial.is_resting
    released(trial, 0.9)
    assert not trial.is_resting
    assert trial.ticks == 1 + round(2.9 / DT)
    released(trial, 5.0)
    assert trial.is_resting
    at_rest = trial.ticks
    assert 3.0 < trial.time_s < 3.6
    released(trial, 5.0)
    assert trial.ticks == at_rest
    assert trial.view.time_s == trial.time_s
    held(trial, 0.0, 0.45, DT)
    assert trial.ticks == at_rest + 1
    trial.abandon()
    result = finish(study, "M3", trial.inputs, lap=1)
    assert result.duration_s == trial.time_s
    assert result.recording.triggers.sum() == round(2.0 / DT) + 1


def test_a_hand_that_lets_go_halts_the_robot_and_pulls_with_nothing(study: Study) -> None:
    trial = LiveTrial(study, "M2")
    held(trial, -0.6, 0.45, 1.2, blast=True)
    assert trial.view.speed_m_s > 0.2
    before = trial.view.cursor_y_m
    released(trial, 0.8)
    assert trial.view.speed_m_s < 0.002
    assert abs(trial.view.cursor_y_m - before) < 0.06
    assert trial.view.pull == 0.0
    trial.abandon()
    inputs = trial.inputs
    assert np.abs(inputs.counts[-100:]).max() == 0
    assert set(inputs.triggers[-100:]) == {0}
    assert set(inputs.triggers[1:-100]) == {ENABLE | BLAST}


def test_numbers_that_are_not_finite_count_as_a_released_hand(study: Study) -> None:
    trial = LiveTrial(study, "M2")
    held(trial, 0.0, 0.45, 1.0)
    for bad in (math.nan, math.inf):
        for place in range(4):
            numbers = [0.0, 0.45, 0.0, 0.0]
            numbers[place] = bad
            trial.advance(HandInput(*numbers, enable=True, blast=True))
            assert not trial.view.is_enabled
            assert not trial.view.is_spraying
    assert all(math.isfinite(value) for value in (*trial.view[:10], *trial.view.q_rad))


def test_the_longest_lap_ends_and_two_minutes_of_one_take_less_than_300_kb(
    study: Study, tmp_path: Path
) -> None:
    trial, rng = LiveTrial(study, "M2"), np.random.default_rng(1)
    while trial.ending is None:
        # Around and around in the middle, with a pointer that trembles by half a millimetre.
        angle = 0.6 * trial.time_s
        y, z = 0.2 * math.cos(angle), 0.25 + 0.15 * math.sin(angle)
        trial.advance(HandInput(*(rng.normal((y, z), 0.0005).tolist()), enable=True, blast=True))
    assert trial.ending == TIMED_OUT
    assert trial.time_s == pytest.approx(LONGEST_LIVE_LAP_S)
    trial.advance(HandInput(0.0, 0.2, enable=True))
    assert trial.time_s == pytest.approx(LONGEST_LIVE_LAP_S)
    result = finish(study, "M2", trial.inputs, lap=1)
    assert result.outcome == "abandoned"
    assert replay(result.recording, study) == result
    n = round(120.0 / DT)
    first = replace(trial.inputs, counts=trial.inputs.counts[:n], triggers=trial.inputs.triggers[:n])
    finish(study, "M2", first, lap=1).recording.write(tmp_path / "lap.parquet")
    assert (tmp_path / "lap.parquet").stat().st_size < 300_000


def test_a_trial_that_nobody_touched_can_be_finished(study: Study) -> None:
    trial = LiveTrial(study, "M1")
    trial.abandon()
    result = finish(study, "M1", trial.inputs, lap=1)
    assert result.outcome == "abandoned"
    assert result.duration_s == DT
    assert "force_mean_n" not in result.metrics
    assert result.metrics["sigma_min"] == pytest.approx(0.315, abs=0.001)
    assert replay(result.recording, study) == result
    assert frames(result.recording).time_s.size == 1


def test_an_abandoned_lap_has_the_metrics_of_what_was_done(study: Study) -> None:
    trial, _ = guided(study, "M2", longest_s=20.0)
    result = finish(study, "M2", trial.inputs, lap=1)
    assert result.outcome == "abandoned"
    assert result.metrics["solid_share"] > 0.9
    assert result.metrics["force_mean_approach_n"] > 10.0
    assert "force_mean_exit_n" not in result.metrics


def test_a_pause_is_no_sign_of_little_force(study: Study) -> None:
    found = []
    for pause in (False, True):
        trial = LiveTrial(study, "M2")
        held(trial, -0.2, 0.45, 2.0)
        if pause:
            released(trial, 10.0)
        trial.abandon()
        result = finish(study, "M2", trial.inputs, lap=1)
        found.append(metrics(replay_trace(result.recording, study), study))
    straight, paused = found
    assert paused["duration_s"] > straight["duration_s"] + 1.0
    for name in ("force_mean_n", "force_peak_n", "tilt_mean_deg"):
        assert paused[name] == pytest.approx(straight[name], rel=1e-6)
    assert paused["speed_mean_m_s"] == pytest.approx(straight["speed_mean_m_s"], rel=0.01)


def test_a_guided_lap_is_drawn_with_the_hand_that_guided_it(study: Study) -> None:
    trial = LiveTrial(study, "M2")
    for k in range(1000):
        trial.advance(HandInput(0.35 - 0.1 * DT * k, 0.45, enable=True, blast=True))
    view = trial.view
    trial.abandon()
    recording = finish(study, "M2", trial.inputs, lap=1).recording
    assert recording.facts.operator is None
    assert recording.facts.hand is not None
    assert recording.facts.hand["force_cap_n"] == HAND.force_cap_n
    drawn = frames(recording)
    assert drawn.hand_m[-1] == pytest.approx((view.hand_y_m, view.hand_z_m), abs=0.003)
    assert drawn.force_share[-1] == pytest.approx(view.pull, abs=0.01)
    assert drawn.speed_m_s[-10] == pytest.approx(view.speed_m_s, abs=0.002)
    assert drawn.is_blasting[1:].all()


def test_a_lap_that_ends_otherwise_when_run_again_is_refused(study: Study) -> None:
    trial, _ = guided(study, "M1", longest_s=200.0)
    assert trial.ending == STUCK
    with pytest.raises(ReplayError, match=r"completed|abandoned"):
        finish(study, "M3", trial.inputs, lap=1)
    with pytest.raises(ReplayError, match="stuck"):
        finish(study, "M1", replace(trial.inputs, ending=TIMED_OUT), lap=1)


def test_inputs_of_a_trial_under_way_and_unknown_modes_are_refused(study: Study) -> None:
    with pytest.raises(ElbowroomError, match="under way"):
        _ = LiveTrial(study, "M1").inputs
    with pytest.raises(InputError, match="M1, M2, M3"):
        LiveTrial(study, "M9")
