"""Prolific, demographic export: about people, without answers."""

from data.convert.form import Form

FORM = Form(
    name="prolific",
    title="Prolific, demographic export",
    columns=("Submission id", "Participant id", "Status", "Completion code"),
    refusal="a demographic export of Prolific: it holds no pair and no answer; it is for joining what is "
    "known about people to the answers of a survey, by Participant id",
)
