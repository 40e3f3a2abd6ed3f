"""`elbowroom report`: from stored or collected responses to a Bradley-Terry report."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import (
    LapseOption,
    OutOption,
    PersonScaleOption,
    PersonSideOption,
    PositionOption,
    SimulatedOption,
    StoredStudyOption,
    StoreOption,
)
from data.errors import InputError


class Engine(StrEnum):
    """How the posterior is computed."""

    fast = "fast"
    pymc = "pymc"
    gibbs = "gibbs"


class Link(StrEnum):
    """How ties enter the likelihood."""

    cumulative = "cumulative"
    adjacent = "adjacent"


def report(
    out: OutOption,
    store: StoreOption = None,
    responses: Annotated[
        Path | None, typer.Option("--responses", metavar="FILE.csv", help="Responses from a CSV instead.")
    ] = None,
    study: StoredStudyOption = None,
    engine: Annotated[Engine, typer.Option(help="fast is the default and needs no compiler.")] = Engine.fast,
    pooled: Annotated[bool, typer.Option("--pooled", help="Leave participants' differences out.")] = False,
    no_side_effect: Annotated[
        bool, typer.Option("--no-side-effect", help="Leave the preference for side A out.")
    ] = False,
    prior_sd: Annotated[
        float, typer.Option("--prior-sd", metavar="X", help="Sigma of the ability prior alone.")
    ] = 1.0,
    link: Annotated[Link, typer.Option(help="adjacent: three-level questions only.")] = Link.cumulative,
    lapse: LapseOption = False,
    person_side: PersonSideOption = False,
    person_scale: PersonScaleOption = False,
    position: PositionOption = False,
    levels: Annotated[
        int | None,
        typer.Option(
            "--levels",
            metavar="2..9",
            help="Levels of every scale, where no study says it. Default: inferred from the answers.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option("--seed", min=0, max=2**31 - 1, help="Seed of the sampler.")] = 2017,
    full: Annotated[
        bool,
        typer.Option(
            "--full",
            help="Add what needs refits: models compared by leaving out participants, other priors, laggy "
            "comparisons left out, worth on metrics, groups of people. Takes a minute or more.",
        ),
    ] = False,
    largest_group: Annotated[
        bool,
        typer.Option(
            "--largest-group",
            help="Where comparisons leave modes in groups that nothing connects, rank the largest alone.",
        ),
    ] = False,
    include_simulated: SimulatedOption = False,
    max_latency_ms: Annotated[
        float | None,
        typer.Option(
            "--max-latency-ms",
            metavar="X",
            help="Leave out comparisons with a guided lap whose input delay (95th percentile) is above X ms.",
        ),
    ] = None,
    max_skipped: Annotated[
        float | None,
        typer.Option(
            "--max-skipped",
            metavar="PERCENT",
            help="Leave out comparisons with a guided lap that skipped more of its control ticks.",
        ),
    ] = None,
) -> None:
    """Rank the modes per question and write report.html, figures and tables.

    Examples:

    elbowroom report --store study.sqlite --out report

    elbowroom report --store study.sqlite --out report --full

    elbowroom report --responses answers.csv --study carmichael2017 --out report

    elbowroom report --responses answers.csv --levels 7 --lapse --out report

    elbowroom report --store study.sqlite --max-latency-ms 100 --max-skipped 1 --out report
    """
    from analysis.lag import LagLimits
    from app.reporting import Request, make_report

    if store is not None and responses is not None:
        raise InputError("give --store or --responses, not both")
    if levels is not None and (responses is None or study is not None):
        raise InputError(
            "--levels: a study says how many levels its questions have; valid with --responses alone"
        )
    if not 0.01 <= prior_sd <= 100:
        raise InputError(f"--prior-sd: {prior_sd:g} is not between 0.01 and 100")
    if max_latency_ms is not None and not 0 < max_latency_ms <= 60_000:
        raise InputError(f"--max-latency-ms: {max_latency_ms:g} is not above 0 and up to 60000")
    if max_skipped is not None and not 0 <= max_skipped <= 100:
        raise InputError(f"--max-skipped: {max_skipped:g} is not between 0 and 100")
    make_report(
        Request(
            out=out,
            store=store,
            responses=responses,
            study=study,
            include_simulated=include_simulated,
            engine=engine.value,
            pooled=pooled,
            side_effect=not no_side_effect,
            prior_sd=prior_sd,
            link=link.value,
            lapse=lapse,
            person_side=person_side,
            person_scale=person_scale,
            position=position,
            levels=levels,
            seed=seed,
            lag_limits=LagLimits(max_latency_ms, max_skipped),
            full=full,
            largest_group=largest_group,
        )
    )
