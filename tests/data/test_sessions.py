"""What a session keeps besides trials and answers: background, device, practice, restarts, lab runs."""

from datetime import datetime, timedelta

import pytest

from data.background import checked_background
from data.errors import ElbowroomError, InputError
from data.records import Comparison, ExternalRun, Participant
from data.store import Store
from data.study import BackgroundQuestion, Study
from data.study_file import study_text

BACKGROUND = (
    BackgroundQuestion(name="hand", wording="Which hand?", choices=("Left", "Right"), required=True),
    BackgroundQuestion(name="age", wording="Age?", kind="number", lowest=18, highest=99),
    BackgroundQuestion(name="job", wording="What do you do?", kind="text"),
)


@pytest.fixture
def one(store: Store, study: Study, noon: datetime) -> Comparison:
    """A comparison that was started."""
    stored = store.add_study(study, study_text("carmichael2017"))
    store.add_participant(stored, Participant("anna", 1, "human", noon))
    store.add_comparisons([Comparison("anna.c1", "anna", 1, 1, "M1", "M3", False)])
    return store.start_comparison("anna.c1", noon)


def test_the_first_answers_to_the_background_questions_stand(store, one, noon):
    given = store.record_background("anna", {"robots": "Never", "games": ""}, noon)
    assert (given.background, given.background_at) == ({"robots": "Never"}, noon)
    assert store.record_background("anna", {"robots": "Often"}, noon + timedelta(days=1)) == given
    assert store.participant("anna") == given


def test_background_answers_add_to_what_an_import_knows(store, one, noon):
    store.add_participant(store.study(), Participant("bo", 2, "human", noon, {"imported_as": "Bø"}))
    assert store.record_background("bo", {"hand": "Left"}, noon).background == {
        "imported_as": "Bø",
        "hand": "Left",
    }


def test_background_answers_that_the_study_does_not_take_are_refused_and_none_is_kept(store, one, noon):
    for answers in ({"robots": "Never", "height": "tall"}, {"robots": "Sometimes"}):
        with pytest.raises(InputError):
            store.record_background("anna", answers, noon)
    assert store.participant("anna").background_at is None


@pytest.mark.parametrize(
    ("answers", "message"),
    [
        ({}, "background question hand has no answer"),
        ({"hand": " "}, "background question hand has no answer"),
        ({"hand": "left"}, "answer to hand: 'left' is not one of: Left, Right"),
        ({"hand": "Left", "eye": "x"}, "background question: 'eye' is not one of: hand, age, job"),
        ({"hand": "Left", "age": "17.9"}, "answer to age: '17.9' is no number from 18 to 99"),
        ({"hand": "Left", "age": "nan"}, "answer to age: 'nan' is no number from 18 to 99"),
        ({"hand": "Left", "age": "3_0"}, "answer to age: '3_0' is no number from 18 to 99"),
        ({"hand": "Left", "job": "x" * 201}, "answer to job: 201 characters; at most 200 are kept"),
    ],
)
def test_a_background_answer_that_is_none_is_one_line(study, answers, message):
    with pytest.raises(InputError) as raised:
        checked_background(study.model_copy(update={"background": BACKGROUND}), answers)
    assert str(raised.value) == message


def test_background_answers_are_kept_in_the_order_of_the_questions_without_empty_ones(study):
    asked = study.model_copy(update={"background": BACKGROUND})
    given = checked_background(asked, {"job": " Welder ", "age": "", "hand": "Right"})
    assert list(given.items()) == [("hand", "Right"), ("job", "Welder")]
    assert checked_background(asked, {"hand": "Left", "age": "18"})["age"] == "18"


def test_the_first_device_and_the_first_practice_stand(store, one, noon):
    assert store.record_device("anna", "mouse").device == "mouse"
    assert store.record_device("anna", "touch").device == "mouse"
    practised = store.record_practice("anna", noon)
    assert store.record_practice("anna", noon + timedelta(hours=1)) == practised
    assert store.participant("anna") == practised
    assert (practised.device, practised.practised_at) == ("mouse", noon)


def test_a_device_that_nobody_can_hold_is_refused(store, one):
    with pytest.raises(ElbowroomError, match="valid_device"):
        store.record_device("anna", "telepathy")


def test_an_open_comparison_can_be_begun_anew_and_the_last_time_counts(store, one, noon):
    later = noon + timedelta(hours=1)
    assert store.restart_comparison(one.id, noon).restarted_at == noon
    assert store.restart_comparison(one.id, later).restarted_at == later
    assert store.comparison(one.id).started_at == noon


def test_a_comparison_that_is_answered_or_not_begun_is_not_begun_anew(store, one, study, noon):
    store.add_comparisons([Comparison("anna.c2", "anna", 2, 1, "M2", "M3", False)])
    store.submit_responses(one.id, {q.name: "A>B" for q in study.questions}, noon)
    for comparison in (one.id, "anna.c2"):
        assert store.restart_comparison(comparison, noon).restarted_at is None


def test_a_run_in_the_lab_goes_from_wanted_to_loaded_to_running_and_back(store, one, noon):
    assert store.external_run(one.id) is None
    assert store.want_slot(one.id, "A") == ExternalRun(one.id, "A")
    assert store.load_slot(one.id, "A") == ExternalRun(one.id, "A", "A")
    running = store.start_run(one.id, noon)
    assert (
        store.start_run(one.id, noon + timedelta(seconds=5)) == running == ExternalRun(one.id, "A", "A", noon)
    )
    assert store.want_slot(one.id, "B") == ExternalRun(one.id, "B", "A", noon)
    assert store.end_run(one.id) == store.external_run(one.id) == ExternalRun(one.id, "B", "A")
    assert store.load_slot(one.id, None).loaded is None


def test_a_method_is_not_changed_under_a_running_robot(store, one, noon):
    store.want_slot(one.id, "A")
    store.load_slot(one.id, "A")
    store.start_run(one.id, noon)
    with pytest.raises(ElbowroomError, match="a run is under way"):
        store.load_slot(one.id, "B")
    assert store.external_run(one.id).loaded == "A"


def test_no_run_begins_without_a_method_or_a_comparison(store, one, noon):
    with pytest.raises(ElbowroomError, match="turned to no method yet"):
        store.start_run(one.id, noon)
    store.want_slot(one.id, "A")
    with pytest.raises(ElbowroomError, match="no method is loaded"):
        store.start_run(one.id, noon)
    with pytest.raises(ElbowroomError, match="'nothing' is not in the store"):
        store.want_slot("nothing", "A")


def test_a_run_ends_together_with_its_trial_or_not_at_all(store, one, noon):
    store.want_slot(one.id, "A")
    store.load_slot(one.id, "A")
    running = store.start_run(one.id, noon)

    def end_and_fail() -> None:
        with store.transaction():
            store.end_run(one.id)
            raise KeyError

    with pytest.raises(KeyError):
        end_and_fail()
    assert store.external_run(one.id) == running
