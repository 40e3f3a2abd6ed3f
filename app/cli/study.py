"""`elbowroom study`: the built-in studies, and the check of a study file."""

from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from data.study_file import built_in_studies

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
        print(f"{name}  {study.title} ({len(study.modes)} modes, {len(study.questions)} questions)")


@cli.command("check")
def check(source: Source) -> None:
    """Validate a study file; exit 2 and one line if something is wrong.

    Example: elbowroom study check my_study.toml
    """
    from app.cohort import check_can_be_simulated
    from app.studies import open_study
    from data.schedule import plan_session

    study = open_study(source).study
    check_can_be_simulated(study, source)
    comparisons = len(plan_session(study, 1))
    print(
        f"{source}: valid. {study.name} version {study.version}, {len(study.modes)} modes, "
        f"{len(study.questions)} questions, {comparisons} comparisons a participant, "
        f"hash {study.sha256[:12]}"
    )


@cli.command("show")
def show(source: Source = "carmichael2017") -> None:
    """What a study compares, asks and does.

    Example: elbowroom study show carmichael2017
    """
    from app.studies import open_study

    opened = open_study(source)
    study, console = opened.study, Console()
    console.print(f"[bold]{study.title}[/bold]  {study.name}, version {study.version}", highlight=False)
    if study.description:
        console.print(study.description, highlight=False)
    modes = Table("Mode", "Method", "Parameters", box=None, header_style="dim")
    for mode, resolved in zip(study.modes, opened.modes, strict=True):
        values = zip(resolved.method.parameter_names, resolved.values, strict=True)
        given = ", ".join(f"{name} = {value:g}" for name, value in values)
        modes.add_row(mode.name, mode.method, given)
    questions = Table("Question", "Wording", "Levels", "Ranks first when", box=None, header_style="dim")
    for question in study.questions:
        questions.add_row(question.name, question.wording, str(question.levels), question.short)
    protocol = study.protocol
    console.print(modes)
    console.print(questions)
    console.print(
        f"Protocol: {len(study.pairs)} pairs, each {protocol.repetitions} times, "
        f"{protocol.laps_per_condition} laps per condition, {protocol.trial_source} trials, "
        f"{protocol.attention_checks} attention checks, seed {study.seed}",
        highlight=False,
    )
    console.print(
        f"Maze: y {study.maze.left_y_m:g} to {study.maze.right_y_m:g} m, z {study.maze.top_z_m:g} to "
        f"{study.maze.bottom_z_m:g} m, wall at x = {study.maze.wall_x_m:g} m. Stuck: sigma_min below "
        f"{study.stuck.sigma_below:g} for longer than {study.stuck.dwell_s:g} s ({study.stuck.definition})",
        highlight=False,
    )
