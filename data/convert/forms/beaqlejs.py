"""BeaqleJS, preference test: a JSON file a listener, whose name comes last."""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap, Order
from data.convert.reading import FILE
from data.convert.table import Row, Table
from data.errors import InputError

LISTENER, PREFERENCE = "@listener", "@preference"
"""Columns: the file's UserName, and its Preference or why there is none."""


def _with_listeners(table: Table, mapping: ConversionMap) -> Table:
    """The tests with their listener; the records of the listener themselves left out."""
    test, name = table.column("TestID"), table.column("UserName")
    preference, order, file = (
        table.column("Preference"),
        table.column("PresentationOrder"),
        table.column(FILE),
    )
    listeners: dict[str | None, str] = {}
    for row in table.rows:
        if (listener := name.text(row)) is None:
            continue
        if listeners.setdefault(file.text(row), listener) != listener:
            raise InputError(
                f"{row.where}: two listeners in one file: {listeners[file.text(row)]}, {listener}"
            )

    def cells(row: Row) -> tuple[str | None, str]:
        answer = preference.text(row) or ("(skipped)" if order.text(row) else "(not shown)")
        return listeners.get(file.text(row)), answer

    tests = tuple(row for row in table.rows if test.text(row))
    return Table(table.path, table.names, tests, table.notes).with_columns((LISTENER, PREFERENCE), cells)


FORM = Form(
    name="beaqlejs",
    title="BeaqleJS, preference test",
    columns=("TestID", "PresentationOrder", "Preference", "UserName"),
    defaults=ConversionMap(
        participant=LISTENER,
        comparison="TestID",
        answers=(
            AnswerColumn(
                column=PREFERENCE,
                pair="TestID",
                order=Order(column="PresentationOrder", as_named=("A=A, B=B",), exchanged=("A=B, B=A",)),
            ),
        ),
        words={"A": "A", "B": "B", "(skipped)": "none: skipped", "(not shown)": "none: not shown"},
    ),
    prepare=_with_listeners,
    tell="files A and B of each test (--pair TEST=A,B), and whether Preference is the button or the file "
    "(--answer-is button or item); BeaqleJS itself writes the button; "
    "of listeners without a name: --participant @file",
)
