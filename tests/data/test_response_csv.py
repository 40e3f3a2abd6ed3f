"""The response CSV: every good file is read exactly, every bad one is one line that says where."""

import csv
import io
import random
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from data import csv_file
from data.answers import ANSWERS, SCALES, inferred_levels
from data.errors import InputError
from data.labels import look_alikes, without_the_invisible
from data.response_csv import read_response_csv

HEADER = "mode_a,mode_b,response"
in_a_folder = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def write(path: Path, content: str | bytes) -> Path:
    file = path / "answers.csv"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    return file


def error_of(path: Path, study=None) -> str:
    with pytest.raises(InputError) as raised:
        read_response_csv(path, study)
    said = str(raised.value)
    assert "\n" not in said
    assert said.startswith(str(path))
    return said[len(str(path)) + 2 :]


def outcome(path: Path) -> tuple[int, str]:
    """How many rows a file has, or the one line that says what is wrong with it."""
    try:
        rows = read_response_csv(path).rows
    except InputError as error:
        said = str(error)
    else:
        assert set(rows["response"]) <= set(ANSWERS)
        return len(rows), ""
    assert "\n" not in said
    return 0, said


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "the file is empty"),
        (b"\xef\xbb\xbf\r\n", "the file is empty"),
        (HEADER, "line 1: a header without rows"),
        (f"{HEADER}\n\n\n", "line 1: a header without rows"),
        ("mode_a,mode_b\nM1,M2\n", "line 1: the column response is missing; found: mode_a, mode_b"),
        ("mode_a;mode_b;response\nM1;M2;A>B\n", "separated by commas, not by ';'"),
        (
            "mode_a,modeb,response\nM1,M2,A>B\n",
            "the column mode_b is missing; found: mode_a, modeb, response",
        ),
        ("mode_a,mode\u00a0b,response\nM1,M2,A>B\n", r"found: mode_a, 'mode\xa0b', response"),
        (f"{HEADER},Mode_A\nM1,M2,A>B,M1\n", "the column mode_a is there twice, as 'mode_a' and 'Mode_A'"),
        (f"{HEADER},count\nM1,M2,A>B,0\nM1,M2,B>A,0\n", "every count is 0: there are no responses to rank"),
        (f"{HEADER},mode_a\nM1,M2,A>B,M1\n", "line 1: the column mode_a is there twice"),
        (f"{HEADER}\nM1,M2\n", "line 2: 2 cells, but the header has 3 columns"),
        (f"{HEADER}\nM1,M2,A>B\nM1,M2,A>B,\n", "line 3: 4 cells, but the header has 3 columns"),
        (f"{HEADER}\nM1,M2,A>B\nM1\n", "line 3: 1 cell, but the header has 3 columns"),
        (f"{HEADER}\nM1,M2,A>C\n", "line 2, response: 'A>C' is not one of: A>>>>B, A>>>B, A>>B, A>B"),
        (f"{HEADER}\nM1,M2,a>b\n", "line 2, response: 'a>b' is not one of"),
        (f"{HEADER}\nM1,M2, A>B\n", "line 2, response: ' A>B' is not one of"),
        (f"{HEADER}\nM1,M2,\n", "line 2, response: empty, but a value is needed"),
        (f"{HEADER}\n,M2,A>B\n", "line 2, mode_a: empty, but a value is needed"),
        (f"{HEADER}\nM1,M2,A>B\n\n\nM2,M2,A>B\n", "line 5, mode_b: 'M2' against itself"),
        (f'{HEADER}\n"M\n\n1",M2,A>B\nM2,M2,A>B\n', "line 5, mode_b: 'M2' against itself"),
        (f"{HEADER}\rM1,M2,A>B\rM1,M2,B\r", "line 3, response: 'B' is not one of"),
        (f"{HEADER}\r\nM1,M2,A>B\r\nM1,M2,B\r\n", "line 3, response: 'B' is not one of"),
        (f'{HEADER}\n"M1,M2,A>B\nM1,M2,A>B\n', "line 2: not valid CSV"),
        (f'{HEADER}\n"M1"x,M2,A>B\n', "line 2: not valid CSV"),
        (f"{HEADER}\nM1,{'x' * 200_000},A>B\n", "line 2: not valid CSV"),
        (f"{HEADER}\nM1,M2,A>B\nM\0,M2,A>B\n", "line 3: not text: a NUL byte"),
        (f"{HEADER}\nM1,M2,A>B\n".encode() + b"M\xe9,M2,A>B\n", "line 3: not UTF-8 text"),
        (f"{HEADER}\nM1,M2,A>B\n".encode("utf-16"), "line 1: not UTF-8 text"),
        (f"{HEADER},participant\nM1,M2,A>B,\n", "line 2, participant: empty"),
        (f"{HEADER},question\nM1,M2,A>B,\n", "line 2, question: empty"),
        (f"{HEADER},participant\nM1,M2,A>B,\u200b\n", "line 2, participant: empty"),
        (f"{HEADER},comparison\nM1,M2,A>B,\u00a0\n", r"line 2, comparison: '\xa0' has nothing to see in it"),
        (f"{HEADER},source\nM1,M2,A>B,robot\n", "line 2, source: 'robot' is not one of: human, simulated"),
        (f"{HEADER},check\nM1,M2,A>B,perhaps\n", "line 2, check: 'perhaps' is not one of: true, false"),
        (f"{HEADER},repetition\nM1,M2,A>B,-1\n", "line 2, repetition: '-1'"),
        (f"{HEADER},check\nM1,M1,A>B,true\n", "all rows are attention checks"),
    ],
)
def test_a_bad_file_is_one_line_that_says_where(tmp_path, content, message):
    assert message in error_of(write(tmp_path, content))


