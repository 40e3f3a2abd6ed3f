"""Names that look alike are refused or said, and printed so that a reader sees the difference."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from data.errors import InputError
from data.labels import folded, look_alikes, plain_or_quoted, quoted
from data.response_csv import read_response_csv

HEADER = "participant,question,mode_a,mode_b,response,comparison"


def read(folder, text, study=None):
    path = folder / "answers.csv"
    path.write_text(text, encoding="utf-8")
    return read_response_csv(path, study)


@pytest.mark.parametrize(
    ("other", "visible"),
    [
        ("M1 ", "'M1 '"),
        ("M1\u00a0", r"'M1\xa0'"),
        ("\u200bM1", r"'\u200bM1'"),
        ("M\ufeff1", r"'M\ufeff1'"),
        ("m1", "'m1'"),
        ("M\u20091", r"'M\u20091'"),
    ],
)
def test_two_spellings_of_a_mode_are_refused_and_both_are_visible(tmp_path, other, visible):
    first = "M 1" if "\u2009" in other else "M1"
    with pytest.raises(InputError) as raised:
        read(tmp_path, f"{HEADER}\np,Q,{first},M2,A>B,1\np,Q,M2,{other},A>B,2\n")
    message = str(raised.value)
    assert f"line 3, mode_b: the mode {visible} looks like '{first}' (line 2)" in message
    assert message.isprintable()


def test_a_letter_with_a_mark_is_one_name_however_it_is_encoded(tmp_path):
    apart = unicodedata.normalize("NFD", "Dämpf")
    with pytest.raises(InputError) as raised:
        read(tmp_path, f"{HEADER}\np,Q,Dämpf,M2,A>B,1\np,Q,{apart},M2,A>B,2\n")
    assert r"the mode 'Da\u0308mpf' looks like 'Dämpf' (line 2)" in str(raised.value)


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ("p,Q ,M1,M2,A>B,2", "question"),
        ("p ,Q,M1,M2,A>B,2", "participant"),
        ("p,Q,M1,M2,A>B,1 ", "comparison"),
    ],
)
def test_questions_people_and_comparisons_that_look_alike_are_refused(tmp_path, row, what):
    with pytest.raises(InputError, match=f"line 3, {what}: the {what} "):
        read(tmp_path, f"{HEADER}\np,Q,M1,M2,A>B,1\n{row}\n")


def test_people_who_differ_by_capital_letters_are_two_and_a_note_says_so(tmp_path):
    table = read(tmp_path, f"{HEADER}\naB3,Q,M1,M2,A>B,1\nAb3,Q,M1,M2,A>B,1\n")
    assert table.rows["participant"].nunique() == 2
    assert "'aB3', 'Ab3'" in table.notes[0]


def test_a_name_that_looks_like_one_of_the_study_is_told_from_it(tmp_path, study):
    with pytest.raises(InputError) as raised:
        read(tmp_path, f"{HEADER}\np,Q1,M1\u00a0,M2,A>B,1\n", study)
    assert r"'M1\xa0' is not one of: M1, M2, M3 (it looks like 'M1' and is spelled otherwise)" in str(
        raised.value
    )


def test_a_column_whose_name_has_blanks_around_it_is_read_and_said(tmp_path):
    table = read(tmp_path, " Participant,mode_a, mode_b,\u200bresponse,Weather\np1,M1,M2,A>B,dry\n")
    assert table.has_participants
    assert table.rows["Weather"].tolist() == ["dry"]
    assert table.notes == (
        r"Column names were read without blanks and capital letters: ' Participant' as participant, "
        r"' mode_b' as mode_b, '\u200bresponse' as response.",
    )


@given(st.text(max_size=80))
def test_a_quoted_name_is_one_visible_line(text):
    shown = quoted(text)
    assert shown.isprintable()
    assert len(shown) <= 12 * 60 + 2


@given(st.text(st.characters(codec="utf-8"), min_size=1, max_size=12))
def test_names_that_differ_only_where_nobody_sees_it_look_alike(text):
    hidden = f"\u00a0{unicodedata.normalize('NFD', text)}\u200b "
    assert folded(hidden) == folded(text)
    if hidden != text:
        (pair,) = look_alikes([text, hidden])
        assert quoted(pair.earlier) != quoted(pair.later)


def test_a_plain_name_is_printed_as_it_is():
    assert plain_or_quoted("mode_a") == "mode_a"
    assert plain_or_quoted(" mode_a") == "' mode_a'"
