"""`elbowroom demo`: the whole job without a person."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import CORES, SeedOption
from data.errors import InputError


def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder to write.")] = Path(
        "elbowroom-demo"
    ),
    participants: Annotated[
        int, typer.Option("--participants", min=1, max=1000, metavar="N", help="Simulated people.")
    ] = 7,
    seed: SeedOption = 2017,
) -> None:
    """Simulate the 2017 study on the MuJoCo UR10, rank its modes, write report and export.

    Everything it makes is marked as simulated.

    Example: elbowroom demo --out elbowroom-demo
    """
    from app.cli.progress import progress
    from app.cohort import participant_id, simulate_cohort
    from app.reporting import Request, make_report
    from app.studies import open_study
    from data.export import export_study
    from data.locations import check_folder
    from data.store import Store

    opened = open_study("carmichael2017")
    check_folder(out)
    store_path = out / "study.sqlite"
    print("Elbowroom demo: a simulated cohort. What it says is about the simulation, not about people.")
    cohort_ids = {participant_id(opened.study, seed, n) for n in range(1, participants + 1)}
    with Store.open(store_path) as store:
        others = [p for s in store.studies() for p in store.participants(s) if p.id not in cohort_ids]
        if others:
            raise InputError(
                f"--out: {store_path} holds {len(others)} participants who are not of this demo; name "
                "another folder"
            )
        with progress("Simulated cohort") as report:
            cohort = simulate_cohort(opened, store, participants, seed=seed, n_jobs=CORES, progress=report)
        print(cohort.sentence)
        make_report(Request(out=out / "report", store=str(store_path), include_simulated=True, seed=seed))
        with progress("Export") as report:
            export = export_study(
                store, store.study(None), out / "export", include_simulated=True, progress=report
            )
    print(f"report: {out / 'report' / 'report.html'}")
    print(f"export: {export.folder}")
    print(f"store:  {store_path}")
