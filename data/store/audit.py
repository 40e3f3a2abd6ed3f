"""The audit log: append-only, each entry chained by its hash to the one before."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from sqlalchemy import select

from data.records import AuditEntry, Look
from data.store.external_runs import StoredExternalRuns
from data.store.rows import every, first, record_of, row_of
from data.store.studies import StoredStudy
from data.store.tables import audit

UNBLIND = "unblind"
LOCK = "lock study"
LOOK = "look at results"


@dataclass(frozen=True)
class AuditVerdict:
    """Whether a log is as it was written.

    Attributes
    ----------
    first_bad : int or None
        Number of the first entry that is not what was written there.
    """

    is_intact: bool
    entries: int
    first_bad: int | None

    @property
    def sentence(self) -> str:
        """One line for people."""
        if self.is_intact:
            return f"audit log intact: {self.entries} {'entry' if self.entries == 1 else 'entries'}"
        return f"audit log changed after it was written, from entry {self.first_bad} on"


class StoredAudit(StoredExternalRuns):
    """The audit log of a store."""

    def log(
        self, actor: str, action: str, detail: Mapping[str, str] | None = None, at: datetime | None = None
    ) -> AuditEntry:
        """Append an entry; ``at`` is the store's clock's time unless it is given."""
        with self.transaction() as connection:
            newest = first(connection, select(audit).order_by(audit.c.number.desc()).limit(1))
            number, before = (newest["number"], newest["sha256"]) if newest else (0, "")
            time = at or self.clock()
            contents = dict(sorted((detail or {}).items()))
            sha256 = chain_hash(before, number + 1, time, actor, action, contents)
            entry = AuditEntry(number + 1, time, actor, action, contents, sha256)
            connection.execute(audit.insert(), row_of(entry, audit))
            return entry

    def audit_log(self) -> tuple[AuditEntry, ...]:
        """All entries, in order."""
        with self.reading() as connection:
            rows = every(connection, select(audit).order_by(audit.c.number))
            return tuple(record_of(AuditEntry, row) for row in rows)

    def verify_audit(self) -> AuditVerdict:
        """Recompute the chain of hashes."""
        return verify_chain(self.audit_log())

    def unblind(self, study: StoredStudy, actor: str, at: datetime | None = None) -> None:
        """Keep that the modes behind a study's coded labels were revealed, once."""
        with self.transaction():
            if not self.is_unblinded(study):
                self.log(actor, UNBLIND, {"study": study.label, "sha256": study.sha256}, at)

    def lock_study(self, study: StoredStudy, actor: str, at: datetime | None = None) -> None:
        """Lock a revision of a study by hand, as the first person who takes part does; once."""
        with self.transaction() as connection:
            if not self._study_by_id(connection, study.id).locked:
                self._lock(connection, study.id)
                self.log(actor, LOCK, {"study": study.label, "sha256": study.sha256}, at)

    def log_look(self, study: StoredStudy, look: Look, actor: str, at: datetime | None = None) -> None:
        """Keep that a ranking was shown, once for each number of answers: the same results again are no
        further look. Results without any answer of people are none."""
        if not self._is_new(study, look):
            return
        with self.transaction():
            if self._is_new(study, look):
                detail = {
                    "study": study.label,
                    "sha256": study.sha256,
                    "participants": str(look.participants),
                    "answers": str(look.answers),
                }
                self.log(actor, LOOK, detail, at)

    def _is_new(self, study: StoredStudy, look: Look) -> bool:
        return look.answers > 0 and all(look.answers != before.answers for before in self.looks(study))

    def looks(self, study: StoredStudy) -> tuple[Look, ...]:
        """How often a ranking of this revision of the study was shown, in order."""
        with self.reading() as connection:
            details = connection.execute(
                select(audit.c.detail).where(audit.c.action == LOOK).order_by(audit.c.number)
            ).scalars()
            return tuple(
                Look(int(detail["participants"]), int(detail["answers"]))
                for detail in details
                if detail.get("sha256") == study.sha256
            )

    def is_unblinded(self, study: StoredStudy) -> bool:
        """Whether anyone has revealed the modes of this revision of the study."""
        with self.reading() as connection:
            details = connection.execute(select(audit.c.detail).where(audit.c.action == UNBLIND)).scalars()
            return any(detail.get("sha256") == study.sha256 for detail in details)


def chain_hash(
    before: str, number: int, at: datetime, actor: str, action: str, detail: Mapping[str, str]
) -> str:
    """Hash of an entry together with the hash of the entry before, "" for the first."""
    time = at.astimezone(UTC).isoformat(timespec="microseconds")
    content = [before, number, time, actor, action, dict(sorted(detail.items()))]
    return hashlib.sha256(json.dumps(content, ensure_ascii=True, separators=(",", ":")).encode()).hexdigest()


def verify_chain(entries: Sequence[AuditEntry]) -> AuditVerdict:
    """Whether entries, from the first on, are a chain as the log writes it."""
    before = ""
    for number, entry in enumerate(entries, start=1):
        expected = chain_hash(before, number, entry.at, entry.actor, entry.action, entry.detail)
        if entry.number != number or entry.sha256 != expected:
            return AuditVerdict(False, len(entries), number)
        before = entry.sha256
    return AuditVerdict(True, len(entries), None)
