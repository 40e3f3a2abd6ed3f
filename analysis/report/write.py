"""From a fit to a report folder."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from analysis.association import association_claims
from analysis.closer_look import closer_look
from analysis.covariates import covariate_claims
from analysis.data_quality import data_quality
from analysis.lag import LagExclusion
from analysis.posterior import write_posterior
from analysis.refits import Refits
from analysis.report.cautions import about_convergence, cautions
from analysis.report.claims import report_claims, write_findings
from analysis.report.findings import findings
from analysis.report.size import size_cautions
from analysis.report.stuck import stuck_claims
from analysis.report.summary import Json, summarise, versions, write_summary
from analysis.report.tables import (
    write_closer_look,
    write_quality,
    write_refits,
    write_straight_lines,
    write_tables,
)
from analysis.results import Fit, Quantity
from analysis.straight_lining import straight_lining
from analysis.stuck import StuckRate, stuck_rates
from analysis.stuck_contrasts import stuck_contrasts
from data.locations import writing_folder
from data.records import Look
from data.responses import LagTable, MetricTable, PaceTable, ResponseTable, StuckTable
from data.study import Study

Progress = Callable[[int, int, str], None]
"""Called with steps done, steps in all and what is being written."""
STEPS = 4
MARKER = "summary.json"
"""Written last; tells an earlier report, which may be replaced."""
OWNS = (
    "report.html",
    "figures",
    "worth.csv",
    "pairwise.csv",
    "parameters.csv",
    "findings.csv",
    "stuck.csv",
    "delay.csv",
    "lag.csv",
    "checks.csv",
    "careless.csv",
    "careless_left_out.csv",
    "equivalence.csv",
    "strength.csv",
    "people.csv",
    "agreement.csv",
    "consistency.csv",
    "predictive.csv",
    "monte_carlo.csv",
    "measures.csv",
    "association.csv",
    "stuck_contrasts.csv",
    "models.csv",
    "priors.csv",
    "covariates.csv",
    "groups.csv",
    "summary.json",
    "posterior.nc",
)
"""Everything a report folder holds: what an earlier report left of it does not outlive the next."""


@dataclass(frozen=True)
class ReportResult:
    """What was written.

    Attributes
    ----------
    folder : Path
    paths : tuple of Path
        Every file of the report, ``report.html`` first.
    summary : mapping
        The content of ``summary.json``.
    notes : tuple of str
        What the page cautions of, for a terminal that says by itself whether the sampler converged.
    """

    folder: Path
    paths: tuple[Path, ...]
    summary: Mapping[str, Json]
    notes: tuple[str, ...]


def write_report(
    table: ResponseTable,
    fit: Fit,
    out: Path,
    stuck: StuckTable | None = None,
    study: Study | None = None,
    progress: Progress | None = None,
    lag: LagTable | None = None,
    excluded: LagExclusion | None = None,
    metrics: MetricTable | None = None,
    refitted: Refits | None = None,
    pace: PaceTable | None = None,
    looks: Sequence[Look] = (),
) -> ReportResult:
    """Write ``report.html``, its figures, and the tables, summary and posterior to a folder.

    Parameters
    ----------
    table, fit
        The responses and what was made of them.
    out : Path
        New, empty, or an earlier report, whose files are then replaced.
    stuck : StuckTable or None
        Where it is known in which comparisons the robot got stuck.
    study : Study or None
        Names the study and how its trials were made.
    progress : callable or None
        Called with steps done, steps in all and what is being written.
    lag : LagTable or None
        Where people guided the robot: how promptly it followed, in all comparisons.
    excluded : LagExclusion or None
        What ``table`` and ``stuck`` leave out because of lag, and what that changes.
    metrics : MetricTable or None
        Objective metrics of the laps behind the answers, where they are known.
    refitted : Refits or None
        What refits tell, for a full report.
    pace : PaceTable or None
        How long the answers took, where it is known.
    looks : sequence of Look
        When results were shown before, at other answers than these, where a store kept that.

    Raises
    ------
    InputError
        If ``out`` holds something that is no report.
    ElbowroomError
        If the folder cannot be written; nothing is left behind then.
    """
    tell = progress or (lambda done, total, now: None)
    rates = _known_rates(stuck, fit)
    checks = int(table.rows.loc[table.rows["check"].astype(bool), "count"].sum())
    quality = data_quality(table, fit.modes, lag, excluded)
    look = closer_look(table, fit, metrics)
    contrasts = stuck_contrasts(stuck, rates) if stuck is not None and rates else ()
    lines = straight_lining(table, fit, pace, lambda: tell(0, STEPS, "without people who answer in a line"))
    found = findings(fit)
    more = (*stuck_claims(contrasts, rates), *association_claims(look.associations, fit))
    if refitted is not None:
        more += covariate_claims(refitted.effects)
    claims = report_claims(fit, found, look, refitted, more)
    about_size = size_cautions(fit, found, looks, table.look)
    said = cautions(table, fit, found, study, checks, quality, look.checks, lines, about_size)
    notes = tuple(caution for caution in said if caution not in about_convergence(fit))
    summary = summarise(table, fit, study, said, checks, excluded)
    with writing_folder(out, marker=MARKER, owns=OWNS) as folder:
        tell(0, STEPS, "tables")
        write_tables(fit, rates, _more_parameters(rates), folder)
        write_quality(quality.delays, excluded.changes if excluded else (), quality.checks, folder)
        write_closer_look(look, contrasts, folder)
        write_straight_lines(lines, folder)
        if refitted is not None:
            write_refits(refitted, folder)
        write_findings(claims, folder)
        write_summary(summary, folder / "summary.json")
        tell(1, STEPS, "posterior")
        write_posterior(fit, folder / "posterior.nc")
        tell(2, STEPS, "figures")
        from analysis.report.compose import compose
        from analysis.report.page import render

        page = compose(
            table,
            fit,
            look,
            rates,
            contrasts,
            quality,
            refitted,
            study,
            said,
            versions(fit.settings.engine),
            lines,
        )
        figures = folder / "figures"
        figures.mkdir()
        for section in page.sections:
            for drawing in section.drawings:
                drawing.write(figures)
        tell(3, STEPS, "page")
        (folder / "report.html").write_text(render(page), encoding="utf-8", newline="\n")
        tell(STEPS, STEPS, "")
        names = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    names.sort(key=lambda name: name.name != "report.html")
    return ReportResult(out, tuple(out / name for name in names), summary, notes)


def _more_parameters(rates: tuple[StuckRate, ...]) -> list[tuple[str, Quantity]]:
    """Hierarchical stuck rates, per comparison and per minute, as rows of no question."""
    return [
        ("", rate)
        for per in ([r.between for r in rates], [r.per_minute_between for r in rates])
        for rate in per
        if rate is not None
    ]


def _known_rates(stuck: StuckTable | None, fit: Fit) -> tuple[StuckRate, ...]:
    """Stuck rates of the modes that were tried; none if no trials are known."""
    if stuck is None or stuck.rows.empty:
        return ()
    return tuple(rate for rate in stuck_rates(stuck, fit.modes) if rate.comparisons)
