"""What the checks of the model mean for who quotes the report, a sentence for each kind of fault."""

from collections.abc import Sequence

from analysis.figures.labels import isolated, one_line
from analysis.predictive import Kind, PredictiveCheck, PredictiveChecks
from analysis.report.findings import listed

_MOST_NAMED = 6
GRAVEST_FIRST: tuple[Kind, ...] = (
    "repeats",
    "spread",
    "lapse",
    "camps",
    "one_line",
    "width_by_person",
    "side_by_person",
    "side",
    "side_drift",
    "width_drift",
    "wins",
    "level",
    "ties",
)
_HIGH: dict[Kind, str] = {
    "repeats": (
        "asked about a pair again, people gave the same answer more often than the model expects, as "
        "remembered answers do, or tastes for single pairs. Either way the repeats tell less than new "
        "answers, and the intervals are too narrow"
    ),
    "spread": (
        "people lie farther apart than the model expects, which takes their answers together. The intervals "
        "are too narrow"
    ),
    "lapse": (
        "more answers go against what the model expects of the people who gave them than it allows for, as "
        "careless answers do. They draw the worths together. “elbowroom report --lapse” allows for them"
    ),
    "camps": (
        "people's preferences fall into two groups more clearly than the model allows for. A worth then "
        "describes somebody between the groups: see “Is it one order for all?”"
    ),
    "one_line": (
        "people differ about some modes much more than about others, or in opposite directions as camps do; "
        "the model expects them to differ about all modes alike. See “Is it one order for all?”"
    ),
    "width_by_person": (
        "people use the scale more differently than the model allows for: some choose answers near the "
        "middle of the scale more often than others do. “elbowroom report --person-scale” gives each person "
        "an own width of the scale"
    ),
    "side_by_person": (
        "some people favour what is shown as A, others what is shown as B, more than the model allows for. "
        "“elbowroom report --person-side” gives each person an own side effect"
    ),
    "side": "what was shown as A was favoured, and this report's model has no side effect",
    "side_drift": (
        "what was shown as A was favoured more and more in the course of the comparisons. “elbowroom report "
        "--position” allows for that"
    ),
    "width_drift": (
        "differences were called smaller in the course of the comparisons; the model takes the scale to be "
        "used alike throughout"
    ),
}
_LOW: dict[Kind, str] = {
    "spread": "people lie closer together than the model expects",
    "side": "what was shown as B was favoured, and this report's model has no side effect",
    "side_drift": (
        "what was shown as B was favoured more and more in the course of the comparisons. “elbowroom report "
        "--position” allows for that"
    ),
    "width_drift": (
        "differences were called larger in the course of the comparisons; the model takes the scale to be "
        "used alike throughout"
    ),
}


def model_cautions(found: PredictiveChecks) -> list[str]:
    """A sentence for each kind of check that the model does not pass, the gravest first."""
    sentences: list[str] = []
    sure = [check for check in found.checks if check.is_surely_unlikely]
    for kind in GRAVEST_FIRST:
        for is_high in (True, False):
            own = [c for c in sure if c.kind == kind and c.is_high == is_high]
            if own:
                sentences.append(_sentence(own))
    far = sum(check.is_unlikely for check in found.checks)
    if not sentences and far > found.at_most:
        sentences.append(
            f"The model predicts {far:,} of {len(found.checks):,} checked quantities badly; if it were "
            f"right, {found.expected:.1f} would be expected. See “Does the model fit?”."
        )
    return sentences


def _sentence(own: Sequence[PredictiveCheck]) -> str:
    kind, is_high = own[0].kind, own[0].is_high
    questions = list(dict.fromkeys(isolated(c.question) for c in own))
    more = f" and {len(questions) - _MOST_NAMED} more" if len(questions) > _MOST_NAMED else ""
    named = ", ".join(questions[:_MOST_NAMED]) + more if more else listed(questions)
    text = (_HIGH if is_high else _LOW).get(kind)
    if text is None:
        parts = [
            f"{_SHARE[kind]}{one_line(c.what)} {c.observed:.2f} where {c.predicted_low:.2f} to "
            f"{c.predicted_high:.2f} is expected"
            for c in own[:_MOST_NAMED]
        ]
        rest = f", and {len(own) - _MOST_NAMED} more" if len(own) > _MOST_NAMED else ""
        text = f"shares of answers that the model does not describe: {'; '.join(parts)}{rest}"
    return f"The model does not fit in {named}: {text}."


_SHARE: dict[Kind, str] = {"wins": "", "level": "the answer ", "ties": "about the same"}
