"""Any other table: a row an answer, or a row a person; everything has to be told."""

from data.convert.form import Form

FORM = Form(
    name="table",
    title="any other table",
    tell="participant, answer columns, sides, words or levels",
)
