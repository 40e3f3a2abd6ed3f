"""`elbowroom calibrate`: whether the report's probabilities are as good as they say."""

from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.options import (
    CORES,
    JobsOption,
    LapseOption,
    OutOption,
    PersonScaleOption,
    PersonSideOption,
    PositionOption,
    SeedOption,
)

if TYPE_CHECKING:
    from rich.table import Table

    from analysis.calibration import Calibration


def calibrate(
    out: OutOption,
    levels: Annotated[int, typer.Option("--levels", metavar="2..9", help="Levels of the scale.")] = 3,
    link: Annotated[
        str,
        typer.Option("--link", metavar="cumulative|adjacent", help="How a lead becomes an answer."),
    ] = "cumulative",
    pooled: Annotated[
        bool, typer.Option("--pooled", help="People do not differ, neither in the answers nor in the model.")
    ] = False,
    no_side_effect: Annotated[
        bool, typer.Option("--no-side-effect", help="Nobody prefers a side, nor does the model know of it.")
    ] = False,
    lapse: LapseOption = False,
    person_side: PersonSideOption = False,
    person_scale: PersonScaleOption = False,
    position: PositionOption = False,
    participants: Annotated[
        int, typer.Option("--participants", metavar="N", help="People in each simulated study.")
    ] = 7,
    repetitions: Annotated[
        int, typer.Option("--repetitions", metavar="N", help="Times each person compares each pair.")
    ] = 2,
    modes: Annotated[int, typer.Option("--modes", metavar="N", help="Modes, every pair compared.")] = 3,
    replicates: Annotated[int, typer.Option("--replicates", metavar="N", help="Simulated studies.")] = 1000,
    seed: SeedOption = 1,
    jobs: JobsOption = CORES,
) -> None:
    """Simulation-based calibration of the model and the sampler that reports use.

    True values are drawn from the priors, answers from the true values, and a report's own fit must then hold
    the true values as often as it says. Exits with 0 also if it does not, and says so.

    Example: elbowroom calibrate --levels 5 --replicates 1000 --out calibration
    """
    from typing import get_args

    from analysis.calibration import SUMMARY, Design, check_replicates, world_of, write_calibration
    from analysis.calibration import calibrate as run_calibration
    from analysis.calibration import notes as notes_on
    from analysis.calibration import verdict as verdict_on
    from analysis.results import FitSettings, Link
    from app.cli.progress import progress
    from data.errors import one_of
    from data.locations import check_folder

    links: dict[str, Link] = {name: name for name in get_args(Link)}
    if link not in links:
        raise one_of("--link", link, tuple(links))
    settings = FitSettings(
        pooled=pooled,
        side_effect=not no_side_effect,
        link=links[link],
        lapse=lapse,
        person_side=person_side,
        person_scale=person_scale,
        position=position,
    )
    model = world_of(settings, levels)
    design = Design(participants, repetitions, modes)
    check_replicates(replicates)
    check_folder(out, SUMMARY)
    with progress("Replicates") as report:
        result = run_calibration(
            model, design, replicates=replicates, seed=seed, n_jobs=jobs, progress=report
        )
    paths = write_calibration(result, out)
    _print(_table(result))
    print(verdict_on(result))
    print("\n".join(notes_on(result)))
    print("\n".join(str(path) for path in paths))


def _table(result: "Calibration") -> "Table":
    """Coverage by quantity and level, with a ! where it lies outside its band."""
    from rich import box
    from rich.table import Table

    levels = sorted({check.level for check in result.coverages})
    bands = {c.level: f"{100 * c.band_low:.1f}-{100 * c.band_high:.1f}" for c in result.coverages}
    table = Table(
        title="How often central intervals hold the true value [%]", title_justify="left", box=box.SIMPLE
    )
    table.add_column("interval", no_wrap=True)
    for level in levels:
        table.add_column(f"{100 * level:.0f} %", justify="right", no_wrap=True)
    table.add_column("ECDF p", justify="right", no_wrap=True)
    for shape in result.uniformities:
        own = {c.level: c for c in result.coverages if c.parameter == shape.parameter}
        cells = [_marked(f"{100 * own[level].coverage:.1f}", own[level].inside) for level in levels]
        table.add_row(shape.parameter, *cells, _marked(f"{shape.p_value:.2g}", shape.inside))
    limit = result.uniformities[0].limit
    table.add_section()
    table.add_row("band", *(bands[level] for level in levels), f"> {limit:.2g}", style="dim")
    return table


def _marked(text: str, inside: bool) -> str:
    return text if inside else f"[bold red]{text} ![/]"


def _print(table: "Table") -> None:
    from rich.console import Console

    Console(highlight=False).print(table)
