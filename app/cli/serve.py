"""`elbowroom serve`: the study in the browser."""

from typing import Annotated

import typer

from app.cli.options import StoreOption, StudyOption


def serve(
    study: StudyOption = "carmichael2017",
    store: StoreOption = None,
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to listen on; 0 takes a free one.")
    ] = 8501,
    workers: Annotated[
        int | None, typer.Option(min=1, max=64, metavar="N", help="Processes that run the robot.")
    ] = None,
) -> None:
    """Serve the participant's pages and the researcher's console.

    Prints a link for participants and a one-time link for the researcher.

    Example: elbowroom serve --study carmichael2017 --store study.sqlite
    """
    from app.server.serving import serve as run_server
    from data.locations import default_store

    run_server(study, store or default_store(), host, port, workers)
