"""The 2017 study with simulated people, beside what was published about people.

A pool of simulated people goes through the built-in study, lap by lap, into a store that is thrown away
afterwards. The first seven are the study of figure 5 (and of ``elbowroom demo``); `cohorts` makes many
studies of all of them. Their raters weigh what they feel by this project's numbers, so no order that comes
out is better than reproduced under that assumption.
"""

import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from analysis.fit import fit
from analysis.results import Fit, FitSettings
from app.carmichael2017.claims import of_stuck, of_the_ranks, order_table
from app.carmichael2017.cohorts import Person, cohort_table, felt_by
from app.cohort import simulate_cohort
from app.studies import OpenedStudy, open_study
from data.records import Trial
from data.responses import ResponseTable
from data.store import Store
from data.study import Study
from sim_trials.reproductions.carmichael2017 import claims
from sim_trials.reproductions.carmichael2017.damping import damping_table
from sim_trials.reproductions.carmichael2017.least_damping import DAMPINGS, least_damping_table
from sim_trials.reproductions.carmichael2017.measures import measured_table
from sim_trials.reproductions.verdict import Progress, Reproduction, Verdict, judge
from sim_trials.sweep import sweep

SEED = 2017
DWELLS = (4.0, 4.5, 5.0, 5.5, 6.0)
NEAR_LOCK = 0.05
"""sigma below which a lap has come near the lock: about 12 deg from straight."""


@dataclass(frozen=True)
class Extent:
    """How much is simulated.

    Attributes
    ----------
    people, pool, cohorts : int
        People in a study, people who go through it in all, and studies drawn from them.
    draws : int
        Of each chain of the Gibbs sampler. 4000 are enough where a mode never wins (M2 in Q1) and the
        worths mix slowly.
    swept : int
        Operators at each edge.
    edges : tuple of float
        Right edges of the maze [m] that M1 is tried at; M2 and M3 are at the last one, the farthest.
    braked : int
        Operators who do a lap with each damping.
    """

    people: int = 7
    pool: int = 14
    cohorts: int = 100
    swept: int = 10
    edges: tuple[float, ...] = (-1.03, -1.04, -1.045, -1.05, -1.06)
    braked: int = 7
    draws: int = 4000


@dataclass(frozen=True)
class _Pool:
    """What the pool leaves behind: the answers of the first, everybody's laps and feelings."""

    answers: ResponseTable
    people: tuple[Person, ...]
    laps: pd.DataFrame
    metrics: pd.DataFrame


def reproduce(
    n_jobs: int = 1, progress: Progress | None = None, extent: Extent | None = None
) -> Reproduction:
    """Simulate the study, its stuck surface and its dampings, and judge what was published.

    Parameters
    ----------
    n_jobs : int
        Processes; the result does not depend on it.
    progress : callable, optional
        Called as ``progress(done, total, what)``.
    extent : Extent, optional
        Less than the whole, for a look.
    """
    extent = extent or Extent()
    opened = open_study("carmichael2017")
    study = opened.study
    count = _Count(progress or (lambda done, total, what: None), _laps(study, extent))
    pool = _simulated(opened, extent, n_jobs, count)
    surface = _surface(study, extent, n_jobs, count)
    least = least_damping_table(study, range(SEED, SEED + extent.braked), n_jobs, count.stage())
    cohorts = cohort_table(
        study,
        pool.people,
        extent.people,
        extent.cohorts,
        seed=SEED,
        n_jobs=n_jobs,
        progress=count.stage(),
    )
    ranked = fit(pool.answers, FitSettings(engine="gibbs", seed=SEED, draws=extent.draws))
    worth, orders = worth_table(ranked), order_table(cohorts)
    damping = damping_table(opened.modes, study.maze)
    tables = {
        "worth": worth,
        "orders": orders,
        "cohorts": cohorts,
        "measured": measured_table(pool.metrics),
        "laps": pool.laps,
        "stuck_surface": surface,
        "least_damping": least,
        "damping": damping,
    }
    return Reproduction(
        "carmichael2017",
        "Carmichael, Aldini, Liu (2017), Human User Impressions of Damping Methods for Singularity Handling "
        "in Human-Robot Collaboration",
        tables,
        (
            *claims.of_the_text(),
            _of_the_model(ranked),
            *claims.of_the_equations(damping),
            *claims.of_the_robot(least, pool.laps, pool.metrics, study.maze),
            *of_stuck(cohorts, surface),
            *of_the_ranks(cohorts, orders, worth),
        ),
        simulated=f"{extent.pool} simulated people: nothing here is evidence about people",
    )


