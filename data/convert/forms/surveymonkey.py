"""SurveyMonkey: two header rows, the question once above its options."""

from collections.abc import Sequence

from data.convert.delimited import Record
from data.convert.form import Form
from data.convert.map import ConversionMap
from data.convert.reading import Header, Layout
from data.convert.table import Row, Table, plain

_RESPONSE, _OTHER = " | Response", " | Other (please specify)"
OTHER = "(other)"


def _header(first: Sequence[Record]) -> Header:
    """Names such as ``Rank these | M1``; a question stands once, and then empty, above its options."""
    names: list[str] = []
    question = ""
    options = first[1].cells if len(first) > 1 else (None,) * len(first[0].cells)
    for above, option in zip(first[0].cells, options, strict=False):
        question = plain(above or "") or question
        names.append(f"{question} | {plain(option)}" if option else question)
    return Header(tuple(names), records=2)


def _with_other(table: Table, mapping: ConversionMap) -> Table:
    """The table with ``(other)`` as the response where only a text was written."""
    others = {
        table.names.index(name.removesuffix(_OTHER) + _RESPONSE): place
        for place, name in enumerate(table.names)
        if name.endswith(_OTHER) and name.removesuffix(_OTHER) + _RESPONSE in table.names
    }

    def marked(row: Row) -> tuple[str | None, ...]:
        return tuple(
            OTHER if place in others and not cell and row.cells[others[place]] else cell
            for place, cell in enumerate(row.cells)
        )

    rows = tuple(Row(row.path, row.line, marked(row)) for row in table.rows)
    return Table(table.path, table.names, rows, table.notes)


FORM = Form(
    name="surveymonkey",
    title="SurveyMonkey",
    columns=("Respondent ID", "Collector ID", "Start Date", "End Date"),
    defaults=ConversionMap(participant="Respondent ID", words={OTHER: 'none: "other"'}),
    ranking_cells="ranks",
    layout=Layout(header=_header),
    prepare=_with_other,
    tell="a ranking, by the beginning of its question and ...; or answer columns, what stood on each side "
    "(--pair) and what each word means; #13 is the 13th column",
)
