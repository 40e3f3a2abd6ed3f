"""`elbowroom sweep`: how the stuck rates depend on the maze's edge and the stuck dwell time."""

from typing import Annotated

import typer

from app.cli.options import CORES, JobsOption, OutOption, SeedOption, StudyOption, parse_grid


def sweep(
    out: OutOption,
    right_edge: Annotated[
        str, typer.Option("--right-edge", metavar="A:B:N", help="Right edge of the maze, y [m].")
    ] = "-1.03:-1.06:4",
    dwell: Annotated[
        str,
        typer.Option("--dwell", metavar="A:B:N", help="Time below the threshold that counts as stuck [s]."),
    ] = "3:7:5",
    participants: Annotated[
        int, typer.Option("--participants", min=1, max=10_000, metavar="N", help="Simulated people.")
    ] = 20,
    study: StudyOption = "carmichael2017",
    seed: SeedOption = 2017,
    jobs: JobsOption = CORES,
) -> None:
    """The share of comparisons with a stuck robot, over maze edge and dwell time.

    Example: elbowroom sweep --right-edge -1.03:-1.06:4 --dwell 3:7:5 --participants 20 --out sweep
    """
    from app.cli.progress import progress
    from app.studies import open_study, resolved_modes
    from data.locations import check_folder
    from sim_trials.sweep import SURFACE_TABLE, write_sweep
    from sim_trials.sweep import sweep as run_sweep

    opened = open_study(study)
    resolved_modes(opened.study, study)
    edges, dwells = parse_grid("--right-edge", right_edge), parse_grid("--dwell", dwell)
    check_folder(out, SURFACE_TABLE)
    with progress("Sweep") as report:
        result = run_sweep(opened.study, edges, dwells, participants, seed=seed, n_jobs=jobs, progress=report)
    paths = write_sweep(result, out)
    print(result.table.to_string(index=False))
    print("\n".join(str(path) for path in paths))