def worth_table(ranked: Fit) -> pd.DataFrame:
    """Worth of each mode by question: mean and 94 % interval of the gibbs engine, as figure 5 was made."""
    rows = [
        (q.question.name, q.question.short, m.mode, m.worth_mean, m.worth_hdi_low, m.worth_hdi_high, m.p_best)
        for q in ranked.questions
        for m in q.modes
    ]
    columns = ["question", "short", "mode", "worth", "worth_low", "worth_high", "p_first"]
    return pd.DataFrame(rows, columns=columns)


@dataclass
class _Count:
    """One count over all stages, in laps: a cohort takes about as long as one."""

    tell: Progress
    total: int
    done: int = 0

    def stage(self, laps: int = 1) -> Progress:
        """A progress callback for the next stage, each of whose steps takes so many laps."""
        before = self.done

        def report(done: int, total: int, what: str) -> None:
            self.done = before + laps * done
            self.tell(self.done, self.total, what)

        return report


def _laps_of_a_comparison(study: Study) -> int:
    return 2 * study.protocol.laps_per_condition


def _laps(study: Study, extent: Extent) -> int:
    comparisons = extent.pool * len(study.pairs) * study.protocol.repetitions
    conditions = extent.swept * (len(extent.edges) + len(study.modes) - 1)
    return (
        comparisons * _laps_of_a_comparison(study)
        + conditions * study.protocol.laps_per_condition
        + extent.braked * len(DAMPINGS)
        + extent.cohorts
    )


def _simulated(opened: OpenedStudy, extent: Extent, n_jobs: int, count: _Count) -> _Pool:
    """The first people are the study that is drawn; the same call then completes the pool."""
    a_comparison = _laps_of_a_comparison(opened.study)
    with tempfile.TemporaryDirectory() as folder, Store.open(Path(folder) / "study.sqlite") as store:

        def simulate(people: int) -> None:
            stage = count.stage(a_comparison)
            simulate_cohort(opened, store, people, seed=SEED, n_jobs=n_jobs, progress=stage)

        simulate(extent.people)
        stored = store.study(None)
        answers = store.responses_table(stored, include_simulated=True)
        simulate(extent.pool)
        metrics = store.metric_table(stored, include_simulated=True)
        assert metrics is not None
        laps = _lap_table(opened.study, store.trials(stored))
        return _Pool(answers, felt_by(store, stored), laps, metrics.rows)


def _lap_table(study: Study, trials: Sequence[Trial]) -> pd.DataFrame:
    """How the laps under each mode ended, and how near the lock they came."""
    rows = []
    for mode in study.mode_names:
        laps = [trial for trial in trials if trial.mode == mode]
        ends = Counter(lap.outcome for lap in laps)
        least = [lap.metrics["sigma_min"] for lap in laps]
        near = sum(sigma < NEAR_LOCK for sigma in least)
        inside = sum(sigma < study.stuck.sigma_below for sigma in least)
        rows.append((mode, len(laps), ends["completed"], ends["stuck"], near, inside))
    return pd.DataFrame(rows, columns=["mode", "laps", "completed", "stuck", "near_lock", "in_lock"])


def _surface(study: Study, extent: Extent, n_jobs: int, count: _Count) -> pd.DataFrame:
    """M1 over all edges; M2 and M3 at the farthest, where they would be the likeliest to get stuck."""
    tables = [
        sweep(
            study,
            edges,
            DWELLS,
            extent.swept,
            seed=SEED,
            n_jobs=n_jobs,
            modes=modes,
            progress=count.stage(),
        ).table
        for modes, edges in ((("M1",), extent.edges), (("M2", "M3"), extent.edges[-1:]))
    ]
    return pd.concat(tables, ignore_index=True)


def _of_the_model(ranked: Fit) -> Verdict:
    worths = [q.draws.worth for q in ranked.questions if q.draws is not None]
    off = max(float(abs(w.sum(axis=2) - 1.0).max()) for w in worths)
    inside = all(bool(((w >= 0) & (w <= 1)).all()) for w in worths)
    return Verdict(
        "The Bradley-Terry model gives each mode a measure from 0 to 1, all three adding up to 1 (3)",
        "0 to 1, sum 1",
        f"in {sum(w.shape[0] * w.shape[1] for w in worths)} draws of the Gibbs sampler of Caron and Doucet "
        f"(2012), which the paper names, the sum is off by at most {off:.0e}",
        "",
        judge(inside and off < 1e-9),
    )
