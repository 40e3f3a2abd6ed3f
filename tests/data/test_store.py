"""What a store promises: written once, together, and never mixed."""

from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from data.errors import ElbowroomError, InputError
from data.records import Comparison, Participant, Switch
from data.store import LinkRefused, Store, token_sha256
from data.study import Study
from data.study_file import parse_study, study_text

ANSWERS = {f"Q{k}": "A>B" for k in range(1, 7)}


@pytest.fixture
def one(store: Store, study: Study, noon: datetime) -> Comparison:
    """A comparison that nobody answered yet."""
    stored = store.add_study(study, study_text("carmichael2017"))
    store.add_participant(stored, Participant("anna", 1, "human", noon))
    store.add_comparisons([Comparison("anna.c1", "anna", 1, 1, "M1", "M3", False)])
    return store.comparison("anna.c1")


def test_answers_written_twice_are_stored_once(store, one, noon):
    first = store.submit_responses(one.id, ANSWERS, noon)
    again = store.submit_responses(one.id, dict(reversed(ANSWERS.items())), noon + timedelta(hours=1))
    assert first == again == store.responses(one.id)
    assert [r.question for r in first] == list(ANSWERS)
    assert store.comparison(one.id).answered_at == noon


def test_other_answers_after_submission_are_refused_and_change_nothing(store, one, noon):
    before = store.submit_responses(one.id, ANSWERS, noon)
    with pytest.raises(ElbowroomError, match="submitted before"):
        store.submit_responses(one.id, ANSWERS | {"Q1": "B>A"}, noon)
    assert store.responses(one.id) == before


@pytest.mark.parametrize(
    ("answers", "message"),
    [
        (ANSWERS | {"Q4": "A>>B"}, "answer to Q4: 'A>>B' is not one of: A>B, A=B, B>A"),
        (ANSWERS | {"Q1": ""}, "answer to Q1: '' is not one of: A>>B"),
        (ANSWERS | {"Q7": "A>B"}, "question: 'Q7' is not one of: Q1, Q2"),
        ({k: v for k, v in ANSWERS.items() if k != "Q5"}, "question Q5 has no answer"),
    ],
)
def test_an_answer_off_the_scale_is_an_error_and_stores_none_of_them(store, one, noon, answers, message):
    with pytest.raises(InputError, match=message):
        store.submit_responses(one.id, answers, noon)
    assert store.responses(one.id) == ()
    assert store.comparison(one.id).answered_at is None


def test_a_failure_inside_a_transaction_leaves_nothing_of_it(store, one, noon):
    def write_and_fail() -> None:
        with store.transaction():
            store.submit_responses(one.id, ANSWERS, noon)
            store.add_switch(Switch(one.id, 1, "A", noon))
            raise KeyError

    with pytest.raises(KeyError):
        write_and_fail()
    assert store.responses(one.id) == ()
    assert store.switches(one.id) == ()


def test_everything_written_again_changes_nothing(store, fill, study):
    stored = fill(store)
    before = (store.participants(stored), store.comparisons(stored), store.counts(stored))
    fill(store)
    assert (store.participants(stored), store.comparisons(stored), store.counts(stored)) == before
    assert before[2].trials == 24
    assert before[2].responses == 72


def test_a_trial_stored_otherwise_is_refused(store, fill):
    trial = store.trials(fill(store, 1))[0]
    with pytest.raises(ElbowroomError, match="another one of this id"):
        store.add_trial(replace(trial, duration_s=1.0))


def test_a_trial_under_the_other_slots_mode_is_refused(store, fill):
    trial = store.trials(fill(store, 1))[0]
    other = next(m for m in ("M1", "M2", "M3") if m != trial.mode)
    with pytest.raises(ElbowroomError, match=f"stands for {trial.mode}, not for {other}"):
        store.add_trial(replace(trial, id="x", number=2, mode=other))


