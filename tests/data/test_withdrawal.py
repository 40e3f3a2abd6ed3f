"""A participant withdraws: all they gave is gone for good, and that it is gone is known."""

from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from data.errors import ElbowroomError, InputError
from data.export import export_study
from data.records import Comparison, Participant, Switch
from data.restoring import import_export
from data.store import LinkRefused, Store, token_sha256


def test_everything_that_was_given_is_deleted_and_nothing_of_anybody_else(store, fill, noon):
    stored = fill(store, 2)
    first, second = store.participants(stored)
    store.want_slot(f"{first.id}.c01", "A")
    others = (
        store.comparisons(participant=second.id),
        [t for t in store.trials(stored) if t.id.startswith(second.id)],
        sorted(p.name for p in store.recordings_folder.iterdir() if p.name.startswith(second.id)),
    )
    gone = store.withdraw(first.id, "researcher", noon + timedelta(days=1))
    assert store.comparisons(participant=first.id) == ()
    assert store.external_run(f"{first.id}.c01") is None
    assert others == (
        store.comparisons(participant=second.id),
        list(store.trials(stored)),
        sorted(p.name for p in store.recordings_folder.iterdir()),
    )
    kept = Participant(first.id, first.number, "human", noon, {}, "1", noon, withdrawn_at=gone.withdrawn_at)
    assert store.participant(first.id) == gone == kept
    assert store.participant(second.id) == second


def test_the_number_is_not_given_away_again(store, fill):
    stored = fill(store, 2)
    store.withdraw("h-p002", "researcher")
    assert store.next_number(stored, "human") == 3


def test_withdrawing_is_logged_once_without_saying_who(store, fill, noon):
    fill(store, 1)
    store.withdraw("h-p001", "researcher", noon)
    store.withdraw("h-p001", "researcher", noon + timedelta(hours=1))
    (entry,) = store.audit_log()
    assert (entry.actor, entry.action, entry.at) == ("researcher", "withdraw participant", noon)
    assert entry.detail == {"study": "carmichael2017@1", "number": "1"}
    assert store.participant("h-p001").withdrawn_at == noon
    assert store.verify_audit().is_intact


def test_withdrawing_again_deletes_recordings_that_an_interruption_left(store, fill):
    fill(store, 2)
    store.withdraw("h-p001", "researcher")
    left = store.recordings_folder / "h-p001.c01.A1.parquet"
    left.write_bytes(b"left over")
    before = sorted(p.name for p in store.recordings_folder.iterdir() if p != left)
    store.withdraw("h-p001", "researcher")
    assert sorted(p.name for p in store.recordings_folder.iterdir()) == before


def test_a_recording_that_cannot_be_deleted_is_one_line_and_can_be_tried_again(store, fill, monkeypatch):
    fill(store, 1)

    def refuses(path: Path, missing_ok: bool = False) -> None:
        raise PermissionError(13, "Permission denied")

    with monkeypatch.context() as locked:
        locked.setattr(Path, "unlink", refuses)
        with pytest.raises(ElbowroomError, match=r"\.parquet: cannot be written: permission denied$"):
            store.withdraw("h-p001", "researcher")
    store.withdraw("h-p001", "researcher")
    assert list(store.recordings_folder.iterdir()) == []


def test_what_was_withdrawn_is_not_left_in_the_files_free_space(store, fill, noon):
    stored = fill(store, 1)
    secret = "a-very-telling-word"
    store.add_participant(stored, Participant("zoe", 9, "human", noon, {"job": secret}))
    store.add_comparisons([Comparison("zoe.c1", "zoe", 1, 1, "M1", "M2", False)])
    store.add_switch(Switch("zoe.c1", 1, "A", noon))
    store.create_link("personal", stored, token_sha256("z"), label=f"For {secret}")
    with store.transaction() as connection:
        connection.exec_driver_sql("UPDATE links SET participant = 'zoe'")
    store.withdraw("zoe", "researcher")
    (link,) = store.links(stored)
    assert (link.label, link.expires_at, link.participant) == ("", noon, "zoe")
    store.close()
    assert secret.encode() not in Path(store.address.file).read_bytes()


