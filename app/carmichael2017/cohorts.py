"""Many simulated studies as large as the published one: how often does what it found come out?

A lap costs a tenth of a second and an answer next to nothing. So a pool of people goes through the study
once, and each cohort is drawn from the pool with replacement (a bootstrap, so that cohorts differ as much as
people do); everybody in it answers anew: other tastes, other slips.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.counts import count_responses
from analysis.exact import exact_dirichlet_posterior
from data.records import Trial
from data.responses import ResponseTable, rows_sha256
from data.store import Store, StoredStudy
from data.store.evidence import scale_of
from data.study import Study
from sim_trials.batch import map_jobs
from sim_trials.raters import Experience, answer, draw_rater, experience

OF_THE_STUDY, PLAIN = "study", "plain"
"""Kinds of raters: those of the study file, and those who go by `PLAIN_WEIGHTS`."""
PLAIN_WEIGHTS: Mapping[str, Mapping[str, float]] = {
    "Q1": {"jerk_rms_m_s3": -1.0},
    "Q2": {"gain": 1.0},
    "Q3": {"force_mean_n": 1.0},
}
"""The question's own magnitude over the whole lap and nothing else, for the questions that have one: Q4 to Q6
ask for impressions that no magnitude stands for."""
_GRID, _TIE_GRID = 61, 31
"""Points of the quadrature. With 201 and 121 no worth moves by more than 0.001."""
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class FeltComparison:
    """One comparison of one person, as it was felt under A and under B."""

    mode_a: str
    mode_b: str
    a: Experience
    b: Experience

    def is_stuck_under(self, mode: str) -> bool:
        """Whether the robot got stuck in any lap under this mode, one of the two."""
        felt = {self.mode_a: self.a, self.mode_b: self.b}
        return felt[mode].stuck_share > 0


Person = tuple[FeltComparison, ...]


@dataclass(frozen=True)
class _Job:
    study: Study
    pool: tuple[Person, ...]
    people: int
    seed: int
    number: int


def felt_by(store: Store, stored: StoredStudy) -> tuple[Person, ...]:
    """What everybody in a store experienced, person by person; attention checks are left out."""
    laps: dict[tuple[str, str], list[Trial]] = {}
    for trial in store.trials(stored):
        laps.setdefault((trial.comparison, trial.slot), []).append(trial)

    def felt(comparison: str, slot: str) -> Experience:
        done = laps[comparison, slot]
        return experience([lap.metrics for lap in done], [lap.outcome == "stuck" for lap in done])

    people: dict[str, list[FeltComparison]] = {}
    for c in store.comparisons(stored):
        if not c.check:
            known = FeltComparison(c.mode_a, c.mode_b, felt(c.id, "A"), felt(c.id, "B"))
            people.setdefault(c.participant, []).append(known)
    return tuple(map(tuple, people.values()))


def cohort_table(
    study: Study,
    pool: Sequence[Person],
    people: int,
    cohorts: int,
    *,
    seed: int,
    n_jobs: int,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """The worths and the stuck comparisons of many simulated studies.

    Parameters
    ----------
    pool : sequence of Person
        Whom each cohort is drawn from, with replacement.
    people : int
        In each cohort.

    Returns
    -------
    DataFrame
        One row per ``cohort, raters, question, mode`` with ``worth``, the posterior mean of the gibbs
        engine's model by quadrature, and the comparisons with the mode: how many, and how many of
        them ``stuck``.
    """
    jobs = [_Job(study, tuple(pool), people, seed, number) for number in range(1, cohorts + 1)]
    parts = []
    for part in map_jobs(_cohort, jobs, n_jobs):
        parts.append(part)
        if progress is not None:
            progress(len(parts), len(jobs), f"cohort {len(parts)}")
    return pd.concat(parts, ignore_index=True)


def _cohort(job: _Job) -> pd.DataFrame:
    rng = np.random.default_rng([job.seed, job.number])
    people = [job.pool[k] for k in rng.choice(len(job.pool), job.people)]
    all_felt = [felt for person in people for felt in person]
    with_mode = {m: [f for f in all_felt if m in (f.mode_a, f.mode_b)] for m in job.study.mode_names}
    rows = []
    for raters, study in ((OF_THE_STUDY, job.study), (PLAIN, _plain(job.study))):
        table = _answers(study, people, rng)
        for question in table.questions:
            counts = count_responses(table, question).collapsed()
            worth = exact_dirichlet_posterior(counts, _GRID, _TIE_GRID).worth_mean
            for mode, value in zip(counts.modes, worth, strict=True):
                stuck = sum(felt.is_stuck_under(mode) for felt in with_mode[mode])
                asked = (job.number, raters, question.name, mode)
                rows.append((*asked, float(value), len(with_mode[mode]), stuck))
    columns = ["cohort", "raters", "question", "mode", "worth", "comparisons", "stuck"]
    return pd.DataFrame(rows, columns=columns)


def _plain(study: Study) -> Study:
    questions = tuple(
        question.model_copy(update={"rehearsal": dict(PLAIN_WEIGHTS[question.name])})
        for question in study.questions
        if question.name in PLAIN_WEIGHTS
    )
    return study.model_copy(update={"questions": questions})


def _answers(study: Study, people: Sequence[Person], rng: np.random.Generator) -> ResponseTable:
    rows: list[tuple[str, str, str, str, str]] = []
    for number, person in enumerate(people, start=1):
        rater = draw_rater(study, rng)
        for felt in person:
            for question in study.questions:
                said = answer(question, rater, felt.a, felt.b, rng)
                rows.append((f"s{number}", question.name, felt.mode_a, felt.mode_b, said))
    table = pd.DataFrame(rows, columns=["participant", "question", "mode_a", "mode_b", "response"])
    table = table.assign(count=1, comparison="", repetition=0, source="simulated", check=False)
    return ResponseTable(
        rows=table,
        modes=study.mode_names,
        questions=tuple(map(scale_of, study.questions)),
        has_participants=True,
        is_simulated=True,
        sha256=rows_sha256(table),
        title=study.title,
    )
