"""What a page draws of a lap."""

from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
import pytest

from data.study import Study
from sim_trials.frames import Frames, frames
from sim_trials.kinematics import handle_pose
from sim_trials.maze import cursor, tilt_direction, wall_of
from sim_trials.record import record_of
from sim_trials.trial import TrialResult

FirstLap = Callable[[str], TrialResult]


def test_frames_give_away_neither_mode_nor_singularity() -> None:
    assert [field.name for field in fields(Frames)] == [
        "time_s", "q_rad", "cursor_m", "tilt_deg", "tilt_direction_rad", "is_blasting", "is_enabled",
        "speed_m_s", "hand_m", "force_share",
    ]  # fmt: skip


def test_cursor_and_tilt_are_those_of_the_drawn_robot(study: Study, first_lap: FirstLap) -> None:
    drawn, wall, T = (
        frames(first_lap("M2").recording),
        record_of(wall_of(study.maze, study.feedback)),
        np.empty((4, 4)),
    )
    for k in range(0, drawn.time_s.size, 100):
        handle_pose(drawn.q_rad[k], T)
        np.testing.assert_allclose(drawn.cursor_m[k], cursor(wall, T), atol=1e-5)
        assert drawn.tilt_deg[k] == pytest.approx(np.degrees(np.arccos(T[0, 2])), abs=0.05)
        if drawn.tilt_deg[k] > 1.0:
            assert drawn.tilt_direction_rad[k] == pytest.approx(tilt_direction(T), abs=0.01)


def test_hand_is_ahead_of_the_cursor_by_the_pull(first_lap: FirstLap) -> None:
    drawn = frames(first_lap("M2").recording)
    top = (drawn.time_s > 2.0) & (drawn.cursor_m[:, 0] > -0.8) & (drawn.cursor_m[:, 1] > 0.4)
    ahead = drawn.hand_m[top] - drawn.cursor_m[top]
    # 8 to 15 N on a spring of 200 to 400 N/m, to the right.
    assert -0.08 < ahead[:, 0].mean() < -0.02
    assert abs(ahead[:, 1].mean()) < 0.005
    assert drawn.force_share.min() >= 0.0
    assert 0.1 < drawn.force_share.max() <= 1.0


def test_speed_is_that_of_the_cursor(first_lap: FirstLap) -> None:
    drawn = frames(first_lap("M3").recording)
    moved = np.hypot(*np.diff(drawn.cursor_m, axis=0).T).sum()
    assert (drawn.speed_m_s * 0.04).sum() == pytest.approx(moved, rel=0.02)


def test_fewer_frames_are_some_of_all_frames(first_lap: FirstLap) -> None:
    recording = first_lap("M1").recording
    every, fifth = frames(recording), frames(recording, hz=5.0)
    assert every.time_s[1] == pytest.approx(0.04)
    np.testing.assert_array_equal(fifth.q_rad, every.q_rad[::5])
    np.testing.assert_allclose(fifth.time_s, every.time_s[::5])


def test_blasting_shows_when_the_trigger_is_pressed(first_lap: FirstLap) -> None:
    recording = first_lap("M1").recording
    assert not frames(recording).is_blasting[:5].any()
    assert frames(recording).is_blasting[50:].mean() > 0.8
    released = replace(recording, triggers=np.zeros_like(recording.triggers))
    assert not frames(released).is_blasting.any()
    assert not frames(released).is_enabled.any()
