"""What the console says of the data: the ranking at a glance and the stuck rates, under the labels shown."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from analysis.claims import Claim, joint_sentence
from analysis.counts import count_responses
from analysis.figures.labels import LIKELY
from analysis.quick import quick_ranking
from analysis.stuck import share_of_comparisons
from data.errors import ElbowroomError
from data.responses import ResponseTable, StuckTable

ONLY_THESE = (
    "Comparisons count as independent, so it speaks of these people and comparisons. The report also has the "
    "rate in people in general."
)
"""Stands below stuck rates."""


@dataclass(frozen=True)
class Standing:
    """One mode on one question: worth with its 94 % interval, and the chance to rank first."""

    label: str
    worth: float
    low: float
    high: float
    p_best: float


@dataclass(frozen=True)
class QuestionAtAGlance:
    """The standings on one question; ``reason`` says why there are none."""

    name: str
    short: str
    wording: str
    responses: int
    standings: tuple[Standing, ...]
    reason: str


@dataclass(frozen=True)
class StuckAtAGlance:
    """In how many of its comparisons a mode had the robot stuck; rate with its 94 % interval.

    Comparisons count as independent, so the interval speaks of these people and comparisons.
    """

    label: str
    stuck: int
    comparisons: int
    rate: float
    low: float
    high: float


def ranking_at_a_glance(table: ResponseTable, labels: Mapping[str, str]) -> tuple[QuestionAtAGlance, ...]:
    """Each question's standings, in milliseconds and pooled; the report has the full model."""
    found = []
    for question in table.questions:
        counts = count_responses(table, question)
        standings: tuple[Standing, ...] = ()
        try:
            quick = quick_ranking(counts, tuple(labels))
            reason = _relabelled(quick.reason, labels)
            standings = tuple(
                Standing(labels[mode.mode], mode.worth, mode.worth_low, mode.worth_high, mode.p_best)
                for mode in quick.modes
            )
        except ElbowroomError:
            reason = "The answers don't allow an estimate yet."
        found.append(
            QuestionAtAGlance(question.name, question.short, question.wording, counts.n, standings, reason)
        )
    return tuple(found)


def firsts_at_a_glance(questions: Sequence[QuestionAtAGlance]) -> str:
    """What the first places that look likely are worth together, as a sentence; empty if there are none."""
    claims = [
        Claim("", first.label, first.p_best, question.name)
        for question in questions
        if question.standings
        if (first := max(question.standings, key=lambda s: s.p_best)).p_best >= LIKELY
    ]
    said = joint_sentence(claims, "likely first place", f"first places of {100 * LIKELY:.0f} % and more")
    return said and f"{said} That is too sure: this estimate leaves out that people differ."


def stuck_at_a_glance(table: StuckTable, labels: Mapping[str, str]) -> tuple[StuckAtAGlance, ...]:
    """Each mode's rate of comparisons in which it had the robot stuck, comparisons independent."""
    glances = []
    for mode, label in labels.items():
        is_stuck = table.rows.loc[table.rows["mode"] == mode, "stuck"]
        stuck, comparisons = int(is_stuck.sum()), len(is_stuck)
        share = share_of_comparisons(stuck, comparisons)
        glances.append(StuckAtAGlance(label, stuck, comparisons, share.mean, share.hdi_low, share.hdi_high))
    return tuple(glances)


def _relabelled(reason: str, labels: Mapping[str, str]) -> str:
    """A reason may name modes; while the study is blinded it only says that there is one."""
    if not reason or all(name == label for name, label in labels.items()):
        return reason
    return "The answers don't allow a ranking yet: not all modes are connected by comparisons."