@pytest.mark.parametrize(
    "count", ["-1", "1.0", "1.5", "1e3", "+1", "", " 1", "x", "nan", "٣", "1_000", "9" * 19, "9" * 300]
)
def test_a_count_that_is_not_a_whole_number_of_at_least_0_is_refused(tmp_path, count):
    assert "line 3, count: " in error_of(write(tmp_path, f"{HEADER},count\nM1,M2,A>B,2\nM1,M2,A>B,{count}\n"))


def test_counts_that_cannot_be_summed_exactly_are_refused(tmp_path):
    path = write(tmp_path, f"{HEADER},count\nM1,M2,A>B,{2**53}\nM1,M2,B>A,1\n")
    assert "in all is more than" in error_of(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (f"{HEADER}\nM1,M2,A>B\n", "the column question is missing, and the study has 6 questions: Q1, Q2"),
        (f"{HEADER},question\nM1,M2,A>B,Q7\n", "line 2, question: 'Q7' is not one of: Q1, Q2"),
        (f"{HEADER},question\nM1,M4,A>B,Q1\n", "line 2, mode_b: 'M4' is not one of: M1, M2, M3"),
        (
            f"{HEADER},question\nM1,M2,A>>B,Q1\nM1,M2,A>>B,Q4\n",
            "line 3, response: 'A>>B' is not on the scale of Q4 (3 levels): A>B, A=B, B>A",
        ),
    ],
)
def test_what_is_not_of_the_study_is_refused(tmp_path, study, content, message):
    assert message in error_of(write(tmp_path, content), study)


@pytest.mark.parametrize("place", ["missing.csv", ".", "no/folder.csv"])
def test_a_file_that_cannot_be_read_is_one_line(tmp_path, place):
    assert error_of(tmp_path / place)


def test_a_device_is_no_file():
    assert "is a device" in error_of(Path("/dev/zero"))


def test_left_out_columns_are_filled_and_others_kept(tmp_path):
    table = read_response_csv(write(tmp_path, f"{HEADER},weather\nM2,M1,A>B,=rain()\n"))
    assert table.rows.to_dict("records") == [
        {
            "participant": "",
            "question": "preference",
            "mode_a": "M2",
            "mode_b": "M1",
            "response": "A>B",
            "count": 1,
            "comparison": "",
            "repetition": 0,
            "source": "human",
            "check": False,
            "weather": "=rain()",
        }
    ]
    assert (table.has_participants, table.is_simulated, table.title) == (False, False, "answers")
    types = table.rows.dtypes.astype(str).to_dict()
    assert (types["count"], types["repetition"], types["check"]) == ("int64", "int64", "bool")


