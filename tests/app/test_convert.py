"""`elbowroom convert`: nothing is guessed, nothing half written, and what it writes can be reported."""

import csv
import json
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from analysis.report.cautions import unknown_sides
from app.cli.main import run
from data.answers import ANSWERS, SCALES
from data.response_csv import read_response_csv

FORMS = Path(__file__).resolve().parents[1] / "reference" / "forms"
TABLE = ["--from", "table", "--participant", "who", "--left", "l", "--right", "r", "--answer", "answer"]
WORDS = ["--word", "x=A", "--word", "y=B", "--word", "z=equal"]


def convert(path: Path, *options: str, out: str = "out.csv") -> int:
    return run(["convert", str(path), *options, "--out", str(path.parent / out)])


def table(folder: Path, *rows: str, name: str = "in.csv") -> Path:
    path = folder / name
    path.write_text("\n".join(["who,l,r,answer", *rows, ""]), encoding="utf-8")
    return path


def responses(path: Path, name: str = "out.csv") -> list[tuple[str, ...]]:
    with (path.parent / name).open(newline="", encoding="utf-8") as file:
        columns = ("participant", "mode_a", "mode_b", "response")
        return [tuple(row[column] for column in columns) for row in csv.DictReader(file)]


def test_text_that_looks_like_something_else_stays_text(tmp_path: Path) -> None:
    path = table(tmp_path, "12,+,=quick,x", "None,007,7,y", "p,None,NaN,z", '"a, ""b""",=1+1,1e5,x')
    assert convert(path, *TABLE, *WORDS) == 0
    assert responses(path) == [
        ("12", "+", "=quick", "A>B"),
        ("None", "007", "7", "B>A"),
        ("p", "None", "NaN", "A=B"),
        ('a, "b"', "=1+1", "1e5", "A>B"),
    ]


@given(
    rows=st.lists(
        st.tuples(st.sampled_from(["p 1", "é", "3"]), st.sampled_from(["x", "y", "z"])),
        min_size=1,
        max_size=8,
    ),
    separator=st.sampled_from(",;\t"),
    end=st.sampled_from(["\n", "\r\n", "\r\r\n"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
    quoting=st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL]),
)
@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_file_gives_the_same_answers_in_every_dialect(
    tmp_path: Path, rows: list[tuple[str, str]], separator: str, end: str, encoding: str, quoting: int
) -> None:
    path = tmp_path / "dialect.csv"
    with path.open("w", newline="", encoding=encoding) as file:
        writer = csv.writer(file, delimiter=separator, lineterminator=end, quoting=quoting)  # type: ignore[arg-type]
        writer.writerow(["who", "l", "r", "answer"])
        writer.writerows((who, "M1", "M2", word) for who, word in rows)
    assert convert(path, *TABLE, "--word", "x=A", "--word", "y=B>>A", "--word", "z=A=B") == 0
    answers = {"x": "A>B", "y": "B>>A", "z": "A=B"}
    assert responses(path) == [(who, "M1", "M2", answers[word]) for who, word in rows]


@pytest.mark.parametrize("levels", SCALES)
@pytest.mark.parametrize("positive", ["A", "B"])
def test_a_number_is_the_answer_of_its_distance_from_0(tmp_path: Path, levels: int, positive: str) -> None:
    half = levels // 2
    numbers = [number for number in range(-half, half + 1) if number or levels % 2]
    path = table(tmp_path, *(f"p,M1,M2,{number}" for number in numbers))
    assert convert(path, *TABLE, "--levels", str(levels), "--positive", positive) == 0
    answers = [answer for _, _, _, answer in responses(path)]
    assert answers == list(SCALES[levels] if positive == "B" else reversed(SCALES[levels]))
    assert set(answers) <= set(ANSWERS)


