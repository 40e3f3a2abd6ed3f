"""`elbowroom export` and `elbowroom import`: a study's data out of a store and into one."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.options import OutOption, SimulatedOption, StoredStudyOption, StoreOption, StudyOption
from data.errors import InputError

if TYPE_CHECKING:
    from data.batches import Repeats


def export(
    out: OutOption,
    store: StoreOption = None,
    study: StoredStudyOption = None,
    include_simulated: SimulatedOption = False,
    psych_ds: Annotated[
        bool,
        typer.Option("--psych-ds", help="Write the same tables as a Psych-DS data set instead."),
    ] = False,
) -> None:
    """Write tidy CSV files, a codebook, a data package and the recordings of a study.

    Example: elbowroom export --store study.sqlite --out export

    Example: elbowroom export --store study.sqlite --out dataset --psych-ds
    """
    from app.cli.progress import progress
    from data.export import export_study
    from data.locations import default_store
    from data.psych_ds import export_psych_ds
    from data.store import Store

    if psych_ds:
        with Store.open(store or default_store(), create=False) as kept:
            dataset = export_psych_ds(kept, kept.study(study), out, include_simulated)
        print(f"{dataset.folder}: {dataset.rows['responses']} responses, {dataset.rows['trials']} trials")
        return
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
    continues: Annotated[
        bool,
        typer.Option(
            "--continues",
            help="The file is one that was imported before, with further rows: earlier rows are not added "
            "again.",
        ),
    ] = False,
    another_batch: Annotated[
        bool,
        typer.Option(
            "--another-batch",
            help="The file holds other answers, although rows are as in a file that was imported before.",
        ),
    ] = False,
) -> None:
    """Bring answers or stuck events that were collected elsewhere into a store.

    A file of answers without a column comparison is a batch of its own: its rows are further comparisons.
    Where it repeats the rows of an earlier such file nothing is guessed, and one of the two options says
    what it is.

    Examples:

    elbowroom import --responses answers.csv --study my_study.toml --store study.sqlite

    elbowroom import --responses answers.csv --continues --study my_study.toml --store study.sqlite
    """
    from app.studies import open_study
    from data.importing import import_responses
    from data.locations import default_store
    from data.store import Store
    from data.stuck_importing import import_stuck

    if (responses is None) == (stuck is None):
        raise InputError("give one of --responses FILE.csv and --stuck FILE.csv")
    if continues and another_batch:
        raise InputError("give --continues or --another-batch, not both")
    if stuck is not None and (continues or another_batch):
        raise InputError("--continues and --another-batch are about --responses")
    repeats: Repeats | None = "continues" if continues else "another batch" if another_batch else None
    opened = open_study(study)
    with Store.open(store or default_store()) as kept:
        if responses is not None:
            count = import_responses(
                responses, opened.study, opened.text, kept, repeats=repeats, note=_print_note
            )
            print(f"{responses}: {count} response{'' if count == 1 else 's'} imported")
        elif stuck is not None:
            count = import_stuck(stuck, opened.study, opened.text, kept, note=_print_note)
            print(f"{stuck}: {count} stuck events imported")


def _print_note(text: str) -> None:
    print(f"note: {text}", file=sys.stderr)
