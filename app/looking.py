"""Who saw results of people, and when: kept in the audit log wherever a ranking is shown."""

from datetime import datetime

from analysis.looks import earlier, looks_sentence
from analysis.observed_design import MOST_PAIRS, ObservedDesign
from app.planning import Wish, plan_of
from data.records import Look
from data.store import Store
from data.store.studies import StoredStudy
from data.study import Study


def console_sentence(store: Store, stored: StoredStudy, shown: Look, at: datetime) -> str:
    """What the console says of the looks so far, this one kept; empty without answers of people.

    The console's estimate leaves out that people differ, which makes early looks worse; that is counted in,
    for people as a plan assumes them.
    """
    if not shown.answers:
        return ""
    before = earlier(store.looks(stored), shown)
    store.log_look(stored, shown, "researcher", at)
    if not before:
        return (
            "This is the first look at results of people. The audit log keeps each look at further answers: "
            "a study that stops when it looks good errs the more often, the more often it is looked at."
        )
    return looks_sentence(before, shown, _planned_design(stored.study, shown), "before")


def _planned_design(study: Study, shown: Look) -> ObservedDesign | None:
    """People as a plan assumes them, on the study's schedule, with as many answers as are shown."""
    if len(study.pairs) > MOST_PAIRS:
        return None
    plan = plan_of(study, Wish(worth=",".join("1" for _ in study.modes), participants="1"))
    repetitions = study.protocol.repetitions
    each = plan.answers_each(repetitions) * len(study.questions)
    place = {name: k for k, name in enumerate(study.mode_names)}
    pairs = tuple((place[a], place[b]) for a, b in study.pairs)
    return ObservedDesign(pairs, repetitions, plan.scenario, shown.answers / each, is_pooled=True)
