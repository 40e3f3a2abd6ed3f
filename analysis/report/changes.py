"""What leaving out some answers changes, as a table."""

from collections.abc import Sequence
from math import isnan

from analysis.figures.labels import one_line, percent
from analysis.lag import LagChange
from analysis.report.page import Table


def changes_table(changes: Sequence[LagChange], source: str) -> Table:
    """Worth and chance to rank first, with some answers and without."""
    rows = tuple(
        (
            one_line(c.question),
            one_line(c.mode),
            _worth(c.worth_with),
            _worth(c.worth_without),
            _chance(c.p_best_with),
            _chance(c.p_best_without),
        )
        for c in changes
    )
    columns = ("Question", "Mode", "Worth with", "Worth without", "First with", "First without")
    return Table(columns, (False, False, *([True] * 4)), rows, source)


def _worth(value: float) -> str:
    return "" if isnan(value) else f"{value:.3f}"


def _chance(p: float) -> str:
    return "" if isnan(p) else f"{percent(p)} %"
