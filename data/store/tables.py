"""The store's tables, in what SQLite and PostgreSQL both speak.

Columns bear the names of the records' fields. ``info`` says what a column means, in which unit and
which values are valid: the codebook of an export is made from it.
"""

import math
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any, get_args

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    CheckConstraint,
    Column,
    DateTime,
    Dialect,
    Double,
    ForeignKey,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
    text,
)
from sqlalchemy.types import TypeDecorator, TypeEngine

from data.answers import SCALES
from data.records import Device, EventKind, Outcome, Slot, Source, TrialSource

metadata = MetaData(
    naming_convention={
        "pk": "pk_%(table_name)s",
        "fk": "fk_%(table_name)s_%(column_0_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    }
)


class UtcTime(TypeDecorator[datetime]):
    """An aware time; stored and given back in UTC, to the microsecond."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Refuse a time without a zone: nobody could say later when it was."""
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError(f"a time without a zone: {value}")
        return value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """SQLite keeps no zone: what it gives back is UTC."""
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


class Real(TypeDecorator[float]):
    """A finite number, or NaN for one that is not known, kept as NULL."""

    impl = Double
    cache_ok = True

    def process_bind_param(self, value: float | None, dialect: Dialect) -> float | None:
        """NaN becomes NULL; an infinite value is refused."""
        if value is None or math.isnan(value):
            return None
        if math.isinf(value):
            raise ValueError("an infinite number cannot be stored")
        return float(value)

    def process_result_value(self, value: float | None, dialect: Dialect) -> float:
        """NULL becomes NaN."""
        return math.nan if value is None else float(value)


class Texts(TypeDecorator[Mapping[str, str]]):
    """Texts by name, sorted by name so that equal contents are equal bytes."""

    impl = JSON
    cache_ok = True

    def process_bind_param(self, value: Mapping[str, str] | None, dialect: Dialect) -> dict[str, str]:
        """Sorted by name."""
        return dict(sorted((value or {}).items()))


class Numbers(TypeDecorator[Mapping[str, float]]):
    """Numbers by name; JSON has no NaN and no infinity, so these are kept as null and as text."""

    impl = JSON
    cache_ok = True

    def process_bind_param(self, value: Mapping[str, float] | None, dialect: Dialect) -> dict[str, Any]:
        """Sorted by name, NaN as null, infinity as ``"inf"``."""
        return {name: _json_number(number) for name, number in sorted((value or {}).items())}

    def process_result_value(self, value: Mapping[str, Any] | None, dialect: Dialect) -> dict[str, float]:
        """All numbers again."""
        return {name: math.nan if v is None else float(v) for name, v in (value or {}).items()}


def _json_number(number: float) -> float | str | None:
    if math.isnan(number):
        return None
    return str(float(number)) if math.isinf(number) else float(number)


def _column(
    name: str,
    kind: TypeEngine[Any] | type[TypeEngine[Any]],
    meaning: str,
    *extra: ForeignKey | CheckConstraint,
    unit: str = "",
    valid: tuple[str, ...] = (),
    nullable: bool = False,
    primary_key: bool = False,
) -> Column[Any]:
    info = {"meaning": meaning, "unit": unit, "valid": valid}
    return Column(name, kind, *extra, nullable=nullable, primary_key=primary_key, info=info)


def _choice(name: str, valid: tuple[str, ...], meaning: str, nullable: bool = False) -> Column[Any]:
    listed = ", ".join(f"'{value}'" for value in valid)
    check = CheckConstraint(f"{name} IN ({listed})", f"valid_{name}")
    return _column(name, String(20), meaning, check, valid=valid, nullable=nullable)


def _key(name: str, meaning: str) -> Column[Any]:
    return _column(name, String(120), meaning, primary_key=True)


def _of(name: str, target: str, meaning: str, primary_key: bool = False) -> Column[Any]:
    return _column(name, String(120), meaning, ForeignKey(target), primary_key=primary_key)


def _of_study() -> Column[Any]:
    return _column("study", Integer, "The study's number in the store", ForeignKey("studies.id"))


studies = Table(
    "studies",
    metadata,
    _column("id", Integer, "Number of this revision in the store", primary_key=True),
    _column("name", String(40), "The study's name"),
    _column("revision", Integer, "Counts the changes of the file under one name, from 1"),
    _column("version", Text, "The version that the study file gives itself"),
    _column("sha256", String(64), "Hash of the study's meaning, without comments and layout"),
    _column("toml", Text, "The study file"),
    _column("locked", Boolean, "True once a person has taken part"),
    UniqueConstraint("name", "revision"),
    UniqueConstraint("name", "sha256"),
)

allocations = Table(
    "allocations",
    metadata,
    _column("study", Integer, "The study's number", ForeignKey("studies.id"), primary_key=True),
    _column("source", String(20), "For people or simulated participants", primary_key=True),
    _column("last_number", Integer, "The last participant number given away"),
)

participants = Table(
    "participants",
    metadata,
    _key("id", "Identifies the participant; no name"),
    _of_study(),
    _column("number", Integer, "Place in the study, from 1; decides the schedule"),
    _choice("source", get_args(Source), "A person, or a simulated participant"),
    _column("joined_at", UtcTime, "When the participant joined", unit="UTC"),
    _column("background", Texts, "Answers to the background questions"),
    _column("consent_version", Text, "Version of the consent text agreed to", nullable=True),
    _column("consented_at", UtcTime, "When consent was given", unit="UTC", nullable=True),
    _column("finished_at", UtcTime, "When the last comparison was answered", unit="UTC", nullable=True),
    _column(
        "background_at", UtcTime, "When the background questions were answered", unit="UTC", nullable=True
    ),
    _choice("device", get_args(Device), "What the robot is guided with", nullable=True),
    _column("practised_at", UtcTime, "When practice was done", unit="UTC", nullable=True),
    _column("withdrawn_at", UtcTime, "When the participant's data were withdrawn", unit="UTC", nullable=True),
    _column("pooled", Boolean, "True if this stands for unknown people whose answers were imported together"),
    # Every person has a number of their own; simulated cohorts of several seeds share the schedule's.
    Index(
        "uq_participants_human_number",
        "study",
        "number",
        unique=True,
        sqlite_where=text("source = 'human'"),
        postgresql_where=text("source = 'human'"),
    ),
)

comparisons = Table(
    "comparisons",
    metadata,
    _key("id", "Identifies the comparison: one blinded A/B pair shown to one participant"),
    _of("participant", "participants.id", "Who compared"),
    _column("position", Integer, "Place in the participant's session, from 1"),
    _column("repetition", Integer, "Which showing of this pair it was, from 1; 0 for a check"),
    _column("mode_a", String(40), "Mode shown as A"),
    _column("mode_b", String(40), "Mode shown as B"),
    _column("check", Boolean, "True for an attention check, where A and B may be one mode"),
    _column("started_at", UtcTime, "When it was first shown", unit="UTC", nullable=True),
    _column("answered_at", UtcTime, "When the answers were submitted", unit="UTC", nullable=True),
    _column(
        "restarted_at",
        UtcTime,
        "When it was begun anew: trials before count no longer as exposure",
        unit="UTC",
        nullable=True,
    ),
    UniqueConstraint("participant", "position"),
)

trials = Table(
    "trials",
    metadata,
    _key("id", "Identifies the trial: one run at the maze under one condition"),
    _of("comparison", "comparisons.id", "The comparison it belongs to"),
    _choice("slot", get_args(Slot), "Shown as A or as B"),
    _column("number", Integer, "Which trial of this slot in the comparison, from 1"),
    _column("mode", String(40), "The mode behind the slot"),
    _choice("source", get_args(TrialSource), "Where the trial comes from"),
    _choice("outcome", get_args(Outcome), "How the trial ended"),
    _column("started_at", UtcTime, "When it started", unit="UTC"),
    _column("duration_s", Real, "Time of exposure to the condition", unit="s", nullable=True),
    _column("seed", BigInteger, "Seed of the simulated operator and the noise"),
    _column("metrics", Numbers, "Objective metrics; the unit stands in each name"),
    _column("recording", Text, "The recording's file in the folder of recordings", nullable=True),
    _column("recording_sha256", String(64), "Hash of the recording", nullable=True),
    UniqueConstraint("comparison", "slot", "number"),
)

stuck_events = Table(
    "stuck_events",
    metadata,
    _of("trial", "trials.id", "The trial it happened in", primary_key=True),
    _column("number", Integer, "Counts the events of the trial, from 1", primary_key=True),
    _choice("kind", get_args(EventKind), "What happened"),
    _column("time_s", Real, "Since the start of the trial", unit="s", nullable=True),
    _column("sigma_min", Real, "Smallest singular value at that moment, SI units", nullable=True),
    _column("phase", Text, "Part of the lap: approach, edge or exit"),
    _column("definition", Text, "Version of the definition that found it"),
)

responses = Table(
    "responses",
    metadata,
    _of("comparison", "comparisons.id", "The comparison that was judged", primary_key=True),
    _column("question", String(40), "Name of the question", primary_key=True),
    _choice("answer", SCALES[5], "Which of A and B, and how much"),
    _column("answered_at", UtcTime, "When it was submitted", unit="UTC"),
)

switches = Table(
    "switches",
    metadata,
    _of("comparison", "comparisons.id", "The comparison", primary_key=True),
    _column("number", Integer, "Counts the switches of the comparison, from 1", primary_key=True),
    _choice("slot", get_args(Slot), "The method turned to"),
    _column("at", UtcTime, "When", unit="UTC"),
)

external_runs = Table(
    "external_runs",
    metadata,
    _of("comparison", "comparisons.id", "The comparison under way at the robot", primary_key=True),
    _choice("wanted", get_args(Slot), "The method the participant turned to"),
    _choice("loaded", get_args(Slot), "The method the operator has loaded", nullable=True),
    _column("started_at", UtcTime, "When the run under way began", unit="UTC", nullable=True),
)

audit = Table(
    "audit",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=False, info={"meaning": "Counts the entries"}),
    _column("at", UtcTime, "When", unit="UTC"),
    _column("actor", Text, "Who"),
    _column("action", Text, "Did what"),
    _column("detail", Texts, "With what"),
    _column("sha256", String(64), "Hash of this entry and of the one before"),
)

