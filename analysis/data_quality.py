"""What is known of the data's quality besides the answers: input delay, and attention checks."""

from collections.abc import Sequence
from dataclasses import dataclass

from analysis.checks import CheckShare, check_shares
from analysis.lag import LagExclusion, ModeDelay, mode_delays
from data.responses import LagTable, ResponseTable


@dataclass(frozen=True)
class DataQuality:
    """Whatever is known; empty where nothing is.

    Attributes
    ----------
    delays : tuple of ModeDelay
        Input delay of every mode that people guided.
    excluded : LagExclusion or None
        What is left out because of lag, if limits were set.
    checks : tuple of CheckShare
        Answers to comparisons of a mode with itself.
    """

    delays: tuple[ModeDelay, ...] = ()
    excluded: LagExclusion | None = None
    checks: tuple[CheckShare, ...] = ()


def data_quality(
    table: ResponseTable, modes: Sequence[str], lag: LagTable | None, excluded: LagExclusion | None
) -> DataQuality:
    """Sum up the quality of the data behind a report."""
    delays = mode_delays(lag, modes) if lag is not None else ()
    return DataQuality(delays, excluded, check_shares(table))
