"""`elbowroom serve`: the study in the browser."""

import os
from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import StoreOption, StudyOption


def serve(
    study: StudyOption = "carmichael2017",
    store: StoreOption = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; 0.0.0.0 lets others in the network in.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to listen on; 0 takes a free one.")
    ] = 8501,
    workers: Annotated[
        int | None, typer.Option(min=1, max=64, metavar="N", help="Processes that run the robot.")
    ] = None,
    passphrase_file: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Passphrase that opens the console; or set ELBOWROOM_PASSPHRASE."),
    ] = None,
    public_url: Annotated[
        str | None,
        typer.Option(metavar="URL", help="Where browsers reach it, such as https://study.example.org."),
    ] = None,
) -> None:
    """Serve the participant's pages and the researcher's console.

    Prints a link for participants and a one-time link for the researcher. With a passphrase, the console
    opens at /researcher too. Behind a proxy, --public-url is needed.

    Example: elbowroom serve --study carmichael2017 --store study.sqlite
    """
    from app.server.passphrase import read_passphrase
    from app.server.serving import serve as run_server
    from data.locations import default_store

    passphrase = read_passphrase(passphrase_file, os.environ)
    run_server(study, store or default_store(), host, port, workers, passphrase, public_url)
