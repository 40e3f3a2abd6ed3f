"""What the analysis reads of a store: responses, stuck comparisons, lag, and how far a study has come."""

import math
from dataclasses import dataclass

import pandas as pd
from sqlalchemy import Select, func, join, or_, select

from data.errors import InputError
from data.records import Source
from data.responses import (
    BackgroundTable,
    LagTable,
    MetricTable,
    PaceTable,
    QuestionScale,
    ResponseTable,
    StuckTable,
    rows_sha256,
)
from data.store.links import StoredLinks
from data.store.rows import every
from data.store.studies import StoredStudy
from data.store.tables import comparisons, participants, responses, stuck_events, trials
from data.study import Question

RESPONSE_TYPES = {
    "participant": "str",
    "question": "str",
    "mode_a": "str",
    "mode_b": "str",
    "response": "str",
    "count": "int64",
    "comparison": "str",
    "repetition": "int64",
    "source": "str",
    "check": "bool",
}
"""Columns of a response table, in order, with their types."""

STUCK_TYPES = {
    "participant": "str",
    "comparison": "str",
    "mode": "str",
    "stuck": "bool",
    "exposure_s": "float64",
}
"""Columns of a stuck table, in order, with their types."""


PACE_TYPES = {"participant": "str", "comparison": "str", "seconds": "float64", "questions": "int64"}
"""Columns of a pace table, in order, with their types."""

LAG_METRICS = ("latency_median_ms", "latency_p95_ms", "frame_rate_hz", "ticks", "skipped_ticks")
"""What a lag table takes of a guided trial's metrics."""
LAP_TIME = "duration_s"
"""The metric that a lap which was cut short does not have."""


@dataclass(frozen=True)
class Counts:
    """How far a study has come.

    Attributes
    ----------
    joined, consented, finished : int
        Participants.
    planned, answered : int
        Comparisons.
    trials, stuck : int
        Trials, and those that ended stuck.
    """

    joined: int
    consented: int
    finished: int
    planned: int
    answered: int
    responses: int
    trials: int
    stuck: int


