"""OpenSesame's and lab.js's files beyond the reference files: quotation marks, and persons of other files."""

import csv
from pathlib import Path

import pytest

from app.cli.main import run

FORMS = Path(__file__).resolve().parents[1] / "reference" / "forms"
OPENSESAME = [
    "--from", "opensesame", "--answer", "response_choice", "--left", "left_arm", "--right", "right_arm",
    "--word", "left=A", "--word", "right=B", "--word", "down=equal", "--only", "practice=no",
    "--keep", "comment", "--keep", "experiment_path",
]  # fmt: skip
LABJS = [
    "--from", "labjs", "--participant", "participant_id", "--left", "left", "--right", "right",
    "--word", "<=A", "--word", ">=B", "--word", "==equal", "--only", "sender=Choice", "--only", "phase=main",
]  # fmt: skip


def converted(files: list[Path], options: list[str], out: Path) -> list[dict[str, str]]:
    assert run(["convert", *map(str, files), *options, "--out", str(out)]) == 0
    with out.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("line_break", ["\n", "\r\n"])
def test_both_ways_of_writing_quotation_marks_give_the_same_text(tmp_path: Path, line_break: str) -> None:
    text = (FORMS / "opensesame_subject-1.csv").read_text(encoding="utf-8")
    # The comment stands in a row in which nobody was asked again; let it be a new answer.
    answered = text.replace('"undefined","4","5"', '"undefined","5","5"')
    assert answered != text
    older, newer = tmp_path / "older.csv", tmp_path / "newer.csv"
    older.write_bytes(answered.replace("\n", line_break).encode())
    newer.write_bytes(
        answered.replace('\\"jerks\\"', '""jerks""').replace('\\"smooth\\"', '""smooth""')
        .replace("\n", line_break).encode()
    )  # fmt: skip
    rows = converted([older], OPENSESAME, tmp_path / "a.csv")
    assert [row["comment"] for row in rows][-1] == 'M2 "jerks",\n M1 is "smooth"'
    assert rows[-1]["experiment_path"] == "C:\\Users\\lab\\arms\\"
    assert rows == converted([newer], OPENSESAME, tmp_path / "b.csv")


def test_a_person_is_not_filled_in_from_another_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (FORMS / "labjs.csv").read_bytes().decode()
    named, nobody = tmp_path / "1.csv", tmp_path / "2.csv"
    named.write_bytes(text.encode())
    nobody.write_bytes(text.replace("K7,Welcome", ",Welcome").encode())
    out = tmp_path / "responses.csv"
    assert run(["convert", str(named), str(nobody), *LABJS, "--out", str(out)]) == 2
    printed = capsys.readouterr().err
    assert printed.count("\n") == 1
    assert "2.csv" in printed
    assert "participant_id" in printed
    assert not out.exists()
