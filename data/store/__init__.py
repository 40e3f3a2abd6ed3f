"""The store of a study's data: SQLite by default, PostgreSQL by URL."""

from data.store.audit import AuditVerdict
from data.store.evidence import Counts
from data.store.links import BrowserSession, Link, LinkRefused, token_sha256
from data.store.store import Store, utc_now
from data.store.studies import StoredStudy

__all__ = [
    "AuditVerdict",
    "BrowserSession",
    "Counts",
    "Link",
    "LinkRefused",
    "Store",
    "StoredStudy",
    "token_sha256",
    "utc_now",
]
