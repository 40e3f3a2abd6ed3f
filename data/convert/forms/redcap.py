"""REDCap, raw CSV with a repeated instrument: a row a comparison; a person's first row is another form."""

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule
from data.convert.table import Row, Table

INSTRUMENT = "redcap_repeat_instrument"
COMPLETE = "@complete"
"""Column with the row's own ``INSTRUMENT_complete``: 0 incomplete, 1 unverified, 2 complete."""


def _with_status(table: Table, mapping: ConversionMap) -> Table:
    if INSTRUMENT not in table.names:
        return table
    instrument = table.column(INSTRUMENT)

    def status(row: Row) -> tuple[str | None]:
        column = table.find(f"{instrument.text(row)}_complete")
        return (column.text(row) if column else None,)

    return table.with_columns((COMPLETE,), status)


FORM = Form(
    name="redcap",
    title="REDCap with a repeated instrument",
    columns=(INSTRUMENT, "redcap_repeat_instance"),
    defaults=ConversionMap(
        participant="record_id",
        comparison="redcap_repeat_instance",
        rows=(
            RowRule(
                column=COMPLETE,
                without=("0",),
                reason="on a form marked incomplete",
                optional=True,
                taken=True,
            ),
        ),
    ),
    choose_rows=(INSTRUMENT,),
    prepare=_with_status,
    tell="the instrument, the fields of answer, left and right, what each code means; "
    "the participant's column unless it is record_id",
)
