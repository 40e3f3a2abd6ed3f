"""The data package: Frictionless finds it valid, and what it reads by the schemas is what the store holds."""

import json
from datetime import UTC, datetime
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from data.data_package import data_package
from data.export import FORMULA_STARTS, cell, export_study
from data.records import Comparison, Participant, StuckEvent, Switch, Trial
from data.store import Store
from data.study_file import study_text
from tests.frictionless_report import typed_rows, validated


def problems(folder: Path) -> list[str]:
    """What Frictionless finds wrong, a line each."""
    report = validated(folder)
    places = [*report.errors, *(error for task in report.tasks for error in task.errors)]
    return [f"{error.type}: {error.message}" for error in places]


def resources(folder: Path) -> dict[str, dict]:
    package = json.loads((folder / "datapackage.json").read_text(encoding="utf-8"))
    return {resource["path"]: resource for resource in package["resources"]}


def read_by_schema(folder: Path, path: str) -> list[dict[str, object]]:
    """A table's rows as Frictionless types them."""
    return typed_rows(folder, resources(folder)[path]["name"])


def raw_rows(folder: Path, table: str) -> list[dict[str, object]]:
    lines = (folder / "raw" / f"{table}.jsonl").read_text(encoding="utf-8").split("\n")
    return [json.loads(line) for line in lines if line]


def in_words(value: object, kind: str) -> object:
    """A raw value as a person reads it in the CSV file."""
    if value is None or (value == "" and kind == "string") or value == "nan":
        return None
    if kind == "datetime":
        return datetime.fromisoformat(str(value))
    if kind == "number":
        return float(str(value))
    if kind == "string" and str(value).startswith(FORMULA_STARTS):
        return f"'{value}"
    return value


def test_an_export_is_valid_and_only_its_csv_files_are_tables(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "out")
    assert problems(tmp_path / "out") == []
    tables = {path for path, resource in resources(tmp_path / "out").items() if resource["type"] == "table"}
    assert tables == {path.name for path in (tmp_path / "out").glob("*.csv")}


@pytest.mark.parametrize("place", ["responses.csv", "raw/trials.jsonl", "study.toml", "recordings"])
def test_a_changed_byte_is_found_in_every_kind_of_file(store, fill, tmp_path, place):
    export_study(store, fill(store, 1), tmp_path / "out")
    path = tmp_path / "out" / place
    if path.is_dir():
        path = sorted(path.iterdir())[-1]
    content = bytearray(path.read_bytes())
    content[-2] ^= 1
    path.write_bytes(content)
    name = path.relative_to(tmp_path / "out").as_posix()
    report = validated(tmp_path / "out")
    wrong = {task.place for task in report.tasks if not task.valid}
    assert wrong == {str(tmp_path / "out" / name)} or {Path(place).name for place in wrong} == {path.name}
    assert any("hash" in problem for problem in problems(tmp_path / "out"))


def test_what_a_schema_forbids_is_found(store, fill, tmp_path):
    """The constraints are not empty words: each kind of fault is seen when size and hash are not compared."""
    export_study(store, fill(store, 1), tmp_path / "out")
    package = json.loads((tmp_path / "out" / "datapackage.json").read_text())
    for resource in package["resources"]:
        resource.pop("bytes")
        resource.pop("hash")
    (tmp_path / "out" / "datapackage.json").write_text(json.dumps(package))
    assert problems(tmp_path / "out") == []
    faults = {
        "A>B": ("A>C", "constraint-error"),
        "Q1": ("", "constraint-error"),
        "h-p001,": ("nobody,", "foreign-key"),
        "false": ("no", "type-error"),
        "2026-03-04T12": ("on Monday", "type-error"),
    }
    path = tmp_path / "out" / "responses.csv"
    text = path.read_text()
    for old, (new, kind) in faults.items():
        path.write_text(text.replace(old, new, 1))
        assert [problem for problem in problems(tmp_path / "out") if problem.startswith(kind)], old
    lines = text.splitlines(keepends=True)
    path.write_text("".join([*lines, lines[-1]]))
    assert [problem for problem in problems(tmp_path / "out") if problem.startswith("primary-key")]


texts = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0"), max_size=12)


