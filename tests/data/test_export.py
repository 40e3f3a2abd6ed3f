"""The export: the same data are the same bytes, and nothing of the store is missing from it."""

import csv
import hashlib
import json
from pathlib import Path

import pytest

from data.errors import ElbowroomError, InputError
from data.export import OWNS, SHEETS, export_study
from data.metric_meanings import unit_in
from data.records import Participant
from data.response_csv import read_response_csv
from data.store import Store
from data.store.snapshot import TABLES
from data.store.tables import metadata
from data.study_file import study_text


def contents(folder: Path) -> dict[str, str]:
    files = (path for path in folder.rglob("*") if path.is_file())
    return {p.relative_to(folder).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest() for p in files}


def sheet(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_same_data_are_the_same_bytes_in_another_store(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "one")
    with Store.open(tmp_path / "another.sqlite") as other:
        export_study(other, fill(other), tmp_path / "two")
    assert contents(tmp_path / "one") == contents(tmp_path / "two")


def test_the_files_are_those_that_the_contract_names(store, fill, tmp_path):
    result = export_study(store, fill(store), tmp_path / "out")
    present = {path.name for path in (tmp_path / "out").iterdir()}
    assert (
        present
        == set(OWNS)
        >= {"codebook.json", "datapackage.json", "study.toml", *(f"{s}.csv" for s in SHEETS)}
    )
    assert (result.participants, result.comparisons, result.responses) == (2, 12, 72)
    assert (result.trials, result.recordings) == (24, 24)
    assert len(list((tmp_path / "out" / "recordings").glob("*.parquet"))) == 24


def test_every_table_of_the_store_is_in_the_export(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "out")
    raw = {path.stem for path in (tmp_path / "out" / "raw").iterdir()}
    assert raw == set(metadata.tables) == {table.name for table in TABLES}


def test_the_responses_are_a_response_csv(store, fill, study, tmp_path):
    stored = fill(store)
    export_study(store, stored, tmp_path / "out")
    read = read_response_csv(tmp_path / "out" / "responses.csv", study)
    kept = store.responses_table(stored)
    columns = list(kept.rows.columns)
    assert read.rows[columns].equals(kept.rows[columns])
    assert (read.modes, read.questions) == (kept.modes, kept.questions)


def test_the_codebook_describes_every_column(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "out")
    tables = json.loads((tmp_path / "out" / "codebook.json").read_text())["tables"]
    for name in SHEETS:
        with (tmp_path / "out" / f"{name}.csv").open(newline="") as file:
            header = next(csv.reader(file))
        columns = tables[f"{name}.csv"]["columns"]
        assert list(columns) == header
        for column in columns.values():
            assert column["meaning"]
            assert column["type"] in ("string", "integer", "number", "boolean", "datetime")
    assert tables["trials.csv"]["columns"]["metric_force_mean_n"]["unit"] == "N"
    assert tables["responses.csv"]["columns"]["response"]["valid"] == ["A>>B", "A>B", "A=B", "B>A", "B>>A"]


def test_cells_are_valid_where_the_codebook_lists_the_valid_values(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "out")
    tables = json.loads((tmp_path / "out" / "codebook.json").read_text())["tables"]
    checked = 0
    for name in SHEETS:
        for row in sheet(tmp_path / "out", name):
            for column, text in row.items():
                described = tables[f"{name}.csv"]["columns"][column]
                if described["valid"] and (text or not described["may_be_empty"]):
                    assert text in described["valid"]
                    checked += 1
                assert text or described["may_be_empty"] or described["type"] == "string"
    assert checked > 400


def test_the_data_package_lists_every_file_with_its_hash_and_size(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "out")
    package = json.loads((tmp_path / "out" / "datapackage.json").read_text())
    listed = {item["path"]: item for item in package["resources"]}
    present = contents(tmp_path / "out")
    del present["datapackage.json"]
    assert {path: item["hash"] for path, item in listed.items()} == {
        path: f"sha256:{digest}" for path, digest in present.items()
    }
    assert all((tmp_path / "out" / path).stat().st_size == item["bytes"] for path, item in listed.items())


def test_every_key_and_reference_of_the_data_package_holds(store, fill, tmp_path):
    export_study(store, fill(store), tmp_path / "out")
    package = json.loads((tmp_path / "out" / "datapackage.json").read_text())
    schemas = {item["name"]: item["schema"] for item in package["resources"] if "schema" in item}
    files = {item["name"]: item["path"][:-4] for item in package["resources"] if "schema" in item}
    assert len(schemas) == len(SHEETS)
    references = 0
    for name, schema in schemas.items():
        rows = sheet(tmp_path / "out", files[name])
        keys = [tuple(row[key] for key in schema["primaryKey"]) for row in rows]
        assert len(set(keys)) == len(keys)
        for foreign in schema.get("foreignKeys", []):
            target = foreign["reference"]
            known = {row[target["fields"]] for row in sheet(tmp_path / "out", files[target["resource"]])}
            assert {row[foreign["fields"]] for row in rows} <= known
            references += 1
    assert references == 8


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@x", "\t=1", "\r=1", "＝1"])
def test_formula_text_is_neutralised_in_the_csv_and_kept_raw_beside_it(store, fill, noon, tmp_path, text):
    stored = fill(store, 1)
    store.add_participant(stored, Participant("mallory", 9, "human", noon, {"=cmd|x": text, "age": "20"}))
    store.log(text, "joined", {"as": text}, noon)
    export_study(store, stored, tmp_path / "out")
    row = next(row for row in sheet(tmp_path / "out", "participants") if row["id"] == "mallory")
    assert row["background__cmd_x"] == f"'{text}"
    assert sheet(tmp_path / "out", "audit")[-1]["actor"] == f"'{text}"
    lines = (tmp_path / "out" / "raw" / "participants.jsonl").read_text(encoding="utf-8").split("\n")
    assert json.loads(lines[-2])["background"] == {"=cmd|x": text, "age": "20"}


def test_no_cell_of_any_file_begins_like_a_formula(store, fill, noon, tmp_path):
    stored = fill(store, 1)
    store.add_participant(stored, Participant("mallory", 9, "human", noon, {"=a": "=1", "@b": "-1"}))
    export_study(store, stored, tmp_path / "out")
    for path in (tmp_path / "out").glob("*.csv"):
        with path.open(newline="") as file:
            cells = [text for row in csv.reader(file) for text in row]
        assert not [text for text in cells if text.startswith(("=", "+", "@", "-"))]


def test_simulated_participants_are_exported_only_when_asked_for(store, fill, tmp_path):
    stored = fill(store, 1, "human")
    fill(store, 2, "simulated")
    export_study(store, stored, tmp_path / "people")
    export_study(store, stored, tmp_path / "all", include_simulated=True)
    assert {row["source"] for row in sheet(tmp_path / "people", "participants")} == {"human"}
    assert "s-p001" not in "".join(p.read_text() for p in (tmp_path / "people" / "raw").iterdir())
    assert len(sheet(tmp_path / "all", "participants")) == 3


def test_simulated_participants_alone_must_be_asked_for(store, fill, tmp_path):
    stored = fill(store, 1, "simulated")
    with pytest.raises(InputError, match="add --include-simulated"):
        export_study(store, stored, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_an_earlier_export_is_replaced_and_other_files_beside_it_stay(store, fill, tmp_path):
    out = tmp_path / "out"
    stored = fill(store, 2)
    export_study(store, stored, out)
    (out / "notes.txt").write_text("mine")
    (out / "raw" / "stale.jsonl").write_text("old")
    fill(store, 3)
    export_study(store, stored, out)
    assert (out / "notes.txt").read_text() == "mine"
    assert not (out / "raw" / "stale.jsonl").exists()
    assert len(sheet(out, "participants")) == 3


def test_a_folder_with_other_contents_is_refused_and_left_alone(store, fill, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.txt").write_text("years of work")
    with pytest.raises(InputError, match="not empty and holds no earlier result"):
        export_study(store, fill(store, 1), tmp_path / "out")
    assert contents(tmp_path / "out").keys() == {"thesis.txt"}


@pytest.mark.parametrize("damage", ["changed", "gone"])
def test_a_recording_that_is_not_as_it_was_stored_stops_the_export_and_leaves_nothing(
    store, fill, tmp_path, damage
):
    stored = fill(store, 1)
    path = store.recording_path(store.trials(stored)[-1])
    path.write_bytes(b"other") if damage == "changed" else path.unlink()
    with pytest.raises(ElbowroomError, match=r"recording of trial .*\.B1"):
        export_study(store, stored, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert not [p for p in tmp_path.iterdir() if "partial" in p.name]


def test_a_failed_export_leaves_the_earlier_one_whole(store, fill, tmp_path):
    stored = fill(store, 1)
    export_study(store, stored, tmp_path / "out")
    before = contents(tmp_path / "out")
    store.recording_path(store.trials(stored)[-1]).unlink()
    with pytest.raises(ElbowroomError):
        export_study(store, stored, tmp_path / "out")
    assert contents(tmp_path / "out") == before


def test_progress_ends_complete(store, fill, tmp_path):
    seen = []
    export_study(
        store, fill(store, 1), tmp_path / "out", progress=lambda done, total, now: seen.append((done, total))
    )
    assert seen[0] == (0, 14)
    assert seen[-1] == (14, 14)
    assert seen == sorted(seen)


def test_a_study_that_nobody_took_part_in_yet_is_an_export_without_rows(store, study, tmp_path):
    stored = store.add_study(study, study_text("carmichael2017"))
    assert export_study(store, stored, tmp_path / "out").participants == 0
    assert sheet(tmp_path / "out", "responses") == []


@pytest.mark.parametrize(
    ("metric", "unit"),
    [("mean_force_n", "N"), ("jerk_rms_m_s3", "m/s3"), ("speed_m_s", "m/s"), ("gain", ""), ("t_s", "s")],
)
def test_the_unit_of_a_metric_stands_in_its_name(metric, unit):
    assert unit_in(metric) == unit
