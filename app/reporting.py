"""From responses, stored or collected, to a fitted and written report."""

import sys
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path

from rich.console import Console

from analysis.console_ranking import print_ranking
from analysis.fit import fit
from analysis.groups import largest_groups
from analysis.lag import LagExclusion, LagLimits, lag_changes, without_laggy
from analysis.looks import earlier
from analysis.order import with_order
from analysis.refits import Refits, refits
from analysis.report import MARKER, ReportResult, write_report
from analysis.results import Engine, Fit, FitSettings, Link
from app.cli.progress import Report, progress
from app.studies import open_study
from data.errors import InputError
from data.locations import check_folder, default_store
from data.records import Look
from data.response_csv import read_response_csv
from data.responses import BackgroundTable, LagTable, MetricTable, PaceTable, ResponseTable, StuckTable
from data.store import Store
from data.study import Study


@dataclass(frozen=True)
class Request:
    """What a report is asked for, in the words of the command line's options."""

    out: Path
    store: str | None = None
    responses: Path | None = None
    study: str | None = None
    include_simulated: bool = False
    engine: Engine = "fast"
    pooled: bool = False
    side_effect: bool = True
    prior_sd: float = 1.0
    link: Link = "cumulative"
    lapse: bool = False
    person_side: bool = False
    person_scale: bool = False
    position: bool = False
    levels: int | None = None
    seed: int = 2017
    lag_limits: LagLimits = field(default_factory=LagLimits)
    full: bool = False
    largest_group: bool = False


@dataclass(frozen=True)
class _Evidence:
    table: ResponseTable
    stuck: StuckTable | None
    study: Study | None
    lag: LagTable | None = None
    excluded: LagExclusion | None = None
    metrics: MetricTable | None = None
    background: BackgroundTable | None = None
    pace: PaceTable | None = None
    looks: tuple[Look, ...] = ()


def make_report(request: Request) -> ReportResult:
    """Read, check, fit, write and print a report.

    Everything that can be wrong with the input is found before anything is sampled, and the folder is
    known to be writable before as well.

    Raises
    ------
    InputError
        Wrong input, exit 2.
    ElbowroomError
        A folder that cannot be written, exit 1.
    """
    everything = _read(request)
    if request.position:
        # Places are those among all comparisons, also where some are left out later.
        everything = replace(everything, table=with_order(everything.table))
    evidence = _without_laggy(everything, request.lag_limits)
    if request.largest_group:
        evidence = replace(evidence, table=largest_groups(evidence.table))
    settings = FitSettings(
        engine=request.engine,
        pooled=request.pooled,
        side_effect=request.side_effect,
        prior_sd=request.prior_sd,
        link=request.link,
        lapse=request.lapse,
        person_side=request.person_side,
        person_scale=request.person_scale,
        position=request.position,
        seed=request.seed,
    )
    check_folder(request.out, MARKER)
    with progress("Bradley-Terry model") as report:
        fitted = fit(evidence.table, settings, progress=report)
    excluded = evidence.excluded
    if excluded is not None:
        excluded = replace(excluded, changes=lag_changes(_fit_of_all(everything, excluded, fitted), fitted))
    refitted = _refitted(evidence, fitted) if request.full else None
    with progress("Report") as report:
        written = write_report(
            evidence.table,
            fitted,
            request.out,
            stuck=evidence.stuck,
            study=evidence.study,
            progress=report,
            lag=evidence.lag,
            excluded=excluded,
            metrics=evidence.metrics,
            refitted=refitted,
            pace=evidence.pace,
            looks=earlier(everything.looks, everything.table.look),
        )
    if request.responses is None:
        _keep_look(request, everything.table)
    for caution in written.notes:
        print(f"note: {caution}", file=sys.stderr)
    if excluded is not None and not excluded.comparisons:
        print(f"note: none of {excluded.total} comparisons is left out because of lag", file=sys.stderr)
    print_ranking(fitted, Console(), is_simulated=evidence.table.is_simulated)
    return written


def _keep_look(request: Request, table: ResponseTable) -> None:
    """Results of people are now known to whoever made the report: the audit log keeps that."""
    with Store.open(request.store or default_store(), create=False) as store:
        store.log_look(store.study(request.study), table.look, "elbowroom report")


def _refitted(evidence: _Evidence, fitted: Fit) -> Refits:
    """What a full report compares, with a progress bar a stage."""
    with ExitStack() as stages:

        def stage(name: str) -> Report:
            stages.close()
            return stages.enter_context(progress(name))

        return refits(
            evidence.table,
            fitted,
            lag=evidence.lag if evidence.excluded is None else None,
            metrics=evidence.metrics,
            background=evidence.background,
            progress=stage,
        )


def _fit_of_all(everything: _Evidence, excluded: LagExclusion, fitted: Fit) -> Fit:
    """The fit with the laggy comparisons, by the same engine."""
    if not excluded.comparisons:
        return fitted
    with progress("The same with the laggy comparisons") as report:
        return fit(everything.table, fitted.settings, progress=report)


def _without_laggy(everything: _Evidence, limits: LagLimits) -> _Evidence:
    if not limits.is_set:
        return everything
    if everything.lag is None:
        raise InputError(
            "--max-latency-ms and --max-skipped are about trials that people guided, and none is known here"
        )
    kept = without_laggy(everything.table, everything.stuck, everything.lag, limits)
    metrics = everything.metrics
    return replace(
        everything,
        table=kept.table,
        stuck=kept.stuck,
        excluded=kept.excluded,
        metrics=None if metrics is None else metrics.without(kept.excluded.comparisons),
    )


def _read(request: Request) -> _Evidence:
    if request.responses is not None:
        if request.lag_limits.is_set:
            raise InputError(
                "--max-latency-ms and --max-skipped need a store: a CSV of responses knows no input delay"
            )
        study = open_study(request.study).study if request.study else None
        return _Evidence(read_response_csv(request.responses, study, levels=request.levels), None, study)
    with Store.open(request.store or default_store(), create=False) as store:
        stored = store.study(request.study)
        return _Evidence(
            store.responses_table(stored, include_simulated=request.include_simulated),
            store.stuck_table(stored, include_simulated=request.include_simulated),
            stored.study,
            store.lag_table(stored, include_simulated=request.include_simulated),
            metrics=store.metric_table(stored, include_simulated=request.include_simulated),
            background=store.background_table(stored, include_simulated=request.include_simulated),
            pace=store.pace_table(stored, include_simulated=request.include_simulated),
            looks=store.looks(stored),
        )
