"""Batches: the order of the jobs, whatever the number of processes."""

from data.study import Study
from sim_trials.batch import condition_jobs, run_laps
from sim_trials.operators import draw_operator


def test_a_condition_has_its_laps_in_order_with_one_hand(study: Study) -> None:
    jobs = condition_jobs(study, "M1", draw_operator(4), seed=4)
    assert [job.lap for job in jobs] == [1, 2, 3]
    assert {(job.mode, job.seed) for job in jobs} == {("M1", 4)}


def test_results_do_not_depend_on_the_number_of_processes(study: Study) -> None:
    jobs = [
        *condition_jobs(study, "M1", draw_operator(6), seed=6)[:2],
        *condition_jobs(study, "M3", draw_operator(0), seed=0)[:1],
    ]
    told: list[tuple[int, int, str]] = []
    alone = run_laps(jobs, n_jobs=1, progress=lambda *what: told.append(what))
    assert told == [(1, 3, "M1, lap 1"), (2, 3, "M1, lap 2"), (3, 3, "M3, lap 1")]
    assert [r.recording.facts.mode for r in alone] == ["M1", "M1", "M3"]
    assert alone == run_laps(jobs, n_jobs=2)


def test_after_a_stuck_lap_the_next_one_begins_at_the_start(study: Study) -> None:
    first, second = run_laps(condition_jobs(study, "M1", draw_operator(6), seed=6)[:2])
    assert first.outcome == "stuck"
    assert first.recording.states["q"][0].tobytes() == second.recording.states["q"][0].tobytes()
    assert first.recording.counts.tobytes() != second.recording.counts.tobytes()