@given(
    background=st.dictionaries(texts, texts, max_size=4),
    metrics=st.dictionaries(st.from_regex(r"[a-z_]{1,8}", fullmatch=True), st.floats(), max_size=4),
    actor=texts,
    duration=st.floats(allow_infinity=False),
)
@settings(max_examples=10, deadline=None)
def test_what_a_reader_gets_by_the_schemas_is_what_the_store_holds(
    empty_store, study, tmp_path_factory, background, metrics, actor, duration
):
    place = tmp_path_factory.mktemp("export")
    (place / "study.sqlite").write_bytes(empty_store)
    noon = datetime(2026, 3, 4, 12, 0, tzinfo=UTC)
    with Store.open(place / "study.sqlite", clock=lambda: noon) as store:
        stored = store.add_study(study, study_text("carmichael2017"))
        store.add_participant(stored, Participant("who", 2, "human", noon, background))
        store.add_comparisons([Comparison("who.c1", "who", 1, 1, "M1", "M2", False, None)])
        store.add_trial(
            Trial(
                "who.c1.A1",
                "who.c1",
                "A",
                1,
                "M1",
                "external",
                "failed",
                noon,
                duration,
                3,
                metrics,
                (StuckEvent("stuck", duration, duration, actor, actor),),
            )
        )
        store.add_switch(Switch("who.c1", 1, "B", noon))
        store.log(actor, "said", {"what": actor}, noon)
        export_study(store, stored, place / "out")
    assert problems(place / "out") == []
    compared = 0
    for table in ("participants", "comparisons", "trials", "stuck_events", "switches", "audit"):
        kept = raw_rows(place / "out", table)
        read = read_by_schema(place / "out", f"{table}.csv")
        kinds = {f["name"]: f["type"] for f in resources(place / "out")[f"{table}.csv"]["schema"]["fields"]}
        assert len(read) == len(kept)
        for seen, row in zip(read, kept, strict=True):
            for name in set(seen) & set(row) - {"detail"}:
                value = (
                    float(seen[name]) if kinds[name] == "number" and seen[name] is not None else seen[name]
                )
                assert value == in_words(row[name], kinds[name]), (table, name)
                compared += 1
    assert compared > 40
    trial = read_by_schema(place / "out", "trials.csv")[-1]
    given_numbers = sorted(repr(float(value)) for value in metrics.values() if value == value)
    own = [value for name, value in trial.items() if name.startswith("metric_") and value is not None]
    assert sorted(repr(float(value)) for value in own) == given_numbers
    person = read_by_schema(place / "out", "participants.csv")[-1]
    own = [name for name in person if name.startswith("background_") and name != "background_at"]
    answers = [person[name] for name in own]
    assert sorted(value for value in answers if value is not None) == sorted(
        in_words(text, "string") for text in background.values() if text
    )


def test_names_that_come_to_one_column_keep_a_column_each(store, fill, noon, tmp_path):
    stored = fill(store, 1)
    answers = {
        "How often?": "daily",
        "How often!": "never",
        "how often?": "once",
        "年": "a",
        "月": "b",
        "at": "c",
    }
    store.add_participant(stored, Participant("who", 9, "human", noon, answers))
    export_study(store, stored, tmp_path / "out")
    row = read_by_schema(tmp_path / "out", "participants.csv")[-1]
    columns = [name for name in row if name.startswith("background_") and name != "background_at"]
    assert len({name.lower() for name in columns}) == len(columns) == 7
    assert sorted(str(row[name]) for name in columns if row[name]) == sorted(answers.values())
    assert row["background_at"] is None
    codebook = json.loads((tmp_path / "out" / "codebook.json").read_text(encoding="utf-8"))
    meanings = {codebook["tables"]["participants.csv"]["columns"][name]["meaning"] for name in columns}
    assert meanings == {f"Background: {name}" for name in (*answers, "age")}


def test_files_whose_names_differ_by_case_or_a_hyphen_have_names_of_their_own(tmp_path):
    for name in ("p_1.A.parquet", "p-1.A.parquet", "P-1.A.parquet", "p_1.a.parquet"):
        (tmp_path / name).write_bytes(name.encode())
    about = {"name": "x", "title": "X", "description": "", "version": "1"}
    listed = data_package(tmp_path, (), about, {})["resources"]
    assert len({resource["name"] for resource in listed}) == len({r["path"] for r in listed}) == 4
    (tmp_path / "datapackage.json").write_text(
        json.dumps({"name": "x", "profile": "data-package", "resources": listed})
    )
    assert problems(tmp_path) == []


def test_every_metric_of_an_export_has_a_meaning_and_a_unit(store, fill, tmp_path):
    export_study(store, fill(store, 1), tmp_path / "out")
    columns = json.loads((tmp_path / "out" / "codebook.json").read_text())["tables"]["trials.csv"]["columns"]
    assert columns["metric_force_mean_n"] == {
        "meaning": "mean force of the hand while it holds the handle",
        "type": "number",
        "unit": "N",
        "valid": [],
        "may_be_empty": True,
    }
    other = columns["metric_exit_force_n"]
    assert (other["meaning"], other["unit"]) == (
        "exit_force_n: not a metric that this version of Elbowroom computes",
        "N",
    )


def test_an_infinite_number_is_written_as_table_schema_writes_it():
    assert [cell(value) for value in (float("inf"), float("-inf"), float("nan"))] == ["INF", "-INF", ""]
