"""LimeSurvey, CSV with answer codes: nothing where a question was not asked, "" where it was left empty."""

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule

FORM = Form(
    name="limesurvey",
    title="LimeSurvey",
    columns=("id", "submitdate", "lastpage", "startlanguage"),
    defaults=ConversionMap(
        participant="id",
        rows=(RowRule(column="submitdate", without=("",), reason="unfinished", optional=True),),
        words={"-oth-": 'none: "other"'},
        unquoted_is_not_asked=True,
    ),
    ranking_cells="modes",
    tell="the answer columns and what stood on each side (--pair), what each code means; a ranking's columns",
)