def test_counts_and_evidence_leave_the_withdrawn_out(store, fill):
    stored = fill(store, 2)
    before, rows = store.counts(stored), store.responses_table(stored).rows
    store.withdraw("h-p001", "researcher")
    after = store.counts(stored)
    assert (before.joined, after.joined) == (2, 1)
    assert after == replace(
        before,
        joined=1,
        consented=1,
        finished=1,
        planned=6,
        answered=6,
        responses=36,
        trials=12,
        stuck=before.stuck // 2,
    )
    left = store.responses_table(stored).rows
    assert set(rows["participant"]) == {"h-p001", "h-p002"}
    assert set(left["participant"]) == set(store.stuck_table(stored).rows["participant"]) == {"h-p002"}


def test_a_store_whose_only_person_withdrew_has_simulated_participants_only(store, fill):
    stored = fill(store, 1)
    fill(store, 1, "simulated")
    store.withdraw("h-p001", "researcher")
    with pytest.raises(InputError, match="add --include-simulated"):
        store.responses_table(stored)


def test_an_export_after_a_withdrawal_holds_nothing_of_it_and_is_rebuilt(store, fill, tmp_path):
    stored = fill(store, 2)
    store.withdraw("h-p001", "researcher")
    result = export_study(store, stored, tmp_path / "out")
    assert (result.participants, result.comparisons, result.recordings) == (2, 6, 12)
    for path in (tmp_path / "out").rglob("*"):
        assert not path.name.startswith("h-p001")
        if path.is_file() and path.name not in ("participants.csv", "participants.jsonl"):
            assert b"h-p001" not in path.read_bytes(), path.name
    with Store.open(tmp_path / "other.sqlite") as other:
        import_export(tmp_path / "out", other)
        assert other.participant("h-p001") == store.participant("h-p001")
        assert other.next_number(other.study(), "human") == 3


def test_nothing_can_be_added_to_a_participant_who_withdrew(store, fill, noon):
    stored = fill(store, 1)
    comparison = store.comparisons(participant="h-p001")[0]
    trial = store.trials(stored)[0]
    store.withdraw("h-p001", "researcher")
    for write in (
        lambda: store.add_comparisons([comparison]),
        lambda: store.add_trial(replace(trial, recording=None, recording_sha256=None)),
        lambda: store.add_switch(Switch(comparison.id, 1, "A", noon)),
        lambda: store.submit_responses(comparison.id, {f"Q{k}": "A>B" for k in range(1, 7)}, noon),
        lambda: store.want_slot(comparison.id, "A"),
        lambda: store.record_background("h-p001", {}, noon),
        lambda: store.record_device("h-p001", "mouse"),
        lambda: store.record_practice("h-p001", noon),
        lambda: store.finish_participant("h-p001", noon),
    ):
        with pytest.raises(ElbowroomError):
            write()
    assert store.counts(stored).planned == 0
    assert store.participant("h-p001").device is None


def test_a_link_leads_nobody_back_into_what_was_withdrawn(store, fill, noon):
    stored = fill(store, 1)
    for kind, token in (("personal", "p"), ("participant", "o")):
        store.create_link(kind, stored, token)
        joined = store.redeem_participant_link(token, f"by-{kind}", noon)
        store.open_session(f"cookie-{kind}", stored, joined.id, noon)
        store.withdraw(joined.id, "researcher")
        with pytest.raises(LinkRefused):
            store.redeem_participant_link(token, joined.id, noon)
        assert store.participant(store.session(f"cookie-{kind}").participant).withdrawn_at is not None
    assert store.redeem_participant_link("o", "somebody-else", noon).number == 4


def test_nobody_can_withdraw_who_is_not_there(store):
    with pytest.raises(ElbowroomError, match="'nobody' is not in the store"):
        store.withdraw("nobody", "researcher")
    assert store.audit_log() == ()
