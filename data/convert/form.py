"""What Elbowroom knows about a form in which answers are exported."""

from collections.abc import Callable
from dataclasses import dataclass, field

from data.convert.map import ConversionMap
from data.convert.reading import Layout
from data.convert.table import Table

Preparation = Callable[[Table, ConversionMap], Table]


def unchanged(table: Table, mapping: ConversionMap) -> Table:
    """The table as it was read."""
    return table


@dataclass(frozen=True)
class Form:
    """A form, declared as data where that is possible.

    Attributes
    ----------
    name, title : str
        On the command line, and in words.
    columns : tuple of str
        Columns that a file of this form has; the more, the surer ``look`` is. ``*`` is a whole number.
    defaults : ConversionMap
        What this form always means; the rest has to be told.
    ranking_cells : str
        What the cells of a ranking are, where the form says it: "modes" or "ranks".
    choose_rows : tuple of str
        Columns that mark practice and other tasks: where the first of them that is there has several values,
        the user has to say which rows count.
    layout : Layout
    prepare : callable
        Changes the table before anything else, where a preset cannot say it.
    tell : str
        What the user has to say, in words.
    recognise : callable, optional
        Tells a file without typical column names.
    refusal : str
        Why a file of this form is not converted.
    """

    name: str
    title: str
    columns: tuple[str, ...] = ()
    defaults: ConversionMap = field(default_factory=ConversionMap)
    ranking_cells: str = ""
    choose_rows: tuple[str, ...] = ()
    layout: Layout = field(default_factory=Layout)
    prepare: Preparation = unchanged
    tell: str = ""
    recognise: Callable[[Table], bool] | None = None
    refusal: str = ""
