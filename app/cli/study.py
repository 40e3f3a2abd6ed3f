"""`elbowroom study`: the built-in studies, and the check of a study file."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

from app.cli.options import CORES, JobsOption, OutOption
from data.study import Study
from data.study_file import built_in_studies

if TYPE_CHECKING:
    from sim_trials.modes.method import ResolvedMode

cli = typer.Typer(help="Built-in studies, and the check of a study file.")
Source = Annotated[str, typer.Argument(metavar="S", help="A study file, or the name of a built-in study.")]


@cli.command("list")
def list_() -> None:
    """The studies that ship with Elbowroom.

    Example: elbowroom study list
    """
    from app.studies import open_study

    for name in built_in_studies():
        study = open_study(name).study
        print(
            f"{name}  {study.title} ({len(study.modes)} modes, {len(study.questions)} questions, "
            f"{study.protocol.trial_source} trials)"
        )


@cli.command("check")
def check(source: Source) -> None:
    """Validate a study file; exit 2 and one line if something is wrong.

    Example: elbowroom study check my_study.toml
    """
    from app.planning import expectation
    from app.studies import cautions, check_can_be_run, open_study
    from data.schedule import plan_session

    opened = open_study(source)
    study = opened.study
    check_can_be_run(study, source)
    comparisons = len(plan_session(study, 1))
    print(
        f"{source}: valid. {study.name} version {study.version}, {study.protocol.trial_source} trials, "
        f"{len(study.modes)} modes, {len(study.questions)} questions, "
        f"{comparisons} comparisons a participant, hash {study.sha256[:12]}"
    )
    for caution in cautions(study, opened.modes):
        print(f"{source}: note: {caution}")
    print(f"{source}: note: {expectation(study)} Other assumptions: elbowroom power.")


@cli.command("show")
def show(source: Source = "carmichael2017") -> None:
    """What a study compares, asks and does.

    Example: elbowroom study show carmichael2017
    """
    from app.studies import cautions, open_study

    opened = open_study(source)
    study, console = opened.study, Console()
    console.print(f"[bold]{study.title}[/bold]  {study.name}, version {study.version}", highlight=False)
    if study.description:
        console.print(study.description, highlight=False)
    if opened.modes:
        modes = Table("Mode", "Method", "Parameters", box=None, header_style="dim")
        for mode, resolved in zip(study.modes, opened.modes, strict=True):
            values = zip(resolved.method.parameter_names, resolved.values, strict=True)
            given = ", ".join(f"{name} = {value:g}" for name, value in values)
            modes.add_row(mode.name, mode.method, given)
    else:
        modes = Table("Mode", "On the robot", box=None, header_style="dim")
        for mode in study.modes:
            modes.add_row(mode.name, mode.description)
    questions = Table("Question", "Wording", "Levels", "Ranks first when", box=None, header_style="dim")
    for question in study.questions:
        questions.add_row(question.name, question.wording, str(question.levels), question.short)
    console.print(modes)
    if opened.modes:
        console.print(_behaviour(study, opened.modes))
        console.print(
            "Gain is what is left of a command along the direction that the elbow-lock takes away, \u03bb "
            f"the damping it amounts to. Figures, laps, rules: elbowroom study atlas {source} --out atlas",
            highlight=False,
        )
        for caution in cautions(study, opened.modes):
            console.print(f"Note: {caution}", highlight=False)
    console.print(questions)
    for line in _protocol(study):
        console.print(line, highlight=False)
    if study.protocol.trial_source == "external":
        return
    console.print(
        f"Maze: y {study.maze.left_y_m:g} to {study.maze.right_y_m:g} m, z {study.maze.top_z_m:g} to "
        f"{study.maze.bottom_z_m:g} m, wall at x = {study.maze.wall_x_m:g} m. Stuck: sigma_min below "
        f"{study.stuck.sigma_below:g} for longer than {study.stuck.dwell_s:g} s ({study.stuck.definition})",
        highlight=False,
    )


@cli.command("atlas")
def atlas(
    source: Source,
    out: OutOption,
    operators: Annotated[
        int,
        typer.Option("--operators", min=0, max=1000, metavar="N", help="Simulated laps under each mode."),
    ] = 6,
    every_method: Annotated[
        bool, typer.Option("--every-method", help="Beside the study's modes every known method.")
    ] = False,
    jobs: JobsOption = CORES,
) -> None:
    """How each mode behaves towards the singularity and away from it, on one page.

    Example: elbowroom study atlas carmichael2017 --out atlas

    Example: elbowroom study atlas carmichael2017 --every-method --out atlas
    """
    from app.atlas import PAGE, study_atlas, with_every_method, write_atlas
    from app.cli.progress import progress
    from app.studies import open_study
    from data.locations import check_folder

    study = open_study(source).study
    if every_method:
        study = with_every_method(study)
    check_folder(out, PAGE)
    with progress("Atlas") as report:
        made = study_atlas(study, source, operators, jobs, report)
    for laps in made.laps:
        print(f"{laps.name}: {laps.verdict}")
    print("\n".join(str(path) for path in write_atlas(made, out)))


_WHO_MOVES = {
    "guided": "Each participant guides the simulated robot in the browser",
    "observed": "Participants watch laps of a simulated operator",
    "external": "A robot in the lab, which an operator tends",
}


def _behaviour(study: Study, resolved: "tuple[ResolvedMode, ...]") -> Table:
    """Each mode into the elbow-lock and out of it."""
    from app.atlas_tables import curves_table
    from sim_trials.mode_atlas import mode_curves

    cells = curves_table([mode_curves(mode, study.maze) for mode in resolved])
    table = Table(box=None, header_style="dim")
    for k, title in enumerate(cells.head):
        table.add_column(title, justify="right" if k in cells.numbers else "left")
    for row in cells.rows:
        table.add_row(*row)
    return table


def _protocol(study: Study) -> Iterator[str]:
    """What a participant goes through, a line a thing."""
    protocol = study.protocol
    laps = {
        "guided": "",
        "observed": f"{protocol.laps_per_condition} laps per condition, ",
        "external": "",
    }[protocol.trial_source]
    yield (
        f"Protocol: {len(study.pairs)} pairs, each {protocol.repetitions} times, {laps}"
        f"at least {protocol.minimum_exposure_s:g} s of each, {protocol.trial_source} trials, "
        f"{protocol.attention_checks} attention checks, seed {study.seed}"
    )
    yield f"Trials: {_WHO_MOVES[protocol.trial_source]}"
    if study.background:
        asked = ", ".join(f"{q.name}{' (required)' if q.required else ''}" for q in study.background)
        yield f"Background: {asked}"
    if study.has_practice:
        maze = study.practice_study.maze
        yield (
            f"Practice: {study.practice.laps} lap{'' if study.practice.laps == 1 else 's'} with "
            f"{study.practice_mode}, "
            f"y {maze.left_y_m:g} to {maze.right_y_m:g} m"
        )
    coming_back = {
        "resume": "goes on where they left",
        "restart_comparison": "begins the open comparison anew",
    }[protocol.returning]
    within = f", within {protocol.returning_within_h:g} h of joining" if protocol.returning_within_h else ""
    yield f"Coming back: a participant {coming_back}{within}"
