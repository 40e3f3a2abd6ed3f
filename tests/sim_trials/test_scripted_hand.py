"""The scripted hand: a person's view and a person's means, the same laps every time."""

import inspect

import pytest

from data.study import Study
from sim_trials.live import HandInput, LiveTrial, LiveView
from sim_trials.scripted_hand import ScriptedHand
from sim_trials.trial import TrialResult, finish

DT = 0.008


def lap(study: Study, mode: str, pace_m_s: float = 0.10, *, every: int = 1, late: int = 0) -> TrialResult:
    """A lap whose hand looks at every so many-th tick and acts so many ticks late."""
    trial, hand, waiting = LiveTrial(study, mode), ScriptedHand(study, pace_m_s), []
    act, now = HandInput(0.35, 0.45), 0
    while trial.ending is None:
        if now % every == 0:
            waiting.append((now + late, hand.aim(trial.view, every * DT)))
        while waiting and waiting[0][0] <= now:
            act = waiting.pop(0)[1]
        trial.advance(act)
        now += 1
    return finish(study, mode, trial.inputs, lap=1)


@pytest.mark.parametrize("pace_m_s", [0.08, 0.10, 0.12])
def test_the_same_hand_gets_stuck_under_m1_and_not_under_m2_or_m3(study: Study, pace_m_s: float) -> None:
    laps = {mode: lap(study, mode, pace_m_s) for mode in study.mode_names}
    assert {mode: result.outcome for mode, result in laps.items()} == {
        "M1": "stuck", "M2": "completed", "M3": "completed",
    }  # fmt: skip
    assert laps["M1"].events[0].phase == "edge"
    for mode in ("M2", "M3"):
        assert laps[mode].metrics["longest_lock_s"] == 0.0
        assert laps[mode].metrics["solid_share"] > 0.9


def test_a_screen_between_eye_and_hand_changes_nothing_of_that(study: Study) -> None:
    # Every other tick, as a screen at 60 Hz, and 64 ms late.
    outcomes = [lap(study, mode, every=2, late=8).outcome for mode in study.mode_names]
    assert outcomes == ["stuck", "completed", "completed"]


def test_it_guides_a_narrower_maze_too_where_all_modes_are_the_same(study: Study) -> None:
    maze = study.maze.model_copy(update={"right_y_m": -0.55})
    narrow = study.model_copy(update={"maze": maze})
    results = [lap(narrow, mode) for mode in narrow.mode_names]
    assert all(result.outcome == "completed" for result in results)
    assert len({result.recording.states.tobytes() for result in results}) == 1
    assert results[0].metrics["sigma_min"] > 0.25


def test_it_knows_what_a_person_knows() -> None:
    assert list(inspect.signature(ScriptedHand).parameters) == ["study", "pace_m_s"]
    assert list(inspect.signature(ScriptedHand.aim).parameters) == ["self", "view", "dt"]
    assert not set(LiveView._fields) & {"mode", "sigma", "lambda0"}


def test_it_does_the_same_every_time(study: Study) -> None:
    assert lap(study, "M3") == lap(study, "M3")


def test_joint_angles_are_nothing_it_looks_at(study: Study) -> None:
    trial = LiveTrial(study, "M2")
    seeing, blindfolded = ScriptedHand(study), ScriptedHand(study)
    for _ in range(1500):
        view = trial.view
        act = seeing.aim(view, DT)
        assert blindfolded.aim(view._replace(q_rad=()), DT) == act
        trial.advance(act)