def test_modes_stand_in_order_of_first_appearance_and_checks_bring_none(tmp_path):
    rows = "Z,Z,A=B,true\nC,A,A>B,false\nB,C,A>B,False\nD,A,A>B,0\n"
    assert read_response_csv(write(tmp_path, f"{HEADER},check\n{rows}")).modes == ("C", "A", "B", "D")


def test_a_mode_of_the_study_that_no_row_names_is_listed(tmp_path, study):
    table = read_response_csv(write(tmp_path, f"{HEADER},question\nM3,M1,A>B,Q2\n"), study)
    assert table.modes == ("M1", "M2", "M3")
    assert [(q.name, q.levels, q.levels_inferred) for q in table.questions] == [("Q2", 5, False)]


@pytest.mark.parametrize(
    ("answers", "levels"), [("A>B B>A", 2), ("A>B A=B", 3), ("A>B B>>A", 5), ("A=B A>>B", 5)]
)
def test_levels_are_inferred_from_the_answers(tmp_path, answers, levels):
    rows = "".join(f"M1,M2,{answer}\n" for answer in answers.split())
    scale = read_response_csv(write(tmp_path, f"{HEADER}\n{rows}")).questions[0]
    assert (scale.levels, scale.levels_inferred) == (levels, True)


def test_a_byte_order_mark_and_windows_line_ends_change_nothing(tmp_path):
    text = f"{HEADER},participant\nM1,M2,A>B,p\nM2,M1,A=B,q\n"
    plain = read_response_csv(write(tmp_path, text)).rows
    windows = read_response_csv(write(tmp_path, b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())).rows
    pd.testing.assert_frame_equal(plain, windows)


names = st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=8).filter(
    without_the_invisible
)
odd_names = st.one_of(
    names, st.sampled_from(['a,"b"', "two\nlines", "שלום", "مرحبا", "'", "=1+1", "M 1", "Ł"])
)


def no_look_alikes(rows):
    """Names that a reader takes for one are refused; `test_response_names.py` is about them."""
    modes, people = {name for row in rows for name in row[:2]}, {row[3] for row in rows}
    return not look_alikes(modes) and not look_alikes(people, case_counts=True)


rows = st.lists(
    st.tuples(odd_names, odd_names, st.sampled_from(ANSWERS), odd_names, st.integers(1, 10**6)).filter(
        lambda row: row[0] != row[1]
    ),
    min_size=1,
    max_size=20,
).filter(no_look_alikes)


@given(rows=rows, terminator=st.sampled_from(["\n", "\r\n"]), bom=st.booleans())
@in_a_folder
def test_any_file_written_by_a_csv_writer_is_read_back_exactly(tmp_path, rows, terminator, bom):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator=terminator)
    writer.writerow(["mode_a", "mode_b", "response", "participant", "count"])
    writer.writerows(rows)
    content = (b"\xef\xbb\xbf" if bom else b"") + text.getvalue().encode()
    table = read_response_csv(write(tmp_path, content))
    columns = ["mode_a", "mode_b", "response", "participant", "count"]
    assert list(table.rows[columns].itertuples(index=False, name=None)) == rows


@given(
    content=st.binary(max_size=200)
    | st.text(alphabet=f'{HEADER},\n\r"AB>=1\0é', max_size=120).map(str.encode)
)
@in_a_folder
def test_no_file_whatsoever_is_a_traceback(tmp_path, content):
    rows, said = outcome(write(tmp_path, f"{HEADER}\n".encode() + content))
    assert rows or said