def test_a_trial_is_not_stored_before_its_recording_is(store, fill):
    trial = store.trials(fill(store, 1))[0]
    new = replace(trial, id="x", number=2, recording="missing.parquet")
    with pytest.raises(ElbowroomError, match="recording is missing"):
        store.add_trial(new)
    (store.recordings_folder / "missing.parquet").write_bytes(b"something else")
    with pytest.raises(ElbowroomError, match="differs from its hash"):
        store.add_trial(new)
    assert trial.id in {t.id for t in store.trials()}
    assert "x" not in {t.id for t in store.trials()}


def test_a_recording_outside_the_folder_is_refused(store, fill):
    trial = store.trials(fill(store, 1))[0]
    with pytest.raises(ElbowroomError, match="the name of a file"):
        store.add_trial(replace(trial, id="x", number=2, recording="../study.sqlite"))


def test_a_changed_study_file_is_the_next_revision_and_the_old_one_stays(store, study):
    text = study_text("carmichael2017")
    first = store.add_study(study, text)
    changed = text.replace("dwell_s = 5.0", "dwell_s = 6.0")
    second = store.add_study(parse_study(changed, "changed"), changed)
    assert (first.revision, second.revision) == (1, 2)
    assert store.add_study(study, text) == first
    assert store.study("carmichael2017@1").study.stuck.dwell_s == 5.0


def test_a_comment_in_the_study_file_makes_no_revision(store, study):
    text = study_text("carmichael2017")
    assert store.add_study(study, text) == store.add_study(study, "# seen\n" + text)


def test_a_study_is_locked_by_people_and_not_by_simulated_participants(store, fill):
    assert not store.study(fill(store, 1, "simulated").label).locked
    assert store.study(fill(store, 1, "human").label).locked


def test_a_store_with_two_studies_asks_which_and_lists_them(store, fill, study, noon):
    stored = fill(store, 1)
    text = study_text("carmichael2017").replace('name = "carmichael2017"', 'name = "other"')
    other = store.add_study(parse_study(text, "other"), text)
    assert store.study() == store.study(stored.name)
    store.add_participant(other, Participant("bob", 1, "human", noon))
    with pytest.raises(InputError, match=r"say --study NAME, one of: carmichael2017@1, other@1"):
        store.study()
    assert store.study("other").id == other.id
    with pytest.raises(InputError, match=r"'third' is not in .*: carmichael2017@1, other@1"):
        store.study("third")


def test_two_revisions_that_people_took_part_in_are_never_mixed(store, fill, noon):
    fill(store, 1)
    text = study_text("carmichael2017").replace("dwell_s = 5.0", "dwell_s = 6.0")
    second = store.add_study(parse_study(text, "changed"), text)
    assert store.study("carmichael2017").revision == 1
    store.add_participant(second, Participant("late", 1, "human", noon))
    with pytest.raises(InputError, match="carmichael2017@1, carmichael2017@2"):
        store.study("carmichael2017")
    assert store.study("carmichael2017@2").id == second.id


def test_a_study_in_a_store_is_found_by_its_file(store, fill, tmp_path):
    stored = fill(store, 1)
    path = tmp_path / "mine.toml"
    path.write_text("# mine\n" + study_text("carmichael2017"), encoding="utf-8")
    assert store.study(str(path)).id == stored.id


def test_a_person_and_a_simulated_participant_are_counted_and_read_apart(store, fill):
    stored = fill(store, 2, "human")
    fill(store, 3, "simulated")
    assert (store.counts(stored).joined, store.counts(stored, include_simulated=True).joined) == (2, 5)
    people = store.responses_table(stored)
    everybody = store.responses_table(stored, include_simulated=True)
    assert (len(people.rows), people.is_simulated) == (72, False)
    assert (len(everybody.rows), everybody.is_simulated) == (180, True)
    assert people.sha256 != everybody.sha256


def test_a_store_with_simulated_data_only_says_what_to_add(store, fill):
    stored = fill(store, 1, "simulated")
    for read in (store.responses_table, store.stuck_table):
        with pytest.raises(InputError, match="add --include-simulated"):
            read(stored)


def test_a_study_without_responses_has_no_table(store, one):
    with pytest.raises(InputError, match="no responses yet"):
        store.responses_table(store.study())


