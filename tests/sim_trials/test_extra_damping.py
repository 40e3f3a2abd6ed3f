"""The study's small extra damping f_D, of which the paper gives no size, decides nothing."""

from data.study_file import read_study
from sim_trials.operators import draw_operator
from sim_trials.trial import TrialResult, run_trial

STUDY = read_study("carmichael2017")
UNDAMPED = STUDY.model_copy(
    update={
        "controller": STUDY.controller.model_copy(
            update={"extra_damping_n_s_m": 0.0, "extra_damping_nm_s_rad": 0.0}
        )
    }
)


def test_laps_end_the_same_with_and_without_extra_damping() -> None:
    laps: list[tuple[TrialResult, TrialResult]] = []
    for seed in range(5):
        operator = draw_operator(seed)
        for mode in ("M1", "M3"):
            laps.append(
                (
                    run_trial(STUDY, mode, operator, seed=seed),
                    run_trial(UNDAMPED, mode, operator, seed=seed),
                )
            )
    # A lap that ends within milliseconds of the dwell time may fall to either side.
    assert sum(damped.outcome != undamped.outcome for damped, undamped in laps) <= 1
    completed = [pair for pair in laps if {lap.outcome for lap in pair} == {"completed"}]
    assert len(completed) >= 3
    for damped, undamped in completed:
        assert abs(damped.duration_s - undamped.duration_s) < 0.05 * undamped.duration_s
    assert any(damped.duration_s != undamped.duration_s for damped, undamped in laps)
