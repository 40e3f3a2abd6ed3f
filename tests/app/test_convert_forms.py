"""Every file in tests/reference/forms is converted, or refused, as its entry in cases.toml and right/ say.

A new file there is tested on arrival: without an entry the first test fails.
"""

import csv
import shlex
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.cli.main import run
from data.answers import MIRRORED
from data.convert import forms
from data.response_csv import read_response_csv

FOLDER = Path(__file__).resolve().parents[1] / "reference" / "forms"


@dataclass(frozen=True)
class Case:
    """One entry of cases.toml."""

    files: list[str]
    form: str
    options: str
    prints: list[str]
    right: str = ""
    too_little: list[dict] = field(default_factory=list)

    @property
    def paths(self) -> list[str]:
        return [str(FOLDER / name) for name in self.files]

    def arguments(self, options: str, out: Path) -> list[str]:
        """Of the command."""
        return ["convert", *self.paths, "--from", self.form, *shlex.split(options), "--out", str(out)]


CASES = [Case(**entry) for entry in tomllib.loads((FOLDER / "cases.toml").read_text("utf-8"))["case"]]
CONVERTED = [case for case in CASES if case.right]
REFUSED = [case for case in CASES if not case.right]
TOO_LITTLE = [(case, too_little) for case in CASES for too_little in case.too_little]


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def mirrored(row: dict[str, str]) -> dict[str, str]:
    return row | {
        "mode_a": row["mode_b"],
        "mode_b": row["mode_a"],
        "response": MIRRORED[row["response"]],  # type: ignore[index]
    }


def name_of(case: Case) -> str:
    return f"{case.files[0]}-{case.right or 'refused'}"


def test_every_file_has_an_entry_and_every_right_answer_is_compared() -> None:
    named = {name for case in CASES for name in case.files}
    assert named == {path.name for path in FOLDER.iterdir() if path.is_file()} - {"cases.toml"}
    assert {case.right for case in CONVERTED} == {path.name for path in (FOLDER / "right").iterdir()}


def test_every_form_has_a_case() -> None:
    assert {case.form for case in CASES} == set(forms())


@pytest.mark.parametrize("case", CONVERTED, ids=name_of)
def test_a_file_becomes_the_right_answers(
    case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "responses.csv"
    code = run(case.arguments(case.options, out))
    printed = capsys.readouterr()
    assert (code, printed.err) == (0, "")
    right, converted = rows_of(FOLDER / "right" / case.right), rows_of(out)
    assert ("participant" in right[0]) == ("participant" in converted[0])
    for expected, row in zip(right, converted, strict=True):
        same = {name: row[name] for name in expected}
        if row.get("sides") == "unknown":
            assert expected in (same, mirrored(same))
        else:
            assert expected == same
    assert [part for part in case.prints if part not in printed.out] == []
    assert len(read_response_csv(out).rows) == len(right)


@pytest.mark.parametrize("case", CONVERTED, ids=name_of)
def test_the_written_map_gives_the_same_bytes(case: Case, tmp_path: Path) -> None:
    out, again, kept = tmp_path / "responses.csv", tmp_path / "again.csv", tmp_path / "map.toml"
    assert run([*case.arguments(case.options, out), "--write-map", str(kept)]) == 0
    rewritten = tmp_path / "again.toml"
    arguments = ["--map", str(kept), "--out", str(again), "--write-map", str(rewritten)]
    assert run(["convert", *case.paths, *arguments]) == 0
    assert again.read_bytes() == out.read_bytes()
    assert rewritten.read_bytes() == kept.read_bytes()


@pytest.mark.parametrize("case", REFUSED, ids=name_of)
def test_a_file_that_cannot_be_right_is_refused_in_one_line(
    case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    refuses(case, case.options, case.prints, tmp_path, capsys)


@pytest.mark.parametrize(
    ("case", "too_little"), TOO_LITTLE, ids=[f"{name_of(c)}-{u['options']}" for c, u in TOO_LITTLE]
)
def test_what_is_not_told_is_asked_for_with_the_column_and_its_values(
    case: Case, too_little: dict, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    refuses(case, too_little["options"], too_little["prints"], tmp_path, capsys)


def refuses(
    case: Case, options: str, prints: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "responses.csv"
    assert run([*case.arguments(options, out), "--write-map", str(tmp_path / "map.toml")]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    assert [part for part in prints if part not in printed.err] == []
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_look_names_the_form(case: Case, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["convert", case.paths[0], "--from", "look"]) == 0
    assert f"--from {case.form}" in capsys.readouterr().out.splitlines()[0]


@given(
    case=st.sampled_from(CASES),
    place=st.floats(0, 1, exclude_max=True),
    removed=st.integers(0, 30),
    inserted=st.sampled_from(
        [b"", b'"', b",", b";", b"\n", b"\r", b"{", b"[", b"]", b"\0", b"\xff", b"-", b"*"]
    ),
)
@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_damaged_file_is_converted_or_refused_in_one_line(
    case: Case,
    place: float,
    removed: int,
    inserted: bytes,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    content = Path(case.paths[0]).read_bytes()
    at = int(place * len(content))
    damaged = tmp_path / case.files[0]
    damaged.write_bytes(content[:at] + inserted + content[at + removed :])
    out = tmp_path / "responses.csv"
    out.unlink(missing_ok=True)
    options = ["--from", case.form, *shlex.split(case.options), "--out", str(out)]
    code = run(["convert", str(damaged), *case.paths[1:], *options])
    printed = capsys.readouterr()
    assert code in (0, 2)
    assert out.exists() == (code == 0)
    assert printed.err.count("\n") == (1 if code == 2 else 0)
