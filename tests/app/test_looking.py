"""Looks at results are kept and said wherever a ranking is shown; the terminal cautions as the page does."""

import json
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.cli.main import run
from app.console.findings import QuestionAtAGlance, Standing, firsts_at_a_glance
from app.looking import console_sentence
from data.records import Comparison, Look, Participant
from data.store import Store
from data.study_file import parse_study

AT = datetime(2026, 3, 4, 12, 0, tzinfo=UTC)
STUDY = """format = 1
name = "looks"
title = "Looks"
[consent]
version = "1"
text = "Agreed?"
[[modes]]
name = "M1"
method = "dls"
[[modes]]
name = "M2"
method = "dls"
parameters = { lambda0 = 0.6 }
[[questions]]
name = "Q1"
wording = "Which?"
short = "which"
levels = 3
"""


def add_people(store: Path, numbers: range, source: str = "human") -> None:
    """People with four answers each, who mostly prefer M2."""
    with Store.open(store) as kept, kept.transaction():
        stored = kept.add_study(parse_study(STUDY, "looks"), STUDY)
        for number in numbers:
            who = f"p{number}"
            kept.add_participant(stored, Participant(who, number, source, AT))
            for position in range(1, 5):
                modes = ("M1", "M2") if position % 2 else ("M2", "M1")
                name = f"{who}.c{position}"
                kept.add_comparisons([Comparison(name, who, position, 1, *modes, False, AT)])
                answer = "A=B" if position == 4 else "A>B" if modes[0] == "M2" else "B>A"
                kept.submit_responses(name, {"Q1": answer}, AT)


def report(store: Path, out: Path, *options: str) -> list[str]:
    """What a report's page cautions of."""
    assert run(["report", "--store", str(store), "--out", str(out), *options]) == 0
    return json.loads((out / "summary.json").read_text(encoding="utf-8"))["before_you_quote_this"]


def test_a_report_on_a_store_says_how_often_results_were_looked_at(tmp_path: Path) -> None:
    store = tmp_path / "study.sqlite"
    add_people(store, range(1, 5))
    for _ in range(2):
        assert not any("looked at" in said for said in report(store, tmp_path / "first"))
    add_people(store, range(5, 8))
    cautions = report(store, tmp_path / "second")
    (said,) = [caution for caution in cautions if "looked at" in caution]
    assert said.startswith("The results were looked at once before this report (with 4 participants).")
    assert "although nobody prefers any mode rises" in said
    with Store.open(store, create=False) as kept:
        assert kept.looks(kept.study(None)) == (Look(4, 16), Look(7, 28))
        assert kept.verify_audit().is_intact


def test_a_report_of_simulated_answers_is_no_look_at_people(tmp_path: Path) -> None:
    store = tmp_path / "study.sqlite"
    add_people(store, range(1, 5), "simulated")
    report(store, tmp_path / "out", "--include-simulated")
    with Store.open(store, create=False) as kept:
        assert kept.audit_log() == ()


def test_the_console_keeps_its_looks_and_says_what_they_do(tmp_path: Path) -> None:
    store = tmp_path / "study.sqlite"
    add_people(store, range(1, 5))
    with Store.open(store, create=False) as kept:
        stored = kept.study(None)
        assert console_sentence(kept, stored, Look(0, 0), AT) == ""
        for _ in range(3):
            assert console_sentence(kept, stored, Look(2, 8), AT).startswith("This is the first look")
        said = console_sentence(kept, stored, Look(4, 16), AT)
        assert said.startswith("The results were looked at once before (with 2 participants).")
        assert "M1" not in said
        assert kept.looks(stored) == (Look(2, 8), Look(4, 16))


def test_likely_firsts_of_the_console_carry_their_joint_statement() -> None:
    def question(name: str, *chances: float) -> QuestionAtAGlance:
        standings = tuple(Standing(f"X{k}", 0.5, 0.1, 0.9, p) for k, p in enumerate(chances))
        return QuestionAtAGlance(name, name, name, 9, standings, "")

    questions = [question("Q1", 0.9, 0.1), question("Q2", 0.2, 0.8), question("Q3", 0.5, 0.5), question("Q4")]
    said = firsts_at_a_glance(questions)
    assert said.startswith("Of the 2 first places of 80 % and more")
    assert "0.30 are expected to be wrong; the chance that all of them are right is 72 %" in said
    assert "too sure" in said
    assert firsts_at_a_glance(questions[2:]) == ""


def test_the_terminal_cautions_of_all_that_the_page_cautions_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The answers of one judge, much alike, as in a file that gave no caution in the terminal."""
    rows = ["participant,mode_a,mode_b,response,count"]
    rows += ["j1,M1,M2,A>B,90", "j1,M2,M1,A>B,30", "j1,M2,M1,B>A,90", "j1,M1,M2,B>A,30"]
    (tmp_path / "one_judge.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    assert run(["report", "--responses", str(tmp_path / "one_judge.csv"), "--out", str(tmp_path / "r")]) == 0
    printed = capsys.readouterr()
    notes = [line.removeprefix("note: ") for line in printed.err.splitlines() if line.startswith("note: ")]
    summary = json.loads((tmp_path / "r" / "summary.json").read_text(encoding="utf-8"))
    cautions = summary["before_you_quote_this"]
    assert notes == [c for c in cautions if not c.startswith("The sampler converged")]
    assert len(notes) == len(set(notes)) >= 2
    assert any("one participant's" in note for note in notes)
    for warning in summary["warnings"]:
        assert any(note in warning for note in notes), warning
    assert "converged: R-hat" in " ".join(printed.out.split())
