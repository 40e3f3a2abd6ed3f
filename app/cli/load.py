"""`elbowroom load`: how many people a server on this machine bears."""

from typing import Annotated

import typer

from app.cli.options import StudyOption


def load(
    study: StudyOption = "carmichael2017",
    participants: Annotated[
        int, typer.Option("--participants", min=1, max=500, metavar="N", help="People at the robot at once.")
    ] = 20,
    seconds: Annotated[
        float, typer.Option("--seconds", min=2, max=3600, metavar="S", help="How long to measure.")
    ] = 60.0,
    workers: Annotated[
        int | None,
        typer.Option("--workers", min=1, max=64, metavar="N", help="Processes that run the robot."),
    ] = None,
    report: Annotated[
        bool, typer.Option("--report", help="Measure once more while reports are fitted.")
    ] = False,
) -> None:
    """Let scripted hands guide the robot through real sockets, and measure what they notice.

    Server and participants share this machine, so that the figures are rather too bad than too good.

    Example: elbowroom load --participants 20 --seconds 60 --report
    """
    from rich.console import Console

    from app.cli.progress import progress
    from app.load.rehearsal import rehearse
    from app.load.table import load_table
    from app.studies import open_study

    opened = open_study(study)
    with progress("Load") as said:
        measured = rehearse(
            opened,
            participants=participants,
            seconds=seconds,
            workers=workers,
            with_report=report,
            progress=said,
        )
    Console().print(load_table(measured))
