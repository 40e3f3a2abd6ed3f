"""webMUSHRA, paired comparison: the order of A and B is not kept, and nobody is named.

``correct`` means that the reference was preferred. The file calls it "reference" whatever it was, so which
mode it was in a trial has to be told.
"""

from data.convert.form import Form
from data.convert.map import AnswerColumn, ConversionMap

FORM = Form(
    name="webmushra",
    title="webMUSHRA, paired comparison",
    columns=("session_test_id", "trial_id", "choice_reference", "choice_non_reference", "choice_answer"),
    defaults=ConversionMap(
        participant="",
        answers=(
            AnswerColumn(
                column="choice_answer",
                left="trial_id",
                right="choice_non_reference",
                renamed=("left",),
                sides="unknown",
            ),
        ),
        words={"correct": "A", "incorrect": "B", "undecided": "equal", "unknown": "none: not answered"},
    ),
    tell="which mode the reference of each trial was: --mode TRIAL=MODE",
)
