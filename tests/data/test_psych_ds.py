"""``export --psych-ds`` against the rules that Psych-DS publishes, and against the store's own export.

Rules and conventions: psychds-docs.readthedocs.io, and schema.org's own terms. Written from the rules,
without the code that writes the data set. Psych-DS's own validator (psychds-validator 1.5.0, commit 6239b2e)
finds a demo's data set compatible; it is in no package registry, so it cannot run here.
"""

import csv
import json
import re
from pathlib import Path

import pytest

from data.errors import InputError
from data.export import export_study
from data.psych_ds import export_psych_ds
from data.records import Participant

DATA_FILE = re.compile(r"([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv")
DATASET_TERMS = {
    "@context",
    "@type",
    "description",
    "keywords",
    "measurementTechnique",
    "name",
    "variableMeasured",
    "version",
}
"""Of schema.org's properties of a Dataset, those that are used."""
VARIABLE_TERMS = {"@type", "name", "description", "unitText"}
"""Of schema.org's properties of a PropertyValue, those that are used."""


def faults(root: Path) -> list[str]:
    """What breaks a rule of Psych-DS, a line each."""
    wrong = []
    if not (root / "dataset_description.json").is_file():
        return ["dataset_description.json: missing"]
    about = json.loads((root / "dataset_description.json").read_text(encoding="utf-8"))
    if about.get("@type") != "Dataset" or about.get("@context", "").rstrip("/") not in (
        "http://schema.org",
        "https://schema.org",
    ):
        wrong.append("dataset_description.json: not a schema.org Dataset")
    wrong += [
        f"dataset_description.json: {key}: missing" for key in ("name", "description") if not about.get(key)
    ]
    wrong += [f"dataset_description.json: {key}: not a known term" for key in set(about) - DATASET_TERMS]
    overall = names(about["variableMeasured"], wrong)
    tables = sorted((root / "data").rglob("*.csv"))
    if not tables:
        wrong.append("data/: no data file")
    seen = set()
    for path in tables:
        if not DATA_FILE.fullmatch(path.name):
            wrong.append(f"{path.name}: not keywords and _data.csv")
        with path.open(encoding="utf-8", newline="") as file:
            header, *rows = list(csv.reader(file, strict=True))
        if len(set(header)) < len(header) or "" in header:
            wrong.append(f"{path.name}: header")
        wrong += [f"{path.name}: row {n}: cells" for n, row in enumerate(rows, 2) if len(row) != len(header)]
        if "row_id" in header and len({row[header.index("row_id")] for row in rows}) < len(rows):
            wrong.append(f"{path.name}: row_id repeats")
        # A metadata file beside a table replaces the field of the whole data set.
        beside = path.with_suffix(".json")
        own = json.loads(beside.read_text(encoding="utf-8")) if beside.is_file() else about
        measured = names(own["variableMeasured"], wrong)
        wrong += [f"{path.name}: {name}: not in variableMeasured" for name in set(header) - set(measured)]
        wrong += [f"{path.name}: {name}: not in the table" for name in set(measured) - set(header)]
        seen |= set(header)
    wrong += [f"variableMeasured: {name}: in no table" for name in set(overall) - seen]
    wrong += [f"variableMeasured: {name}: missing" for name in seen - set(overall)]
    wrong += [f"{name}: missing" for name in ("README.md", "CHANGES.md") if not (root / name).is_file()]
    wrong += [f"{path.name}: empty" for path in root.rglob("*") if path.is_file() and not path.stat().st_size]
    return wrong


def names(variables: list[dict[str, str]], wrong: list[str]) -> list[str]:
    for variable in variables:
        if variable.get("@type") != "PropertyValue" or set(variable) - VARIABLE_TERMS:
            wrong.append(f"variableMeasured: {variable}: not a PropertyValue")
    found = [variable["name"] for variable in variables]
    if len(set(found)) < len(found):
        wrong.append("variableMeasured: a name stands there twice")
    return found


def test_a_study_is_written_as_the_rules_ask(store, fill, noon, tmp_path):
    stored = fill(store)
    store.add_participant(stored, Participant("mallory", 9, "human", noon, {"a\rb": "=1\r\n", "row id": "1"}))
    dataset = export_psych_ds(store, stored, tmp_path / "set")
    assert faults(tmp_path / "set") == []
    assert {path.name for path in (tmp_path / "set" / "data").glob("*.csv")} == {
        f"study-carmichael2017_table-{table}_data.csv"
        for table in (
            "participants",
            "comparisons",
            "responses",
            "trials",
            "stuckevents",
            "switches",
            "audit",
        )
    }
    assert dataset.rows["responses"] == 72
    assert (tmp_path / "set" / "materials" / "study.toml").read_text(encoding="utf-8") == stored.toml