@pytest.mark.parametrize("number", ["1,000", "4", "0.5", "-4"])
def test_a_number_that_is_not_a_level_is_refused(
    tmp_path: Path, number: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, f'p,M1,M2,"{number}"')
    assert convert(path, *TABLE, "--levels", "7", "--positive", "B") == 2
    assert f"line 2, answer: '{number}' is not one of the 7 levels -3 to 3" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("rows", "options", "message"),
    [
        (["p,M1,M1,x"], [], "line 2, answer: 'M1' against itself"),
        (["p,M1,,x"], [], "line 2, r: empty, but a mode is needed"),
        ([",M1,M2,x"], [], "line 2, who: empty, but the person who answered is needed"),
        (["p,M1,M2,"], [], "no row counts: no answer: 1 in answer: left empty; line 2"),
        (["p,M1,M2,x,5"], [], "line 2: 5 cells, but the header has 4 columns"),
        (["p,M1,M2,v"], [], "answer: v: nothing says what these mean"),
        (["p,M1,M2,x"], ["--only", "l=M9"], "l: no row is M9; values: M1"),
        (["p,M1,M2,x"], ["--only", "lft=M1"], "the column lft is missing; columns: who, l, r, answer"),
        (["p,M1,M2,x"], ["--word", "v=better"], "'better' is not one of: A, B, equal, none"),
        (["p,M1,M2,x"], ["--word", "better"], "--word: 'better' is not TEXT=ANSWER"),
        (["p,M1,M2,x"], ["--word", "x=B"], "--word: 'x' is told twice: 'A' and 'B'"),
        (["p,M1,M2,x"], ["--pair", "answer=M1"], "--pair: answer=M1 does not have two parts"),
        (["p,M1,M2,x"], ["--leave-out", "all"], "--leave-out: 'all' is neither a line"),
        (["p,M1,M2,x"], ["--keep", "line"], "the column line is missing"),
        (["p,M1,M2,x"], ["--positive", "C"], "'C' is not one of 'A', 'B'"),
        (["p,M1,M2,x"], ["--winner", "both"], "'both' is not one of 'rows', 'columns'"),
        (["p,M1,M2,x"], ["--positive", "A"], "--positive: needs --levels"),
        (["p,M1,M2,x"], ["--ranking", "l,r"], "does not say whether the cells of l,r are modes or ranks"),
        (["p,M1,M2,x"], ["--answer", "a*"], "no column is named a* with a whole number for *"),
    ],
)
def test_what_is_wrong_is_one_line_and_nothing_is_written(
    tmp_path: Path, rows: list[str], options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, *rows)
    earlier = tmp_path / "out.csv"
    earlier.write_text("earlier", encoding="utf-8")
    assert convert(path, *TABLE, *WORDS, *options) == 2
    printed = capsys.readouterr()
    assert message in printed.err
    assert printed.err.count("\n") == 1
    assert printed.out == ""
    assert earlier.read_text(encoding="utf-8") == "earlier"
    assert {file.name for file in tmp_path.iterdir()} == {"in.csv", "out.csv"}


def test_the_file_itself_is_never_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    before = path.read_bytes()
    assert convert(path, *TABLE, *WORDS, out="in.csv") == 2
    assert "is a file to be read" in capsys.readouterr().err
    assert path.read_bytes() == before


def test_rows_that_another_file_has_are_not_counted_twice_in_silence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = table(tmp_path, "p,M1,M2,x", "p,M1,M2,x", name="monday.csv")
    second = table(tmp_path, "p,M1,M2,x", "q,M1,M2,y", name="friday.csv")
    command = ["convert", str(first), str(second), *TABLE, *WORDS, "--out", str(tmp_path / "out.csv")]
    assert run(command) == 2
    assert "friday.csv: line 2: repeats " in capsys.readouterr().err
    assert run([*command, "--leave-out", "repeated"]) == 0
    assert len(responses(first)) == 3
    assert "left out: 1 row with 1 answer: repeated" in capsys.readouterr().out


def test_a_line_is_left_out_if_asked_in_its_own_file_alone(tmp_path: Path) -> None:
    first = table(tmp_path, "p,M1,M2,x", name="1.csv")
    second = table(tmp_path, "q,M1,M2,y", name="2.csv")
    command = ["convert", str(first), str(second), *TABLE, *WORDS, "--out", str(tmp_path / "out.csv")]
    assert run([*command, "--leave-out", "1.csv:2"]) == 0
    assert responses(first) == [("q", "M1", "M2", "B>A")]


