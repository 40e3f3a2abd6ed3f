"""The audit log: no change of what was once written goes unnoticed."""

import sqlite3
from contextlib import closing
from datetime import timedelta

import pytest

from data.records import Look
from data.store import Store
from data.store.audit import chain_hash


@pytest.fixture
def logged(store: Store, noon) -> Store:
    for k in range(4):
        store.log("researcher", f"action {k}", {"b": "2", "a": str(k)}, noon + timedelta(seconds=k))
    return store


def test_an_untouched_log_is_intact(logged):
    assert logged.verify_audit().is_intact
    assert logged.verify_audit().sentence == "audit log intact: 4 entries"


def test_the_database_refuses_to_change_or_delete_an_entry(logged):
    for change in ("UPDATE audit SET actor = 'x'", "DELETE FROM audit"):
        with (
            closing(sqlite3.connect(logged.address.file)) as database,
            pytest.raises(sqlite3.IntegrityError, match="append-only"),
        ):
            database.execute(change)


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE audit SET actor = 'somebody else' WHERE number = 3",
        "UPDATE audit SET action = 'action' WHERE number = 3",
        "UPDATE audit SET at = '2020-01-01 00:00:00.000000' WHERE number = 3",
        """UPDATE audit SET detail = '{"a": "2", "b": "3"}' WHERE number = 3""",
        "UPDATE audit SET sha256 = '0' WHERE number = 3",
        "DELETE FROM audit WHERE number = 3",
        "UPDATE audit SET number = number + 10 WHERE number >= 3",
        "INSERT INTO audit SELECT 5, at, actor, action, detail, sha256 FROM audit WHERE number = 4",
    ],
)
def test_tampering_is_found_where_it_happened(logged, change):
    with closing(sqlite3.connect(logged.address.file)) as database:
        for trigger in ("audit_no_update", "audit_no_delete"):
            database.execute(f"DROP TRIGGER {trigger}")
        database.execute(change)
        database.commit()
    verdict = logged.verify_audit()
    assert not verdict.is_intact
    assert verdict.first_bad == (5 if change.startswith("INSERT") else 3)


def test_a_forged_entry_with_a_hash_of_its_own_breaks_the_chain_behind_it(logged):
    before, entry, *_ = logged.audit_log()
    forged = chain_hash(before.sha256, 2, entry.at, "somebody else", entry.action, entry.detail)
    with closing(sqlite3.connect(logged.address.file)) as database:
        database.execute("DROP TRIGGER audit_no_update")
        database.execute("UPDATE audit SET actor = 'somebody else', sha256 = ? WHERE number = 2", [forged])
        database.commit()
    assert logged.verify_audit().first_bad == 3


def test_the_order_of_details_makes_no_difference(store, noon):
    assert dict(store.log("a", "b", {"y": "1", "x": "2"}, noon).detail) == {"x": "2", "y": "1"}
    assert store.verify_audit().is_intact


def test_a_look_at_results_is_kept_once_for_each_number_of_answers(store, fill, noon):
    stored = fill(store, people=1)
    for look in (Look(1, 6), Look(1, 6), Look(2, 12), Look(2, 12), Look(1, 6)):
        store.log_look(stored, look, "researcher", noon)
    assert store.looks(stored) == (Look(1, 6), Look(2, 12))
    assert store.verify_audit().is_intact
    entry = store.audit_log()[-1]
    assert (entry.actor, entry.action) == ("researcher", "look at results")
    assert not {"M1", "M2", "M3"} & set(entry.detail.values())


def test_results_without_answers_of_people_are_no_look(store, fill):
    stored = fill(store, people=1, source="simulated")
    table = store.responses_table(stored, include_simulated=True)
    store.log_look(stored, table.look, "researcher")
    assert store.looks(stored) == ()
    stored = fill(store, people=2)
    store.log_look(stored, store.responses_table(stored, include_simulated=True).look, "researcher")
    per_person = 6 * 6
    assert store.looks(stored) == (Look(2, 2 * per_person),)
