"""`elbowroom export` and `elbowroom import`: a study's data out of a store and into one."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import OutOption, SimulatedOption, StoredStudyOption, StoreOption, StudyOption
from data.errors import InputError


def export(
    out: OutOption,
    store: StoreOption = None,
    study: StoredStudyOption = None,
    include_simulated: SimulatedOption = False,
) -> None:
    """Write tidy CSV files, a codebook, a data package and the recordings of a study.

    Example: elbowroom export --store study.sqlite --out export
    """
    from app.cli.progress import progress
    from data.export import export_study
    from data.locations import default_store
    from data.store import Store

    with Store.open(store or default_store(), create=False) as kept, progress("Export") as report:
        stored = kept.study(study)
        result = export_study(kept, stored, out, include_simulated=include_simulated, progress=report)
    print(f"{result.folder}: {result.responses} responses, {result.trials} trials")


def import_(
    responses: Annotated[
        Path | None, typer.Option("--responses", metavar="FILE.csv", help="Answers collected elsewhere.")
    ] = None,
    stuck: Annotated[
        Path | None, typer.Option("--stuck", metavar="FILE.csv", help="Stuck events collected elsewhere.")
    ] = None,
    study: StudyOption = "carmichael2017",
    store: StoreOption = None,
) -> None:
    """Bring answers or stuck events that were collected elsewhere into a store.

    Example: elbowroom import --responses answers.csv --study my_study.toml --store study.sqlite
    """
    from app.studies import open_study
    from data.importing import import_responses, import_stuck
    from data.locations import default_store
    from data.store import Store

    if (responses is None) == (stuck is None):
        raise InputError("give one of --responses FILE.csv and --stuck FILE.csv")
    opened = open_study(study)
    with Store.open(store or default_store()) as kept:
        if responses is not None:
            count = import_responses(responses, opened.study, opened.text, kept)
            print(f"{responses}: {count} responses imported")
        elif stuck is not None:
            count = import_stuck(stuck, opened.study, opened.text, kept)
            print(f"{stuck}: {count} stuck events imported")
