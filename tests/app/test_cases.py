"""Small response CSVs of kinds that went wrong: what the report and the import make of each.

Every file in ``tests/reference/cases`` needs an entry in ``CASES``: a new file is tested on arrival.
"""

from dataclasses import dataclass
from pathlib import Path

import pytest

from analysis.fit import fit
from analysis.results import FitSettings
from app.cli.main import run
from data.errors import InputError
from data.response_csv import read_response_csv
from data.store import Store

FOLDER = Path(__file__).parent.parent / "reference" / "cases"
QUICK = FitSettings(draws=200, tune=300, chains=2)


@dataclass(frozen=True)
class Case:
    """What is right for a file.

    Attributes
    ----------
    answers : int
        Answers that count; 0 for a file that is refused.
    words : tuple of str
        Parts of the one line that refuses it, or of the note on how it was read.
    modes : mapping of str to tuple of str
        Modes that each question ranks.
    is_of_2017 : bool
        True if the built-in study has its modes and questions, so that it can be imported.
    """

    answers: int
    words: tuple[str, ...] = ()
    modes: tuple[tuple[str, tuple[str, ...]], ...] = ()
    is_of_2017: bool = False


THREE = (("Q1", ("M1", "M2", "M3")),)
TWO = (("preference", ("M1", "M2")),)
CASES = {
    "clean": Case(72, (), THREE, True),
    "repeated_row": Case(72, ("24 rows (lines 74, 75, 76 and 21 more) repeat",), THREE, True),
    "contradicting_row": Case(
        0, ("line 74, response: comparison 'c1' of participant 'p01'", "line 2"), (), True
    ),
    "two_pairs_in_one_comparison": Case(0, ("line 3, mode_a: comparison 'c1'", "'M1' in line 2"), (), True),
    "label_space": Case(0, ("line 3, mode_b: the mode 'M1' looks like 'M1 ' (line 2)",)),
    "label_nbsp": Case(0, (r"line 3, mode_b: the mode 'M1' looks like 'M1\xa0' (line 2)",)),
    "label_case": Case(0, ("line 3, mode_b: the mode 'M1' looks like 'm1' (line 2)",)),
    "label_nfd": Case(0, (r"line 3, mode_a: the mode 'Da\u0308mpf' looks like 'Dämpf' (line 2)",)),
    "header_space": Case(16, ("' mode_a' as mode_a, ' mode_b' as mode_b, ' response' as response",), TWO),
    "questions_apart": Case(26, (), (("image1", ("codecA", "codecB")), ("image2", ("codecC", "codecD")))),
    "batch_1": Case(20, (), THREE, True),
    "batch_2": Case(20, (), THREE, True),
    "batch_again": Case(21, (), THREE, True),
    "second_day_1": Case(20, (), THREE, True),
    "second_day_2": Case(20, (), THREE, True),
    "one_judge": Case(240, (), TWO),
    "winner_first": Case(40, (), TWO),
}


def test_every_file_in_the_folder_has_what_is_right_for_it():
    assert {path.stem for path in FOLDER.glob("*.csv")} == set(CASES)


def once(name: str) -> tuple[int, str]:
    """Answers of a file as read, and all that was said of it on one line each."""
    try:
        table = read_response_csv(FOLDER / f"{name}.csv")
    except InputError as error:
        return 0, str(error)
    return int(table.rows["count"].sum()), "\n".join(table.notes)


@pytest.mark.parametrize("name", CASES)
def test_the_reader_counts_or_refuses_it(name):
    case = CASES[name]
    answers, text = once(name)
    assert answers == case.answers
    assert all(words in text for words in case.words)
    assert bool(text) == bool(case.words)
    assert "\n" not in text


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.answers])
def test_each_question_is_ranked_among_its_own_modes(name):
    case = CASES[name]
    fitted = fit(read_response_csv(FOLDER / f"{name}.csv"), QUICK)
    assert [(q.question.name, q.mode_names) for q in fitted.questions] == list(case.modes)
    assert [q.reason for q in fitted.questions if q.draws is None] == []
    assert sum(q.n for q in fitted.questions) == case.answers
    assert all(words in "\n".join(fitted.warnings) for words in case.words)


def test_repeated_rows_leave_the_posterior_as_it_is():
    fits = [fit(read_response_csv(FOLDER / f"{name}.csv"), QUICK) for name in ("clean", "repeated_row")]
    assert fits[0].questions[0].modes == fits[1].questions[0].modes


@pytest.fixture
def elbowroom(capsys):
    """Runs a command; gives back its exit code and what it printed."""

    def command(*arguments) -> tuple[int, str]:
        code = run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out + captured.err

    return command


def stored(store: Path) -> int:
    with Store.open(store) as opened:
        return len(opened.responses_table(opened.study()).rows)


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.is_of_2017])
def test_the_import_counts_or_refuses_what_the_report_does(name, tmp_path, elbowroom):
    case, store = CASES[name], tmp_path / "study.sqlite"
    code, text = elbowroom("import", "--responses", FOLDER / f"{name}.csv", "--store", store)
    assert code == (0 if case.answers else 2)
    assert all(words in text for words in case.words)
    if case.answers:
        assert stored(store) == case.answers


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if not case.answers])
def test_the_report_refuses_it_and_writes_nothing(name, tmp_path, elbowroom):
    out = tmp_path / "report"
    code, text = elbowroom("report", "--responses", FOLDER / f"{name}.csv", "--out", out)
    assert code == 2
    assert len(text.splitlines()) == 1
    assert not out.exists()


@pytest.mark.parametrize("names", [("batch_1", "batch_2"), ("second_day_1", "second_day_2")])
def test_two_files_without_comparisons_are_two_batches(names, tmp_path, elbowroom):
    store = tmp_path / "study.sqlite"
    for name in names:
        path = FOLDER / f"{name}.csv"
        assert elbowroom("import", "--responses", path, "--store", store)[0] == 0
    assert stored(store) == 40


@pytest.mark.parametrize(("option", "answers"), [("--continues", 21), ("--another-batch", 41)])
def test_a_file_that_repeats_another_is_asked_about(option, answers, tmp_path, elbowroom):
    store, again = tmp_path / "study.sqlite", FOLDER / "batch_again.csv"
    first = ["import", "--responses", FOLDER / "batch_1.csv", "--store", store]
    second = ["import", "--responses", again, "--store", store]
    assert elbowroom(*first)[0] == 0
    code, text = elbowroom(*second)
    assert (code, len(text.splitlines())) == (2, 1)
    assert "20 of its 21 answers are as in an earlier file" in text
    assert all(way in text for way in ("--continues", "--another-batch", "a column comparison"))
    assert stored(store) == 20
    assert elbowroom(*second, option)[0] == 0
    assert stored(store) == answers
    assert elbowroom(*second)[0] == 0
    assert stored(store) == answers
