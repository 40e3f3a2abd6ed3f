"""`elbowroom power`: how many participants and repetitions a study needs."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.options import CORES, JobsOption, SeedOption, StudyOption

if TYPE_CHECKING:
    from analysis.power import Power


def power(
    study: StudyOption = "carmichael2017",
    participants: Annotated[
        str,
        typer.Option(
            "--participants",
            metavar="N,N,...",
            help="Numbers to try. Default: 1 to 6 times the planned one; for equality about what it takes.",
        ),
    ] = "",
    repetitions: Annotated[
        str,
        typer.Option(
            "--repetitions",
            metavar="N,N,...",
            help="How often a person sees each pair. Default: the study's.",
        ),
    ] = "",
    worth: Annotated[
        str,
        typer.Option(
            "--worth",
            metavar="X,X,...",
            help="Planted worth of each mode, in the study's order. Default: the last is twice as good; for "
            "equality all alike.",
        ),
    ] = "",
    levels: Annotated[
        int | None,
        typer.Option("--levels", metavar="2..9", help="Levels of the scale. Default: the study's fewest."),
    ] = None,
    ties: Annotated[
        float | None,
        typer.Option("--ties", metavar="SHARE", help="Share of answers “about the same”, such as 0.2."),
    ] = None,
    cuts: Annotated[
        str,
        typer.Option(
            "--cuts", metavar="X,X", help="Cut-points [logit] instead of ties. Default: 0.5, or 0.5,1.5."
        ),
    ] = "",
    subject_sd: Annotated[
        float, typer.Option("--subject-sd", help="Differences between people [logit].")
    ] = 0.7,
    side_effect: Annotated[float, typer.Option("--side-effect", help="Preference for side A [logit].")] = 0.1,
    conclusion: Annotated[
        str,
        typer.Option(
            "--conclusion",
            metavar="best|order|M1:M3|equal|M1=M3",
            help="What is to be found: the best mode, the whole order, the better of two; that all modes, or "
            "two, are equal in practice.",
        ),
    ] = "best",
    confidence: Annotated[
        float | None,
        typer.Option(
            "--confidence", help="Probability above which it counts as found. Default: 0.95; equality 0.8."
        ),
    ] = None,
    wanted: Annotated[float, typer.Option("--wanted", help="Share of right conclusions wanted.")] = 0.8,
    replicates: Annotated[int, typer.Option("--replicates", help="Simulated studies of each size.")] = 100,
    seed: SeedOption = 2017,
    jobs: JobsOption = CORES,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for the table and the figure.")
    ] = None,
) -> None:
    """How often studies of different sizes would find what is planted, if people were as assumed.

    Every simulated study follows the study's schedule and is fitted as a report would fit it.

    Examples:

    elbowroom power --study carmichael2017 --worth 1,1,2 --participants 7,20,45 --out power

    elbowroom power --study carmichael2017 --conclusion equal --replicates 20
    """
    from analysis.power import POWER_TABLE, write_power
    from analysis.power import power as run_power
    from app.cli.progress import progress
    from app.planning import Wish, plan_of
    from app.studies import open_study
    from data.locations import check_folder

    wish = Wish(
        worth=worth,
        participants=participants,
        repetitions=repetitions,
        levels=levels,
        cuts=cuts,
        ties=ties,
        subject_sd=subject_sd,
        side_effect=side_effect,
        conclusion=conclusion,
        confidence=confidence,
        wanted=wanted,
        replicates=replicates,
        seed=seed,
    )
    plan = plan_of(open_study(study).study, wish)
    if out is not None:
        check_folder(out, POWER_TABLE)
    with progress("Simulated studies") as report:
        result = run_power(plan, n_jobs=jobs, progress=report)
    paths = write_power(result, out) if out is not None else ()
    _print(result)
    print("\n".join(str(path) for path in paths), end="\n" if paths else "")


def _print(result: "Power") -> None:
    """The curve in bars, the answer, and what was assumed."""
    from analysis.power import sentences, showings, tie_share
    from analysis.power.plan import mode_pairs

    plan = result.plan
    for repetitions in result.repetitions:
        if len(result.repetitions) > 1:
            print(showings(repetitions))
        for p in result.of(repetitions):
            bar = "█" * round(30 * p.right_share)
            right = f"{100 * p.right_share:3.0f} % right [{100 * p.right_low:.0f}, {100 * p.right_high:.0f}]"
            wrong = f"{100 * p.wrong_share:.0f} % wrong [{100 * p.wrong_low:.0f}, {100 * p.wrong_high:.0f}]"
            lost = f", {p.unranked} not converged" if p.unranked else ""
            print(
                f"{p.participants:>6} participants {p.answers:>6} answers  {bar:<30} {right}, {wrong}{lost}"
            )
    print("\n".join(sentences(result)))
    print(f"Right is: {plan.conclusion.sentence(plan.study.mode_names)}.")
    ties = tie_share(mode_pairs(plan.study), plan.scenario)
    same = f", {100 * ties:.0f} % of answers “about the same”" if plan.scenario.cuts else ""
    print(f"Simulated for planning, if people are so: {plan.scenario.sentence}{same}.")
    print(f"In brackets: 94 % intervals, from {plan.replicates} simulated studies of each size.")
