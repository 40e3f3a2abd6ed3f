"""`elbowroom power`: how many participants a study needs."""

from typing import Annotated

import typer

from app.cli.options import CORES, JobsOption, OutOption, SeedOption, StudyOption
from data.errors import InputError


def power(
    out: OutOption,
    study: StudyOption = "carmichael2017",
    participants: Annotated[
        str, typer.Option("--participants", metavar="N,N,...", help="Numbers of participants to try.")
    ] = "7,14,20,30,45",
    repetitions: Annotated[
        int | None,
        typer.Option(
            "--repetitions", min=1, max=50, help="How often a person sees each pair. Default: the study's."
        ),
    ] = None,
    worth: Annotated[
        str | None,
        typer.Option(
            "--worth",
            metavar="X,X,...",
            help="Planted worth of each mode, in the study's order. Default: the last is twice as good.",
        ),
    ] = None,
    levels: Annotated[int, typer.Option("--levels", metavar="2|3|5", help="Levels of the scale.")] = 3,
    cuts: Annotated[
        str | None,
        typer.Option(
            "--cuts", metavar="X,X", help="Cut-points [logit]: larger, more ties. Default: 0.5, or 0.5,1.5."
        ),
    ] = None,
    subject_sd: Annotated[
        float, typer.Option("--subject-sd", min=0, max=10, help="Differences between people [logit].")
    ] = 0.7,
    side_effect: Annotated[
        float, typer.Option("--side-effect", min=-10, max=10, help="Preference for side A [logit].")
    ] = 0.1,
    confidence: Annotated[
        float, typer.Option("--confidence", min=0.5, max=0.999, help="P(best) that counts as a conclusion.")
    ] = 0.95,
    wanted: Annotated[
        float, typer.Option("--wanted", min=0.01, max=0.99, help="Share of right conclusions wanted.")
    ] = 0.8,
    replicates: Annotated[
        int, typer.Option("--replicates", min=10, max=100_000, help="Simulated studies of each size.")
    ] = 100,
    seed: SeedOption = 2017,
    jobs: JobsOption = CORES,
) -> None:
    """How often studies of different sizes would find the best mode, if people were as assumed.

    Example: elbowroom power --study carmichael2017 --worth 1,1,2 --participants 7,20,45 --out power
    """
    from analysis.power import POWER_TABLE, Scenario, check_scenario, write_power
    from analysis.power import power as run_power
    from app.cli.progress import progress
    from app.studies import open_study
    from data.locations import check_folder

    opened = open_study(study).study
    if repetitions is not None:
        protocol = opened.protocol.model_copy(update={"repetitions": repetitions})
        opened = opened.model_copy(update={"protocol": protocol})
    default_cuts = {2: "", 3: "0.5", 5: "0.5,1.5"}.get(levels, "")
    scenario = Scenario(
        worth=_numbers("--worth", worth or ",".join(["1"] * (len(opened.modes) - 1) + ["2"])),
        levels=levels,
        cuts=_numbers("--cuts", default_cuts if cuts is None else cuts),
        subject_sd=subject_sd,
        side_effect=side_effect,
        confidence=confidence,
    )
    check_scenario(opened, scenario)
    sizes = [int(n) for n in _numbers("--participants", participants)]
    if not sizes or min(sizes) < 1 or max(sizes) > 100_000:
        raise InputError(f"--participants: {participants!r}: whole numbers from 1 to 100000, such as 7,20,45")
    check_folder(out, POWER_TABLE)
    with progress("Simulated studies") as report:
        result = run_power(
            opened, scenario, sizes, replicates=replicates, seed=seed, n_jobs=jobs, progress=report
        )
    paths = write_power(result, wanted, out)
    for point in result.points:
        bar, wrong = "█" * round(30 * point.right_share), 100 * point.wrong / point.replicates
        interval = f"[{100 * point.low:.0f}, {100 * point.high:.0f}]"
        print(
            f"{point.participants:>6} participants  {bar:<30} {100 * point.right_share:3.0f} % right "
            f"{interval}, {wrong:.0f} % wrong"
        )
    enough = result.enough(wanted)
    if enough is None:
        print(f"None of these sizes finds the best mode in {100 * wanted:.0f} % of studies: try more.")
    else:
        print(f"{enough} participants are the fewest tried that find it in {100 * wanted:.0f} % of studies.")
    print(f"If people are as assumed (simulated for planning): {scenario.sentence}.")
    print("\n".join(str(path) for path in paths))


def _numbers(option: str, text: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise InputError(f"{option}: {text!r} is no list of numbers, such as 1,1,2") from None