def test_one_answer_twice_to_the_same_comparison_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "wide.csv"
    path.write_text("who,pair1,pair2\np,x,y\np,y,y\n", encoding="utf-8")
    options = ["--from", "table", "--participant", "who", "--answer", "pair*", "--pair", "1=M1,M2", *WORDS]
    assert convert(path, *options, "--pair", "2=M2,M3") == 2
    assert "line 3: p answered preference of 1 already" in capsys.readouterr().err
    assert convert(path, *options, "--pair", "2=M2,M3", "--leave-out", "3") == 0
    assert responses(path) == [("p", "M1", "M2", "A>B"), ("p", "M2", "M3", "B>A")]


def test_names_from_the_file_cannot_control_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,\x1b[2J", "q,M1,M2,x")
    assert convert(path, *TABLE, *WORDS, "--word", "\x1b[2J=A") == 0
    assert "\x1b" not in capsys.readouterr().out


def test_where_a_side_is_told_by_a_column_modes_and_answers_change_with_it(tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    options = ["--from", "no-more-marking", "--order", "isLeft=TRUE,FALSE", "--leave-out", "7"]
    assert run(["convert", str(FORMS / "no_more_marking_decisions.csv"), *options, "--out", str(out)]) == 0
    with out.open(newline="", encoding="utf-8") as file:
        rows = [
            tuple(row[c] for c in ("mode_a", "mode_b", "response", "sides")) for row in csv.DictReader(file)
        ]
    assert rows == [
        ("K7QX2V", "MRQ46D", "A>B", "known"),
        ("ZXP1X6", "MRQ46D", "B>A", "known"),
        ("K7QX2V", "ZXP1X6", "A>B", "unknown"),
        ("K7QX2V", "MRQ46D", "B>A", "known"),
    ]


def test_where_beaqlejs_wrote_the_file_the_answer_changes_with_the_order(tmp_path: Path) -> None:
    pairs = ["--pair", "m1_m2=M1,M2", "--pair", "m2_m3=M2,M3", "--pair", "m3_m1=M3,M1"]
    answers = {}
    for meaning in ("button", "item"):
        out = tmp_path / f"{meaning}.csv"
        options = ["--from", "beaqlejs", *pairs, "--answer-is", meaning]
        assert run(["convert", str(FORMS / "beaqlejs_listener_1.txt"), *options, "--out", str(out)]) == 0
        answers[meaning] = responses(out, out.name)
    assert answers["button"] == [
        ("L1", "M1", "M2", "A>B"),
        ("L1", "M3", "M2", "A>B"),
        ("L1", "M1", "M3", "B>A"),
    ]
    assert answers["item"] == [
        ("L1", "M1", "M2", "A>B"),
        ("L1", "M3", "M2", "B>A"),
        ("L1", "M1", "M3", "A>B"),
    ]


def test_the_choice_question_beside_a_surveymonkey_ranking(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.csv"
    options = ["--from", "surveymonkey", "--answer", "#13=safer", "--pair", "safer=M1,M2"]
    words = ["--word", "M1=A", "--word", "M2=B"]
    assert run(["convert", str(FORMS / "surveymonkey_ranking.csv"), *options, *words, "--out", str(out)]) == 0
    assert responses(out) == [("118000000001", "M1", "M2", "A>B"), ("118000000004", "M1", "M2", "B>A")]
    assert 'no answer: 1 in #13: "other"; line 5 (118000000002)' in capsys.readouterr().out


def test_a_matrix_is_turned_over_by_who_won(tmp_path: Path) -> None:
    answers = {}
    for winner in ("rows", "columns"):
        out = tmp_path / f"{winner}.csv"
        options = ["--from", "matrix-counts", "--winner", winner, "--out", str(out)]
        assert run(["convert", str(FORMS / "matrix_counts.csv"), *options]) == 0
        with out.open(newline="", encoding="utf-8") as file:
            answers[winner] = [(row["response"], row["count"]) for row in csv.DictReader(file)]
    counts = ["7", "11", "6", "8", "2", "5"]
    assert answers == {
        "rows": [("A>B", count) for count in counts],
        "columns": [("B>A", count) for count in counts],
    }


def test_a_gorilla_file_without_its_last_line_is_said_to_be_cut_off(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "cut.csv"
    whole = (FORMS / "gorilla_task_builder_1.csv").read_bytes()
    path.write_bytes(whole.replace(b"END OF FILE\n", b""))
    options = ["--left", "left_video", "--right", "right_video", "--word", "Left=A", "--word", "Right=B"]
    assert convert(path, "--from", "gorilla", *options, "--only", "display=trial") == 0
    assert "the last line is not END OF FILE: the file is cut off" in capsys.readouterr().out


def test_a_url_parameter_of_a_jatos_archive_names_the_participant(tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    options = [
        "--participant",
        "@url.PROLIFIC_PID",
        "--left",
        "left",
        "--right",
        "right",
        "--only",
        "task=pair",
    ]
    words = ["--word", "0=A", "--word", "1=B", "--word", "2=equal"]
    archive = FORMS / "jatos_results.jrzip"
    assert run(["convert", str(archive), "--from", "jatos", *options, *words, "--out", str(out)]) == 0
    assert [who for who, *_ in responses(out)] == ["pid-a", "pid-a", "pid-a", "pid-b", "pid-b"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('form = "table"\nparticipnt = "who"', "participnt: unknown key (did you mean participant?)"),
        ('form = "table"\n[[answers]]\ncolum = "x"', "answers.1.colum: unknown key (did you mean column?)"),
        ('form = "table"\n[words]\nx = "better"', "words.x: 'better' is not one of: A, B, equal, none"),
        ('form = "tabel"', "'tabel' is not one of: look, "),
        ("form = ", "not valid TOML"),
        ('participant = "who"', "say the form of the file by --from FORM"),
    ],
)
def test_a_wrong_map_is_one_line_with_what_is_valid(
    tmp_path: Path, text: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    wrong = tmp_path / "map.toml"
    wrong.write_text(text, encoding="utf-8")
    assert convert(path, "--map", str(wrong)) == 2
    assert message in capsys.readouterr().err


def test_a_map_of_another_form_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    (tmp_path / "map.toml").write_text('form = "table"', encoding="utf-8")
    assert convert(path, "--from", "sosci", "--map", str(tmp_path / "map.toml")) == 2
    assert "is for the form table, not for sosci" in capsys.readouterr().err


def test_the_map_says_what_no_option_does(tmp_path: Path) -> None:
    """Two questions with opposite words, a column a row, another reason for no answer."""
    path = tmp_path / "in.csv"
    path.write_text("who,l,r,better,worse\np,M1,M2,1,1\nq,M2,M1,9,2\n", encoding="utf-8")
    (tmp_path / "map.toml").write_text(
        """
form = "table"
participant = "who"
answers = [
    { column = "better", left = "l", right = "r", question = "better" },
    { column = "worse", left = "l", right = "r", question = "worse", words = { 1 = "B", 2 = "A" } },
]
words = { 1 = "A", 2 = "B", 9 = "none: did not see it" }
""",
        encoding="utf-8",
    )
    assert convert(path, "--map", str(tmp_path / "map.toml")) == 0
    assert responses(path) == [("p", "M1", "M2", "A>B"), ("p", "M1", "M2", "B>A"), ("q", "M2", "M1", "A>B")]


def test_a_converted_file_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "answers.json"
    votes = [
        {"model_a": a, "model_b": b, "winner": winner, "judge": f"j{k % 5}", "anony": True}
        for k in range(12)
        for a, b, winner in (("M1", "M2", "model_a"), ("M2", "M3", "tie"), ("M3", "M1", "model_b"))
    ]
    path.write_text(json.dumps(votes), encoding="utf-8")
    assert convert(path, "--from", "arena") == 0
    out = tmp_path / "report"
    assert (
        run(["report", "--responses", str(tmp_path / "out.csv"), "--no-side-effect", "--out", str(out)]) == 0
    )
    with (out / "worth.csv").open(newline="", encoding="utf-8") as file:
        worth = {row["mode"]: float(row["worth_mean"]) for row in csv.DictReader(file)}
    assert max(worth, key=lambda mode: worth[mode]) == "M1"
    assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["ranked"] is True


def test_an_order_column_needs_to_know_what_an_answer_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "in.csv"
    path.write_text("who,l,r,answer,flip\np,M1,M2,x,0\nq,M1,M2,x,1\n", encoding="utf-8")
    options = [*TABLE, *WORDS, "--order", "flip=0,1"]
    assert convert(path, *options) == 2
    assert "answer: x: nothing says whether these name the button or the item" in capsys.readouterr().err
    assert convert(path, *options, "--answer-is", "button") == 0
    assert responses(path) == [("p", "M1", "M2", "A>B"), ("q", "M2", "M1", "A>B")]
    assert convert(path, *options, "--answer-is", "item") == 0
    assert responses(path) == [("p", "M1", "M2", "A>B"), ("q", "M2", "M1", "B>A")]


def test_a_comma_in_the_header_of_a_file_with_semicolons_is_text(tmp_path: Path) -> None:
    path = tmp_path / "in.csv"
    path.write_text("who, really, or not;l;r;answer\np;M1;M2;x\n", encoding="utf-8")
    options = [*TABLE[:2], "--participant", "who, really, or not", *TABLE[4:], *WORDS]
    assert convert(path, *options) == 0
    assert responses(path) == [("p", "M1", "M2", "A>B")]


def test_a_named_question_takes_the_place_of_the_forms_own_column(tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    options = ["--from", "place-pulse", "--question", "nicer", "--out", str(out)]
    assert run(["convert", str(FORMS / "left_right_equal.csv"), *options]) == 0
    with out.open(newline="", encoding="utf-8") as file:
        assert {row["question"] for row in csv.DictReader(file)} == {"nicer"}


def test_words_and_pairs_that_do_not_occur_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    assert convert(path, *TABLE, *WORDS, "--pair", "pair9=M1,M2") == 0
    printed = capsys.readouterr().out
    assert "not in the responses: words y, z" in printed
    assert "not in the responses: pairs pair9" in printed
    assert "modes: M1 (1), M2 (1)" in printed


def test_a_map_keeps_what_it_takes_away_from_the_form(tmp_path: Path) -> None:
    """Votes with visible names are taken, and nobody is named, although the form has both otherwise."""
    first, second, kept = tmp_path / "first.csv", tmp_path / "second.csv", tmp_path / "kept.toml"
    (tmp_path / "map.toml").write_text('form = "arena"\nrows = []\nkeep = []\n', encoding="utf-8")
    command = ["convert", str(FORMS / "arena_battles.jsonl")]
    options = ["--map", str(tmp_path / "map.toml"), "--participant", "none", "--write-map", str(kept)]
    assert run([*command, *options, "--out", str(first)]) == 0
    assert run([*command, "--map", str(kept), "--out", str(second)]) == 0
    lines = first.read_text(encoding="utf-8").splitlines()
    assert lines[0] == "question,mode_a,mode_b,response,line"
    assert len(lines) == 1 + 6
    assert second.read_bytes() == first.read_bytes()


def test_equal_ranks_are_a_tie_and_gaps_between_ranks_say_nothing(tmp_path: Path) -> None:
    path = tmp_path / "in.csv"
    path.write_text("who,M1,M2,M3\np,2,2,7\n", encoding="utf-8")
    (tmp_path / "map.toml").write_text(
        'form = "table"\nparticipant = "who"\n[[rankings]]\ncolumns = ["M1", "M2", "M3"]\ncells = "ranks"\n',
        encoding="utf-8",
    )
    assert convert(path, "--map", str(tmp_path / "map.toml")) == 0
    assert [answer for *_, answer in responses(path)] == ["A=B", "A>B", "A>B"]


def test_the_report_cautions_of_a_side_effect_where_sides_are_unknown(tmp_path: Path) -> None:
    ranked, voted = tmp_path / "ranked.csv", tmp_path / "voted.csv"
    survey, votes = str(FORMS / "limesurvey.csv"), str(FORMS / "arena_battles.jsonl")
    assert run(["convert", survey, "--from", "limesurvey", "--ranking", "rank[*]", "--out", str(ranked)]) == 0
    assert run(["convert", votes, "--from", "arena", "--out", str(voted)]) == 0
    (caution,) = unknown_sides(read_response_csv(ranked), has_side_effect=True)
    assert "For 7 of 7 answers it is unknown which mode was shown as A" in caution
    assert "--no-side-effect" in caution
    assert unknown_sides(read_response_csv(ranked), has_side_effect=False) == []
    assert unknown_sides(read_response_csv(voted), has_side_effect=True) == []


def test_what_has_to_be_told_is_asked_for_before_the_place_to_write(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    assert run(["convert", str(path), *TABLE]) == 2
    assert "answer: x: nothing says what these mean" in capsys.readouterr().err
    assert run(["convert", str(path), *TABLE, *WORDS]) == 2
    assert "all is told, and 1 response can be written; say where by --out" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--answer", "answer"], "answer: is told twice as a column of answers to preference"),
        (["--answer", "#4"], "#4: is told twice as a column of answers to preference"),
        (["--question", ""], "--question: is empty"),
        (["--participant", " "], "--participant: is empty"),
    ],
)
def test_no_answer_counts_twice_and_no_name_is_empty(
    tmp_path: Path, options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    assert convert(path, *TABLE, *WORDS, *options) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out.csv").exists()


def test_two_questions_may_share_a_column(tmp_path: Path) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    assert convert(path, *TABLE[:-2], *WORDS, "--answer", "answer=one", "--answer", "answer=two") == 0
    assert len(responses(path)) == 2


@pytest.mark.parametrize("again", ["in.csv", "link.csv"])
def test_a_file_named_twice_is_refused(
    tmp_path: Path, again: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    (tmp_path / "link.csv").symlink_to(path)
    out = str(tmp_path / "out.csv")
    assert run(["convert", str(path), str(tmp_path / again), *TABLE, *WORDS, "--out", out]) == 2
    assert "the file is named twice" in capsys.readouterr().err


def test_a_ranking_named_twice_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = FORMS / "limesurvey.csv"
    options = ["--from", "limesurvey", "--ranking", "rank[*]", "--ranking", "rank[1],rank[2],rank[3]"]
    assert run(["convert", str(path), *options, "--out", str(tmp_path / "out.csv")]) == 2
    assert "this ranking is told twice" in capsys.readouterr().err


def test_a_line_among_several_files_needs_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = table(tmp_path, "p,M1,M2,x", name="1.csv")
    second = table(tmp_path, "q,M1,M1,y", name="2.csv")
    command = ["convert", str(first), str(second), *TABLE, *WORDS, "--out", str(tmp_path / "out.csv")]
    assert run([*command, "--leave-out", "2"]) == 2
    assert "write --leave-out FILE:2" in capsys.readouterr().err
    assert run(command) == 2
    assert "or this one by --leave-out 2.csv:2" in capsys.readouterr().err


def test_a_line_to_leave_out_that_is_not_there_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x", "q,M1,M2,y")
    assert convert(path, *TABLE, *WORDS, "--leave-out", "3", "--leave-out", "30") == 0
    assert "not in the rows that count: --leave-out 30\n" in capsys.readouterr().out


def test_a_line_in_an_archive_is_left_out_by_the_place_that_was_printed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = [
        "--from",
        "jatos",
        "--participant",
        "@study_result",
        "--left",
        "left",
        "--right",
        "right",
        "--only",
        "task=pair",
    ]
    words = ["--word", "0=A", "--word", "1=B", "--word", "2=equal"]
    command = ["convert", str(FORMS / "jatos_results.jrzip"), *options, *words]
    place = "study_result_42/comp-result_89/data.txt:1"
    assert run([*command, "--out", str(tmp_path / "all.csv")]) == 0
    assert f"line {place} (42)" in capsys.readouterr().out
    assert run([*command, "--leave-out", place, "--out", str(tmp_path / "fewer.csv")]) == 0
    assert "asked to be left out" in capsys.readouterr().out
    assert len(responses(tmp_path / "all.csv", "fewer.csv")) < len(responses(tmp_path / "all.csv", "all.csv"))


def test_responses_and_map_are_two_files_and_a_map_is_not_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, "p,M1,M2,x")
    assert convert(path, *TABLE, *WORDS, "--write-map", str(tmp_path / "out.csv")) == 2
    assert "--out and --write-map are the same file" in capsys.readouterr().err
    assert convert(path, *TABLE, *WORDS, "--write-map", str(tmp_path / "map.toml")) == 0
    assert convert(path, "--map", str(tmp_path / "map.toml"), out="map.toml") == 2
    assert "is a file to be read" in capsys.readouterr().err


def test_a_name_with_a_comma_is_one_name_in_a_list(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path, 'p,"M1, new",M2,x')
    assert convert(path, *TABLE, *WORDS) == 0
    assert "modes: 'M1, new' (1), M2 (1)" in capsys.readouterr().out