def test_the_tables_are_those_of_the_export_byte_for_byte(store, fill, tmp_path):
    stored = fill(store)
    export_psych_ds(store, stored, tmp_path / "set")
    export_study(store, stored, tmp_path / "out")
    compared = 0
    for path in (tmp_path / "set" / "data").glob("*.csv"):
        table = re.search(r"table-([a-z]+)_", path.name)
        assert table is not None
        (own,) = (p for p in (tmp_path / "out").glob("*.csv") if p.stem.replace("_", "") == table[1])
        assert path.read_bytes() == own.read_bytes()
        compared += 1
    assert compared == 7
    for name in ("codebook.json", "dataset_description.json"):
        (mine,) = (tmp_path / "set").rglob(name)
        assert mine.read_bytes() == (tmp_path / "out" / name).read_bytes()


def test_every_variable_says_what_it_means_in_each_table(store, fill, tmp_path):
    export_psych_ds(store, fill(store), tmp_path / "set")
    about = json.loads((tmp_path / "set" / "dataset_description.json").read_text(encoding="utf-8"))
    variables = {variable["name"]: variable for variable in about["variableMeasured"]}
    assert all(variable["description"] for variable in variables.values())
    assert variables["metric_force_mean_n"]["unitText"] == "N"
    assert variables["response"]["description"].endswith("(one of: A>>B, A>B, A=B, B>A, B>>A)")
    assert variables["id"]["description"].startswith("in participants: Identifies the participant")
    (beside,) = (tmp_path / "set" / "data").glob("*table-trials_data.json")
    own = {v["name"]: v for v in json.loads(beside.read_text(encoding="utf-8"))["variableMeasured"]}
    assert own["id"]["description"] == "Identifies the trial: one run at the maze under one condition"


@pytest.mark.parametrize(
    ("damage", "fault"),
    [
        (
            lambda root: next((root / "data").glob("*audit*.csv")).rename(root / "data" / "audit.csv"),
            "keywords",
        ),
        (lambda root: (root / "dataset_description.json").unlink(), "missing"),
        (lambda root: next((root / "data").glob("*audit*.csv")).write_text("number\n1,2\n"), "row 2: cells"),
        (
            lambda root: next((root / "data").glob("*audit*.csv")).write_text("row_id\n1\n1\n"),
            "row_id repeats",
        ),
        (
            lambda root: next((root / "data").glob("*audit*.csv")).write_text("hat\n1\n"),
            "not in variableMeasured",
        ),
        (lambda root: next((root / "data").glob("*audit*.csv")).unlink(), "in no table"),
        (lambda root: (root / "CHANGES.md").write_text(""), "CHANGES.md: empty"),
    ],
)
def test_a_broken_rule_is_seen(store, fill, tmp_path, damage, fault):
    export_psych_ds(store, fill(store, 1), tmp_path / "set")
    assert faults(tmp_path / "set") == []
    damage(tmp_path / "set")
    assert [line for line in faults(tmp_path / "set") if fault in line]


def test_an_earlier_data_set_is_replaced_but_no_other_folder_and_no_other_export(store, fill, tmp_path):
    stored = fill(store, 1)
    export_psych_ds(store, stored, tmp_path / "set")
    (tmp_path / "set" / "notes.txt").write_text("mine")
    fill(store, 2)
    export_psych_ds(store, stored, tmp_path / "set")
    assert (tmp_path / "set" / "notes.txt").read_text() == "mine"
    assert faults(tmp_path / "set") == []
    export_study(store, stored, tmp_path / "out")
    with pytest.raises(InputError, match="not empty and holds no earlier result"):
        export_psych_ds(store, stored, tmp_path / "out")
    with pytest.raises(InputError, match="not empty and holds no earlier result"):
        export_study(store, stored, tmp_path / "set")


def test_the_same_data_are_the_same_bytes(store, fill, tmp_path):
    stored = fill(store, 1)
    for name in ("one", "two"):
        export_psych_ds(store, stored, tmp_path / name)
    one, two = (
        {p.relative_to(tmp_path / name): p.read_bytes() for p in (tmp_path / name).rglob("*") if p.is_file()}
        for name in ("one", "two")
    )
    assert one == two