class StoredEvidence(StoredLinks):
    """A study's data as tables. People's and simulated participants' mix only when asked for."""

    def responses_table(self, study: StoredStudy, include_simulated: bool = False) -> ResponseTable:
        """All responses of a study.

        Raises
        ------
        InputError
            If there are none, or only simulated ones that were not asked for.
        """
        sources = self.sources(study, include_simulated)
        query = (
            select(
                comparisons.c.participant,
                responses.c.question,
                comparisons.c.mode_a,
                comparisons.c.mode_b,
                responses.c.answer.label("response"),
                responses.c.comparison,
                comparisons.c.repetition,
                participants.c.source,
                comparisons.c.check,
                participants.c.pooled,
            )
            .join_from(responses, comparisons)
            .join(participants)
            .where(participants.c.study == study.id, participants.c.source.in_(sources))
            .order_by(participants.c.source, participants.c.number, participants.c.id, comparisons.c.position)
        )
        with self.reading() as connection:
            rows = pd.DataFrame(every(connection, query))
        if rows.empty:
            raise InputError(f"{self.address.shown}: {study.label} has no responses yet")
        order = {question.name: place for place, question in enumerate(study.study.questions)}
        rows["count"] = 1
        rows["asked"] = rows["question"].map(order)
        places = rows.groupby("comparison", sort=False).ngroup()
        rows = rows.assign(place=places).sort_values(["place", "asked"], kind="stable", ignore_index=True)
        pooled = bool(rows["pooled"].any())
        rows = rows[list(RESPONSE_TYPES)].astype(RESPONSE_TYPES)
        asked = set(rows.loc[~rows["check"], "question"])
        return ResponseTable(
            rows=rows,
            modes=study.study.mode_names,
            questions=tuple(scale_of(q) for q in study.study.questions if q.name in asked),
            has_participants=not pooled,
            is_simulated=bool((rows["source"] == "simulated").any()),
            sha256=rows_sha256(rows),
            title=study.study.title,
        )

    def stuck_table(self, study: StoredStudy, include_simulated: bool = False) -> StuckTable | None:
        """Which comparisons had the robot stuck under which mode; None if no trials are known.

        A comparison counts once any trial of it is known, under both its modes; attention checks
        are left out. The exposure is NaN where a trial of unknown duration was imported. The participant
        is "" where answers were imported without one.
        """
        sources = self.sources(study, include_simulated)
        query = (
            select(
                comparisons.c.participant,
                trials.c.comparison,
                comparisons.c.mode_a,
                comparisons.c.mode_b,
                trials.c.mode,
                (trials.c.outcome == "stuck").label("stuck"),
                select(stuck_events.c.trial)
                .where(stuck_events.c.trial == trials.c.id, stuck_events.c.kind == "stuck")
                .exists()
                .label("event"),
                trials.c.duration_s,
                participants.c.pooled,
            )
            .join_from(trials, comparisons)
            .join(participants)
            .where(
                participants.c.study == study.id,
                participants.c.source.in_(sources),
                comparisons.c.check.is_(False),
            )
            .order_by(participants.c.source, participants.c.number, participants.c.id, comparisons.c.position)
        )
        with self.reading() as connection:
            known = every(connection, query)
        if not known:
            return None
        rows: dict[tuple[str, str], dict[str, object]] = {}
        exposure: dict[tuple[str, str], float] = {}
        for trial in known:
            for mode in (trial["mode_a"], trial["mode_b"]):
                key = (trial["comparison"], mode)
                row = {
                    "participant": "" if trial["pooled"] else trial["participant"],
                    "comparison": key[0],
                    "mode": mode,
                    "stuck": False,
                }
                rows.setdefault(key, row)
                exposure.setdefault(key, 0.0)
            key = (trial["comparison"], trial["mode"])
            rows[key]["stuck"] = rows[key]["stuck"] or bool(trial["stuck"] or trial["event"])
            exposure[key] += trial["duration_s"]
        table = pd.DataFrame([row | {"exposure_s": exposure[key]} for key, row in rows.items()])
        return StuckTable(table.astype(STUCK_TYPES))

    def lag_table(self, study: StoredStudy, include_simulated: bool = False) -> LagTable | None:
        """How promptly the robot followed the hand, trial by trial; None if people guided none.

        Attention checks are left out, and trials from before a comparison was begun anew: its answers are
        about those after.
        """
        sources = self.sources(study, include_simulated)
        query = (
            select(comparisons.c.participant, trials.c.comparison, trials.c.mode, trials.c.metrics)
            .join_from(trials, comparisons)
            .join(participants)
            .where(
                participants.c.study == study.id,
                participants.c.source.in_(sources),
                trials.c.source == "guided",
                comparisons.c.check.is_(False),
                or_(comparisons.c.restarted_at.is_(None), trials.c.started_at >= comparisons.c.restarted_at),
            )
            .order_by(
                participants.c.source,
                participants.c.number,
                participants.c.id,
                comparisons.c.position,
                trials.c.slot,
                trials.c.number,
            )
        )
        with self.reading() as connection:
            known = every(connection, query)
        if not known:
            return None
        rows = [
            {"participant": trial["participant"], "comparison": trial["comparison"], "mode": trial["mode"]}
            | {name: _measured(trial["metrics"].get(name)) for name in LAG_METRICS}
            for trial in known
        ]
        return LagTable(pd.DataFrame(rows))

    def pace_table(self, study: StoredStudy, include_simulated: bool = False) -> PaceTable | None:
        """How long the answers took, comparison by comparison; None if it is known of none.

        Attention checks are left out, and comparisons with a trial that began or ended at an unknown time.
        """
        sources = self.sources(study, include_simulated)
        number = (
            select(responses.c.comparison, func.count().label("questions"))
            .group_by(responses.c.comparison)
            .subquery()
        )
        query = (
            select(
                comparisons.c.participant,
                trials.c.comparison,
                trials.c.started_at,
                trials.c.duration_s,
                comparisons.c.answered_at,
                number.c.questions,
            )
            .join_from(trials, comparisons)
            .join(participants)
            .join(number, number.c.comparison == comparisons.c.id)
            .where(
                participants.c.study == study.id,
                participants.c.source.in_(sources),
                trials.c.source.in_(["observed", "guided"]),
                comparisons.c.answered_at.is_not(None),
                comparisons.c.check.is_(False),
            )
            .order_by(participants.c.source, participants.c.number, participants.c.id, comparisons.c.position)
        )
        with self.reading() as connection:
            known = every(connection, query)
        if not known:
            return None
        table = pd.DataFrame(known)
        since = (table["answered_at"] - table["started_at"]).dt.total_seconds() - table["duration_s"]
        table["seconds"] = since.groupby(table["comparison"]).transform("min")
        is_known = since.notna().groupby(table["comparison"]).transform("all") & (table["seconds"] >= 0.0)
        table = table[is_known].drop_duplicates("comparison", ignore_index=True)
        return PaceTable(table[list(PACE_TYPES)].astype(PACE_TYPES)) if len(table) else None

    def metric_table(self, study: StoredStudy, include_simulated: bool = False) -> MetricTable | None:
        """Objective metrics of the laps behind the answers; None if none has any.

        Attention checks are left out, and trials from before a comparison was begun anew. A lap that ended
        stuck has no ``duration_s``: it was cut short, and how long it would have taken is unknown.
        """
        sources = self.sources(study, include_simulated)
        query = (
            select(
                comparisons.c.participant,
                trials.c.comparison,
                trials.c.mode,
                trials.c.outcome,
                trials.c.metrics,
            )
            .join_from(trials, comparisons)
            .join(participants)
            .where(
                participants.c.study == study.id,
                participants.c.source.in_(sources),
                trials.c.outcome.in_(["completed", "stuck"]),
                comparisons.c.answered_at.is_not(None),
                comparisons.c.check.is_(False),
                or_(comparisons.c.restarted_at.is_(None), trials.c.started_at >= comparisons.c.restarted_at),
            )
            .order_by(
                participants.c.source,
                participants.c.number,
                participants.c.id,
                comparisons.c.position,
                trials.c.slot,
                trials.c.number,
            )
        )
        with self.reading() as connection:
            known = [trial for trial in every(connection, query) if trial["metrics"]]
        if not known:
            return None
        keys = ["participant", "comparison", "mode"]
        measured = pd.DataFrame([dict(trial["metrics"]) for trial in known]).astype("float64")
        if LAP_TIME in measured:
            measured.loc[[trial["outcome"] == "stuck" for trial in known], LAP_TIME] = math.nan
        named = pd.DataFrame([{key: trial[key] for key in keys} for trial in known])
        rows = pd.concat([named, measured], axis=1).groupby(keys, sort=False, as_index=False).mean()
        return MetricTable(rows)

    def background_table(self, study: StoredStudy, include_simulated: bool = False) -> BackgroundTable:
        """What participants said about themselves, in answer to the study's own questions."""
        sources = self.sources(study, include_simulated)
        query = (
            select(participants.c.id, participants.c.background)
            .where(participants.c.study == study.id, participants.c.source.in_(sources))
            .order_by(participants.c.source, participants.c.number, participants.c.id)
        )
        asked = study.study.background
        with self.reading() as connection:
            said = {who["id"]: dict(who["background"] or {}) for who in every(connection, query)}
        return BackgroundTable(
            asked,
            {
                who: {q.name: answers[q.name] for q in asked if answers.get(q.name)}
                for who, answers in said.items()
                if any(answers.get(q.name) for q in asked)
            },
        )

    def counts(self, study: StoredStudy, include_simulated: bool = False) -> Counts:
        """How far a study has come, among people or with simulated participants as well."""
        sources: list[Source] = ["human", "simulated"] if include_simulated else ["human"]
        mine = (participants.c.study == study.id) & participants.c.source.in_(sources)
        mine &= participants.c.withdrawn_at.is_(None)
        of_people = select(func.count()).select_from(participants).where(mine)
        of_comparisons = select(func.count()).select_from(join(comparisons, participants)).where(mine)
        answered = join(join(responses, comparisons), participants)
        of_responses = select(func.count()).select_from(answered).where(mine)
        run = join(join(trials, comparisons), participants)
        of_trials = select(func.count()).select_from(run).where(mine)
        with self.reading() as connection:

            def number(query: Select[int]) -> int:
                return connection.execute(query).scalar_one()

            return Counts(
                joined=number(of_people),
                consented=number(of_people.where(participants.c.consented_at.is_not(None))),
                finished=number(of_people.where(participants.c.finished_at.is_not(None))),
                planned=number(of_comparisons),
                answered=number(of_comparisons.where(comparisons.c.answered_at.is_not(None))),
                responses=number(of_responses),
                trials=number(of_trials),
                stuck=number(of_trials.where(trials.c.outcome == "stuck")),
            )

    def sources(self, study: StoredStudy, include_simulated: bool) -> list[Source]:
        """The sources to read; never simulated ones unasked."""
        if include_simulated:
            return ["human", "simulated"]
        here = (participants.c.study == study.id) & participants.c.withdrawn_at.is_(None)
        query = select(participants.c.source).where(here).distinct()
        with self.reading() as connection:
            present = set(connection.execute(query).scalars())
        if present == {"simulated"}:
            raise InputError(
                f"{self.address.shown}: {study.label} has simulated participants only; "
                "add --include-simulated to use them"
            )
        return ["human"]


def _measured(value: float | None) -> float:
    """A metric, or NaN: what was never measured is missing or negative."""
    return math.nan if value is None or not value >= 0 else float(value)


def scale_of(question: Question) -> QuestionScale:
    """What the analysis must know of a study's question."""
    return QuestionScale(question.name, question.short, question.wording, question.levels, question.polarity)
