"""`elbowroom simulate`: a simulated cohort goes through a study, into a store."""

from typing import Annotated

import typer

from app.cli.options import CORES, JobsOption, SeedOption, StoreOption, StudyOption


def simulate(
    participants: Annotated[
        int, typer.Option("--participants", min=1, max=10_000, metavar="N", help="How many to simulate.")
    ],
    study: StudyOption = "carmichael2017",
    store: StoreOption = None,
    seed: SeedOption = 2017,
    jobs: JobsOption = CORES,
) -> None:
    """Send simulated participants through a study; their answers are marked as simulated.

    A cohort that was interrupted is completed by the same command.

    Example: elbowroom simulate --study carmichael2017 --store study.sqlite --participants 7 --seed 1
    """
    from app.cli.progress import progress
    from app.cohort import simulate_cohort
    from app.studies import check_can_be_simulated, open_study
    from data.locations import default_store
    from data.store import Store

    opened = open_study(study)
    check_can_be_simulated(opened.study, study)
    with Store.open(store or default_store()) as kept, progress("Simulated cohort") as report:
        result = simulate_cohort(opened, kept, participants, seed=seed, n_jobs=jobs, progress=report)
    print(result.sentence)
