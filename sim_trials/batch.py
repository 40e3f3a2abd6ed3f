"""Many laps: a plain map, on one core or many, whose results don't depend on how many.

Each lap is a job of its own that says all it needs, so nothing is shared, the order of the results is
that of the jobs, and a cluster serves as well as one machine: under ``joblib.parallel_config("dask")``
the same call spreads over a Dask cluster.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from data.study import Study
from sim_trials.loop import lap_loop
from sim_trials.operators import Operator
from sim_trials.trial import TrialResult, run_trial

Job = TypeVar("Job")
Result = TypeVar("Result")
Progress = Callable[[int, int, str], None]
"""Told after each job how many are done, of how many, and a word on the job."""


@dataclass(frozen=True)
class LapJob:
    """One lap to run: the arguments of `trial.run_trial`."""

    study: Study
    mode: str
    operator: Operator
    seed: int
    lap: int

    def run(self) -> TrialResult:
        """Run it."""
        return run_trial(self.study, self.mode, self.operator, seed=self.seed, lap=self.lap)


def condition_jobs(study: Study, mode: str, operator: Operator, seed: int) -> tuple[LapJob, ...]:
    """The laps of one condition of a comparison, in order.

    After a lap, however it ended, the robot is put back to the start and the next one begins. Both
    conditions of a comparison get the same seed, hence the same hand.
    """
    laps = range(1, study.protocol.laps_per_condition + 1)
    return tuple(LapJob(study, mode, operator, seed, lap) for lap in laps)


def run_laps(jobs: Sequence[LapJob], n_jobs: int = 1, progress: Progress | None = None) -> list[TrialResult]:
    """Run laps; the results stand in the order of the jobs.

    Parameters
    ----------
    jobs : sequence of LapJob
    n_jobs : int
        How many processes; 1 runs in this one, -1 takes all cores.
    progress : callable, optional
        Called as ``progress(done, total, what)`` in this process.
    """
    results = []
    for job, result in zip(jobs, map_jobs(LapJob.run, jobs, n_jobs), strict=True):
        results.append(result)
        if progress is not None:
            progress(len(results), len(jobs), f"{job.mode}, lap {job.lap}")
    return results


def map_jobs(
    work: Callable[[Job], Result], jobs: Sequence[Job], n_jobs: int
) -> Generator[Result, None, None]:
    """``map`` over processes, in order."""
    if n_jobs == 1 or len(jobs) < 2:
        yield from map(work, jobs)
        return
    from joblib import Parallel, delayed

    # Compiled here once, so that the processes load the loop from the cache instead of all compiling it.
    lap_loop()
    yield from Parallel(n_jobs=n_jobs, return_as="generator")(delayed(work)(job) for job in jobs)