def test_the_response_table_has_the_modes_and_questions_of_the_study(store, fill, study):
    table = store.responses_table(fill(store))
    assert table.modes == ("M1", "M2", "M3")
    assert [q.levels for q in table.questions] == [5, 5, 5, 3, 3, 3]
    assert table.has_participants
    row = table.rows.iloc[0]
    comparison = store.comparison(row["comparison"])
    assert (row["mode_a"], row["mode_b"]) == (comparison.mode_a, comparison.mode_b)


def test_the_stuck_table_has_both_modes_of_every_comparison(store, fill):
    rows = store.stuck_table(fill(store)).rows
    assert rows.groupby("comparison").size().eq(2).all()
    assert set(rows.loc[rows["stuck"], "mode"]) == {"M1"}
    assert rows["stuck"].sum() == (rows["mode"] == "M1").sum() == 8
    assert set(rows["exposure_s"]) == {31.25}


def test_without_trials_there_is_no_stuck_table(store, one):
    assert store.stuck_table(store.study()) is None


def test_a_personal_link_leads_to_one_participant_and_an_open_one_to_many(store, study, noon):
    stored = store.add_study(study, study_text("carmichael2017"))
    store.create_link("personal", stored, token_sha256("p"), label="Anna")
    store.create_link("participant", stored, token_sha256("o"))
    anna = store.redeem_participant_link(token_sha256("p"), "anna")
    assert store.redeem_participant_link(token_sha256("p"), "berta") == anna
    joined = [store.redeem_participant_link(token_sha256("o"), f"v{k}").number for k in range(3)]
    assert [anna.number, *joined] == [1, 2, 3, 4]


def test_a_researcher_link_opens_once(store, study):
    stored = store.add_study(study, study_text("carmichael2017"))
    store.create_link("researcher", stored, token_sha256("r"))
    assert store.redeem_researcher_link(token_sha256("r")) == stored
    with pytest.raises(LinkRefused, match="used before"):
        store.redeem_researcher_link(token_sha256("r"))


def test_links_that_are_expired_revoked_unknown_or_of_another_kind_are_refused(store, study, noon):
    stored = store.add_study(study, study_text("carmichael2017"))
    store.create_link("participant", stored, "a", expires_at=noon)
    store.create_link("participant", stored, "b")
    store.revoke_link("b")
    store.create_link("researcher", stored, "c")
    for token in ("a", "b", "c", "d"):
        with pytest.raises(LinkRefused):
            store.redeem_participant_link(token, "anna")
    assert store.participants(stored) == ()


def test_no_token_is_in_the_store(store, study, tmp_path):
    stored = store.add_study(study, study_text("carmichael2017"))
    store.create_link("researcher", stored, token_sha256("a-secret-token"))
    store.open_session(token_sha256("a-secret-cookie"), stored, None)
    assert store.session(token_sha256("a-secret-cookie")).participant is None
    assert store.session(token_sha256("another")) is None
    store.close()
    assert b"secret" not in Path(store.address.file).read_bytes()


def test_unblinding_is_kept_once_and_for_that_revision_alone(store, fill, study):
    stored = fill(store, 1)
    assert not store.is_unblinded(stored)
    store.unblind(stored, "researcher")
    store.unblind(stored, "researcher")
    assert store.is_unblinded(stored)
    assert [entry.action for entry in store.audit_log()] == ["unblind"]
    text = study_text("carmichael2017").replace("dwell_s = 5.0", "dwell_s = 6.0")
    assert not store.is_unblinded(store.add_study(parse_study(text, "changed"), text))


def test_consent_once_given_stands(store, one, noon):
    agreed = store.record_consent("anna", "1", noon)
    assert (agreed.consent_version, agreed.consented_at) == ("1", noon)
    assert store.record_consent("anna", "1", noon + timedelta(days=1)) == agreed
    assert store.participant("anna") == agreed
    with pytest.raises(ElbowroomError, match="agreed to version 1"):
        store.record_consent("anna", "2", noon)


def test_a_time_without_a_zone_is_refused(store, one):
    with pytest.raises(ElbowroomError, match="without a zone"):
        store.start_comparison(one.id, datetime(2026, 1, 1))
