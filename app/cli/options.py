"""Options that several commands share, each said once."""

import os
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from data.errors import InputError

CORES = os.cpu_count() or 1
MOST_VALUES = 1000
"""The most values a range on the command line may have."""

StudyOption = Annotated[
    str, typer.Option("--study", metavar="FILE|NAME", help="A study file, or the name of a built-in study.")
]
StoredStudyOption = Annotated[
    str | None,
    typer.Option("--study", metavar="FILE|NAME", help="Which study, where a store holds several."),
]
StoreOption = Annotated[
    str | None,
    typer.Option(
        "--store",
        metavar="URL",
        help="A SQLAlchemy URL or a path. Default: data/local/elbowroom.sqlite in a checkout, "
        "else in the user data folder.",
    ),
]
OutOption = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder to write.")]
JobsOption = Annotated[
    int, typer.Option("--jobs", min=1, metavar="J", help="Processes to use. Default: one a core.")
]
SimulatedOption = Annotated[
    bool, typer.Option("--include-simulated", help="Use answers of simulated participants too.")
]
LapseOption = Annotated[
    bool, typer.Option("--lapse", help="Some answers are careless: every level is then as likely.")
]
PersonSideOption = Annotated[
    bool, typer.Option("--person-side", help="Each participant has a side effect of their own.")
]
PersonScaleOption = Annotated[
    bool, typer.Option("--person-scale", help="Each participant uses the scale in a width of their own.")
]
PositionOption = Annotated[
    bool,
    typer.Option(
        "--position", help="The side effect may drift with the comparisons, and modes may be learnt."
    ),
]
SeedOption = Annotated[int, typer.Option("--seed", min=0, max=2**31 - 1, help="Seed of all that is random.")]


def parse_grid(option: str, text: str) -> list[float]:
    """The values of a range given as ``first:last:number``.

    Raises
    ------
    InputError
        If it is not two numbers and a whole number from 1 to `MOST_VALUES`.
    """
    parts = text.split(":")
    try:
        first, last, number = float(parts[0]), float(parts[1]), int(parts[2])
        if len(parts) != 3 or not 1 <= number <= MOST_VALUES or not np.isfinite([first, last]).all():
            raise ValueError
    except (ValueError, IndexError):
        raise InputError(
            f"{option}: {text!r} is no range; write first:last:number, such as -1.03:-1.06:4 "
            f"(at most {MOST_VALUES} values)"
        ) from None
    return [float(value) for value in np.linspace(first, last, number)]
