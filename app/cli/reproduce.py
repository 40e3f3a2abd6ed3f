"""`elbowroom reproduce`: a source document's experiment again, with a verdict per published claim."""

from enum import StrEnum
from typing import Annotated

import typer

from app.cli.options import OutOption


class Document(StrEnum):
    """The source documents whose experiments can be run again."""

    MULUMBWA = "mulumbwa"
    BEAUDOIN2022 = "beaudoin2022"


def reproduce(
    document: Annotated[Document, typer.Argument(help="Whose experiment.")],
    out: OutOption,
) -> None:
    """A source document's experiment: tables, figures, and a verdict per published claim.

    Example: elbowroom reproduce beaudoin2022 --out beaudoin2022
    """
    from app.reproducing import reproduce as run

    written = run(document.value, out)
    print(written.summary)
    print("\n".join(str(path) for path in written.paths))
