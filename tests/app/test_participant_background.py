"""The form about the participant: what is kept of it, and what it says is missing."""

import pytest

from app.participant.background import MOST_LETTERS, read_form
from data.study import BackgroundQuestion

ROBOTS = BackgroundQuestion(name="robots", wording="Guided one before?", choices=("Never", "Often"))
AGE = BackgroundQuestion(name="age", wording="How old?", kind="number", lowest=18, highest=99, required=True)
WORK = BackgroundQuestion(name="work", wording="What do you do?", kind="text")
FORM = (ROBOTS, AGE, WORK)


def test_what_was_given_is_kept_and_what_was_left_out_is_not() -> None:
    form = read_form(FORM, {"robots": "Often", "age": 33.0, "work": "  nurse "})
    assert (dict(form.answers), form.open) == ({"robots": "Often", "age": "33", "work": "nurse"}, ())
    form = read_form(FORM, {"robots": None, "age": 33.5, "work": "   "})
    assert dict(form.answers) == {"age": "33.5"}


def test_a_required_question_without_an_answer_stays_open() -> None:
    form = read_form(FORM, {"robots": "Never", "age": None, "work": ""})
    assert form.open == ("age",)


@pytest.mark.parametrize("age", [17.0, 99.5, float("nan"), float("inf"), True, "33"])
def test_a_number_that_is_none_or_out_of_bounds_stays_open(age: object) -> None:
    form = read_form(FORM, {"age": age})
    assert form.open == ("age",)
    assert "age" not in form.answers


def test_a_number_out_of_bounds_is_not_dropped_silently_where_none_is_required() -> None:
    free = AGE.model_copy(update={"required": False})
    assert read_form((free,), {"age": None}).open == ()
    assert read_form((free,), {"age": 5}).open == ("age",)


def test_a_choice_that_is_not_offered_is_no_answer() -> None:
    form = read_form((ROBOTS,), {"robots": "Sometimes"})
    assert (dict(form.answers), form.open) == ({}, ("robots",))


def test_a_text_is_cut_to_what_is_kept() -> None:
    form = read_form((WORK,), {"work": "x" * (MOST_LETTERS + 50)})
    assert len(form.answers["work"]) == MOST_LETTERS