@given(
    damage=st.sampled_from(["cut", "add", "nul", "quote", "swap"]),
    at=st.integers(0, 400),
    seed=st.integers(0, 9),
)
@in_a_folder
def test_a_damaged_file_is_read_or_refused_in_one_line(tmp_path, damage, at, seed):
    draw = random.Random(seed)
    lines = [f"{HEADER},participant,count"]
    lines += [f"M1,M2,{draw.choice(ANSWERS)},p{k % 3},{k + 1}" for k in range(20)]
    content = bytearray("\n".join(lines).encode())
    at %= len(content)
    match damage:
        case "cut":
            del content[at : at + 7]
        case "add":
            content[at:at] = b",x"
        case "nul":
            content[at] = 0
        case "quote":
            content[at:at] = b'"'
        case "swap":
            content[at] = 0xE9
    path = write(tmp_path, bytes(content))
    if damage in ("nul", "swap"):
        assert error_of(path)
        return
    rows, said = outcome(path)
    assert rows or said


def test_the_fast_reader_and_the_careful_one_agree(tmp_path, monkeypatch):
    rng = np.random.default_rng(7)
    modes, people = ["M1", "M2", "Ähm"], [f"p{k}" for k in range(90)]
    lines = [f"{HEADER},participant,count,note"]
    for _ in range(3000):
        a, b = rng.permutation(modes)[:2]
        note = rng.choice(["", "NA", "null", "x y"])
        lines.append(f"{a},{b},{rng.choice(ANSWERS)},{rng.choice(people)},{rng.integers(1, 9)},{note}")
    for end in ("\n", "\r\n"):
        path = write(tmp_path, (end.join(lines) + end + end).encode())
        careful = read_response_csv(path)
        monkeypatch.setattr(csv_file, "LARGE", 1)
        fast = read_response_csv(path)
        monkeypatch.undo()
        pd.testing.assert_frame_equal(careful.rows, fast.rows)
        assert careful.modes == fast.modes


@pytest.mark.parametrize("large", [1, 10**9])
def test_a_file_of_many_blocks_keeps_its_order_and_names_its_first_error(tmp_path, monkeypatch, large):
    rng = np.random.default_rng(3)
    people = [f"participant number {k}" for k in rng.integers(0, 5000, 120_000)]
    lines = [f"{HEADER},participant", *(f"M{k % 7},N,A>B,{who}" for k, who in enumerate(people))]
    monkeypatch.setattr(csv_file, "LARGE", large)
    table = read_response_csv(write(tmp_path, "\n".join(lines)))
    assert table.rows["participant"].tolist() == people
    assert table.modes == ("M0", "N", "M1", "M2", "M3", "M4", "M5", "M6")
    lines[90_001], lines[70_001], lines[110_001] = "M1,N,late,p", "M1,N,early,p", "M1,N,early,p"
    assert error_of(write(tmp_path, "\n".join(lines))).startswith("line 70002, response: 'early'")


@pytest.mark.parametrize(
    "bad", ["M1,M2,A>B", "M1,M2,A>B,p,1,x,y", "M1,M1,A>B,p,1,x", "M1,M2,?,p,1,x", ",M2,A>B,p,1,x"]
)
def test_the_fast_reader_reports_the_same_errors(tmp_path, monkeypatch, bad):
    lines = [f"{HEADER},participant,count,note", *["M1,M2,A>B,p,1,x"] * 500]
    lines[333] = bad
    path = write(tmp_path, "\n".join(lines))
    careful = error_of(path)
    monkeypatch.setattr(csv_file, "LARGE", 1)
    assert error_of(path) == careful
    assert careful.startswith("line 334")


@pytest.mark.parametrize(
    ("answers", "levels"),
    [
        ({"A>B", "B>A"}, 2),
        ({"A>B"}, 2),
        ({"A=B"}, 3),
        ({"A>B", "A=B"}, 3),
        ({"A>>B", "B>A"}, 5),
        ({"A>>>B"}, 7),
        ({"B>>>>A", "A>B"}, 9),
    ],
)
def test_the_longest_arrow_says_how_many_levels_a_scale_has(answers: set[str], levels: int) -> None:
    assert inferred_levels(answers) == levels


def test_a_scale_with_an_even_number_of_levels_has_no_middle() -> None:
    assert SCALES[4] == ("A>>B", "A>B", "B>A", "B>>A")
    assert all(len(scale) == levels for levels, scale in SCALES.items())
