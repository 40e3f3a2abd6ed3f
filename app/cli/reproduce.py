"""`elbowroom reproduce`: a source document's experiment again, with a verdict per published claim."""

from enum import StrEnum
from typing import Annotated

import typer

from app.cli.options import CORES, JobsOption, OutOption


class Document(StrEnum):
    """The source documents whose experiments can be run again."""

    CARMICHAEL2017 = "carmichael2017"
    MULUMBWA = "mulumbwa"
    BEAUDOIN2022 = "beaudoin2022"


def reproduce(
    document: Annotated[Document, typer.Argument(help="Whose experiment.")],
    out: OutOption,
    jobs: JobsOption = CORES,
) -> None:
    """A source document's experiment: tables, figures, and a verdict per published claim.

    carmichael2017 is the study of damping methods, with simulated people: about a minute on two cores.
    mulumbwa (a thesis on inverse kinematics) and beaudoin2022 (link shells) take seconds.

    Example: elbowroom reproduce carmichael2017 --out carmichael2017
    """
    from app.cli.progress import progress
    from app.reproducing import reproduce as run

    with progress("Reproduction") as report:
        written = run(document.value, out, jobs, report)
    print(written.summary)
    print("\n".join(str(path) for path in written.paths))
