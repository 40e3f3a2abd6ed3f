"""SoSci Survey: MODE marks the researcher's own runs, FINISHED who came to the end."""

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule

FORM = Form(
    name="sosci",
    title="SoSci Survey",
    columns=("CASE", "QUESTNNR", "MODE", "FINISHED", "LASTPAGE"),
    defaults=ConversionMap(
        participant="CASE",
        rows=(
            RowRule(column="MODE", only=("interview",), reason="own test", optional=True),
            RowRule(column="FINISHED", without=("F", "FALSE", "0"), reason="unfinished", optional=True),
        ),
        words={"-9": "none: not answered"},
        empty="not asked",
    ),
    tell="the answer columns and what stood on each side (--pair), and what each code means",
)
