"""One rule for keys: a comparison has one answer to a question, whoever reads the file."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from data.errors import InputError
from data.response_csv import read_response_csv

HEADER = "participant,question,mode_a,mode_b,response,comparison"


def write(folder: Path, rows: list[str], header: str = HEADER) -> Path:
    path = folder / "answers.csv"
    path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    return path


def error_of(path: Path) -> str:
    with pytest.raises(InputError) as raised:
        read_response_csv(path)
    assert "\n" not in str(raised.value)
    return str(raised.value)


def test_a_repeated_row_counts_once_and_a_note_names_its_line(tmp_path):
    rows = ["p,Q1,M1,M2,A>B,c1", "p,Q2,M1,M2,B>A,c1", "p,Q1,M1,M2,A>B,c1", "q,Q1,M1,M2,A>B,c1"]
    table = read_response_csv(write(tmp_path, rows))
    assert table.rows[["participant", "question"]].values.tolist() == [["p", "Q1"], ["p", "Q2"], ["q", "Q1"]]
    (note,) = table.notes
    assert note.startswith("1 row (line 4) repeats an earlier row's answer")


def test_rows_without_a_comparison_have_no_key(tmp_path):
    table = read_response_csv(write(tmp_path, ["p,Q1,M1,M2,A>B,", "p,Q1,M1,M2,A>B,", "p,Q1,M1,M2,B>A,"]))
    assert len(table.rows) == 3
    assert table.notes == ()


@pytest.mark.parametrize(
    ("header", "rows", "message"),
    [
        (HEADER, ["p,Q1,M1,M2,A>B,c1", "p,Q1,M1,M2,A=B,c1"], "line 3, response: comparison 'c1' of"),
        (HEADER, ["p,Q1,M1,M2,A>B,c1", "p,Q1,M3,M2,A>B,c1"], "line 3, mode_a: comparison 'c1' of"),
        (HEADER, ["p,Q1,M1,M2,A>B,c1", "p,Q2,M1,M3,A>B,c1"], "has 'M2' in line 2, but 'M3' here"),
        # What was shown as A is a part of the answer: the side effect is estimated from it.
        (HEADER, ["p,Q1,M1,M2,A>B,c1", "p,Q1,M2,M1,B>A,c1"], "has 'M1' in line 2, but 'M2' here"),
        (
            f"{HEADER},check",
            ["p,Q1,M1,M2,A>B,c1,true", "p,Q1,M1,M2,A>B,c1,", "p,Q1,M1,M2,A>B,c2,"],
            "line 3, check",
        ),
        (f"{HEADER},repetition", ["p,Q1,M1,M2,A>B,c1,1", "p,Q2,M1,M2,A>B,c1,2"], "line 3, repetition"),
        (
            f"{HEADER},count",
            ["p,Q1,M1,M2,A>B,c1,2"],
            "line 2, count: comparison 'c1' of participant 'p' has one",
        ),
        (f"{HEADER},source", ["p,Q1,M1,M2,A>B,c1,human", "p,Q1,M1,M2,A>B,c2,simulated"], "line 3, source"),
        (
            "question,mode_a,mode_b,response,comparison",
            ["Q1,M1,M2,A>B,c1", "Q1,M1,M2,B>A,c1"],
            "a column participant tells people's comparisons apart",
        ),
    ],
)
def test_rows_that_contradict_each_other_are_refused_with_both_lines(tmp_path, header, rows, message):
    assert message in error_of(write(tmp_path, rows, header))


def test_unknown_peoples_comparisons_and_simulated_ones_are_apart(tmp_path):
    rows = ["Q1,M1,M2,A>B,c1,human", "Q1,M1,M2,B>A,c1,simulated", "Q1,M1,M2,A>B,c1,"]
    table = read_response_csv(write(tmp_path, rows, "question,mode_a,mode_b,response,comparison,source"))
    assert table.rows["response"].tolist() == ["A>B", "B>A"]


NAMED = st.tuples(
    st.sampled_from(["p", "q"]),
    st.sampled_from(["Q1", "Q2"]),
    st.sampled_from(["M1,M2", "M2,M1", "M1,M3"]),
    st.sampled_from(["A>B", "A=B", "B>A"]),
    st.sampled_from(["c1", "c2", "c3", ""]),
)


@given(st.lists(NAMED, min_size=1, max_size=14))
@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_file_is_refused_exactly_if_two_rows_of_a_comparison_contradict_each_other(tmp_path, rows):
    sides: dict[tuple[str, str], set[str]] = {}
    answers: dict[tuple[str, str, str], set[str]] = {}
    for person, question, pair, answer, comparison in rows:
        if comparison:
            sides.setdefault((person, comparison), set()).add(pair)
            answers.setdefault((person, comparison, question), set()).add(answer)
    path = write(tmp_path, [",".join(row) for row in rows])
    if any(len(values) > 1 for values in (*sides.values(), *answers.values())):
        error_of(path)
        return
    table = read_response_csv(path)
    assert len(table.rows) == len(answers) + sum(row[4] == "" for row in rows)
    assert bool(table.notes) == (len(table.rows) < len(rows))


def test_a_count_of_0_says_nothing_but_that_the_answer_was_possible(tmp_path):
    header = "question,mode_a,mode_b,response,count"
    rows = ["Q1,M1,M2,A>B,3", "Q1,M1,M2,B>A,2", "Q1,M1,M2,A=B,0", "Q1,M1,M4,A>B,0", "Q9,M1,M2,A>B,0"]
    table = read_response_csv(write(tmp_path, rows, header))
    assert table.rows["count"].tolist() == [3, 2]
    assert table.modes == ("M1", "M2")
    assert [(q.name, q.levels) for q in table.questions] == [("Q1", 3)]
    assert table.notes == (
        "The mode 'M4' is named only in rows with the count 0, and is left out.",
        "The question 'Q9' is named only in rows with the count 0, and is left out.",
    )


def test_a_count_of_0_has_no_key(tmp_path):
    rows = ["p,Q1,M1,M2,A>B,c1,1", "p,Q1,M1,M2,B>A,c1,0"]
    assert len(read_response_csv(write(tmp_path, rows, f"{HEADER},count")).rows) == 1


def test_without_a_study_a_question_has_the_modes_of_its_rows(tmp_path):
    rows = ["p,Q1,M1,M2,A>B,", "p,Q2,M4,M3,A>B,", "p,Q2,M1,M3,A>B,", "p,Q3,M1,M2,A>B,", "p,Q3,M4,M3,A>B,"]
    table = read_response_csv(write(tmp_path, rows))
    assert {q.name: table.modes_of(q) for q in table.questions} == {
        "Q1": ("M1", "M2"),
        "Q2": ("M1", "M4", "M3"),
        "Q3": ("M1", "M2", "M4", "M3"),
    }