LINK_KINDS = ("participant", "personal", "researcher")

links = Table(
    "links",
    metadata,
    _column(
        "token_sha256", String(64), "Hash of the link's token; the token itself is not kept", primary_key=True
    ),
    _of_study(),
    _choice("kind", LINK_KINDS, "For any participant, for one, or for a researcher once"),
    _column("label", Text, "What the researcher calls it"),
    _column("created_at", UtcTime, "When it was made", unit="UTC"),
    _column("expires_at", UtcTime, "From when on it is refused", unit="UTC", nullable=True),
    _column("used_at", UtcTime, "When it was first followed", unit="UTC", nullable=True),
    _column(
        "participant",
        String(120),
        "Who followed a personal link",
        ForeignKey("participants.id"),
        nullable=True,
    ),
)

sessions = Table(
    "sessions",
    metadata,
    _column("token_sha256", String(64), "Hash of the browser's cookie", primary_key=True),
    _of_study(),
    _column(
        "participant",
        String(120),
        "Who it is; empty for a researcher",
        ForeignKey("participants.id"),
        nullable=True,
    ),
    _column("created_at", UtcTime, "When it began", unit="UTC"),
)

imports = Table(
    "imports",
    metadata,
    _column("study", Integer, "The study's number", ForeignKey("studies.id"), primary_key=True),
    _column("kind", String(20), "Responses or stuck events", primary_key=True),
    _column("sha256", String(64), "Hash of the file that was imported", primary_key=True),
    _column("at", UtcTime, "When", unit="UTC"),
    _column("rows", Integer, "What it added"),
)
