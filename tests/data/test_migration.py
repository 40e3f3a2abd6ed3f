"""A store made by an earlier Elbowroom: opened, it keeps every row and takes what is new."""

import json
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from data.errors import ElbowroomError
from data.export import export_study
from data.importing import import_responses
from data.records import Trial
from data.restoring import import_export
from data.store import Store, schema
from data.study_file import parse_study, with_trial_source

TABLES = (
    "studies",
    "allocations",
    "participants",
    "comparisons",
    "trials",
    "stuck_events",
    "responses",
    "switches",
    "links",
    "sessions",
    "imports",
    "audit",
)
OLD_STUDY = """format = 1
name = "early"
title = "Early"
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
[protocol]
repetitions = 1
"""
OLD_SHA256 = "17a9d29f6f967ed1c18b160ca0a35a814db17e9d63de66232114ca69480a06ee"
"""Of that text, as the first schema's Elbowroom computed it."""
WHEN = "2026-03-04 12:00:00.000000"


@pytest.fixture
def old_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A store of schema 0001 with a person, two comparisons, observed trials and stuck events."""
    path = tmp_path / "old.sqlite"
    with monkeypatch.context() as early:
        early.setattr(schema, "NEWEST", "0001")
        Store.open(path).close()
    rows = {
        "studies": [(1, "early", 1, "1", OLD_SHA256, OLD_STUDY, 1)],
        "allocations": [(1, "human", 1)],
        "participants": [("anna", 1, 1, "human", WHEN, '{"age": "40"}', "1", WHEN, None, 0)],
        "comparisons": [
            ("anna.c1", "anna", 1, 1, "M1", "M2", 0, WHEN, WHEN),
            ("anna.c2", "anna", 2, 1, "M2", "M1", 0, WHEN, None),
        ],
        "trials": [
            (
                f"{c}.{slot}1",
                c,
                slot,
                1,
                mode,
                source,
                outcome,
                WHEN,
                duration,
                2**62,
                '{"x_n": null}',
                None,
                None,
            )
            for c, slot, mode, source, outcome, duration in (
                ("anna.c1", "A", "M1", "observed", "stuck", 31.25),
                ("anna.c1", "B", "M2", "external", "completed", None),
                ("anna.c2", "A", "M2", "simulated", "abandoned", 0.5),
            )
        ],
        "stuck_events": [
            ("anna.c1.A1", 1, "stuck", 12.5, 0.0041, "edge", "sigma-dwell/1"),
            ("anna.c1.A1", 2, "elbow_inversion", None, None, "", "external"),
        ],
        "responses": [("anna.c1", "Q1", "A>B", WHEN)],
        "switches": [("anna.c1", 1, "A", WHEN)],
        "links": [("l", 1, "personal", "door", WHEN, None, WHEN, "anna")],
        "sessions": [("c", 1, "anna", WHEN)],
        "imports": [(1, "responses", "f", WHEN, 0)],
    }
    with closing(sqlite3.connect(path)) as database:
        for table, values in rows.items():
            places = ", ".join("?" * len(values[0]))
            database.executemany(f"INSERT INTO {table} VALUES ({places})", values)
        database.commit()
    return path


def contents(path: Path) -> dict[str, list[dict[str, object]]]:
    """All rows by table, in the order in which they were written."""
    with closing(sqlite3.connect(path)) as database:
        database.row_factory = sqlite3.Row
        return {
            table: [dict(row) for row in database.execute(f"SELECT * FROM {table} ORDER BY rowid")]
            for table in TABLES
        }


@pytest.fixture
def migrated(old_store: Path) -> Iterator[Store]:
    with Store.open(old_store, create=False) as store:
        yield store


def test_every_row_of_an_older_store_is_kept(old_store):
    before = contents(old_store)
    Store.open(old_store, create=False).close()
    after = contents(old_store)
    for table in TABLES:
        shared = [
            {name: row[name] for name in old} for row, old in zip(after[table], before[table], strict=True)
        ]
        if table == "studies":
            assert shared[0].pop("toml") == with_trial_source(str(before[table][0].pop("toml")))
        assert shared == before[table], table
    assert len(after["stuck_events"]) == 2
    with closing(sqlite3.connect(old_store)) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert database.execute("PRAGMA foreign_key_check").fetchall() == []


def test_the_records_of_an_older_store_read_as_they_were_written(migrated):
    anna = migrated.participant("anna")
    assert (anna.number, anna.background, anna.consent_version) == (1, {"age": "40"}, "1")
    assert (anna.background_at, anna.device, anna.practised_at, anna.withdrawn_at) == (None,) * 4
    assert [c.restarted_at for c in migrated.comparisons()] == [None, None]
    assert [(t.id, t.outcome, len(t.events)) for t in migrated.trials()] == [
        ("anna.c1.A1", "stuck", 2),
        ("anna.c1.B1", "completed", 0),
        ("anna.c2.A1", "abandoned", 0),
    ]


def test_an_older_store_takes_guided_trials_and_still_no_others(migrated, noon):
    trial = Trial("anna.c2.B1", "anna.c2", "B", 1, "M1", "guided", "completed", noon, 30.0, 0)
    migrated.add_trial(trial)
    assert migrated.trial("anna.c2.B1") == trial
    other = replace(trial, id="anna.c2.B2", number=2)
    for wrong in (replace(other, source="dreamt"), replace(other, outcome="lost"), replace(other, slot="A")):
        with pytest.raises(ElbowroomError):
            migrated.add_trial(wrong)
    with pytest.raises(ElbowroomError, match="UNIQUE"):
        migrated.add_trial(replace(trial, id="anna.c2.B9"))
    with pytest.raises(ElbowroomError, match="valid_device"):
        migrated.record_device("anna", "eye")


def test_an_older_store_still_refuses_events_of_no_trial(migrated):
    with pytest.raises(ElbowroomError, match="FOREIGN KEY"), migrated.transaction() as connection:
        connection.exec_driver_sql("INSERT INTO stuck_events VALUES ('nobody', 1, 'stuck', 1, 1, '', '')")


def test_a_study_that_could_only_be_observed_stays_observed_and_keeps_its_hash(migrated):
    stored = migrated.study()
    assert stored.study.protocol.trial_source == "observed"
    assert stored.study.sha256 == stored.sha256 == OLD_SHA256


@pytest.mark.parametrize(
    "protocol",
    ["[protocol]\nrepetitions = 1\n", "[ protocol ] # how\r\nrepetitions = 1\r\n", "[protocol]"],
)
def test_a_text_with_a_protocol_says_afterwards_that_laps_were_observed(protocol):
    text = OLD_STUDY.replace("[protocol]\nrepetitions = 1\n", protocol)
    assert parse_study(with_trial_source(text), "old").protocol.trial_source == "observed"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("[protocol]\nrepetitions = 1\n", ""),
        ("[protocol]\nrepetitions = 1\n", "[maze]\n"),
    ],
)
def test_a_text_without_a_protocol_says_afterwards_that_laps_were_observed(old, new):
    said = parse_study(with_trial_source(OLD_STUDY.replace(old, new)), "old")
    assert said.protocol.trial_source == "observed"
    inline = OLD_STUDY.replace("[protocol]\nrepetitions = 1\n", "")
    inline = inline.replace('title = "Early"', 'title = "Early"\nprotocol = { repetitions = 1 }')
    assert parse_study(with_trial_source(inline), "old").protocol.trial_source == "observed"


def test_a_text_that_says_who_moves_the_robot_stays_as_it_is():
    text = OLD_STUDY + 'trial_source = "guided"\n'
    assert with_trial_source(text) == text
    hidden = OLD_STUDY.replace('text = "Agreed?"', 'text = """\n[protocol]\n"""')
    assert parse_study(with_trial_source(hidden), "old").consent.text == "[protocol]"


def test_an_export_of_the_first_format_is_rebuilt(migrated, tmp_path):
    folder = tmp_path / "out"
    export_study(migrated, migrated.study(), folder)
    first_format(folder)
    with Store.open(tmp_path / "new.sqlite") as rebuilt:
        assert import_export(folder, rebuilt) > 0
        assert rebuilt.study().toml == migrated.study().toml
        assert rebuilt.participants(rebuilt.study()) == migrated.participants(migrated.study())
        assert len(rebuilt.trials()) == 3
        assert import_export(folder, rebuilt) == 0


def first_format(folder: Path) -> None:
    """Make an export what the first format was: without the new columns and the new table."""
    import hashlib

    package = json.loads((folder / "datapackage.json").read_text())
    package["elbowroom"]["format"] = 1
    (folder / "raw" / "external_runs.jsonl").unlink()
    later = {"background_at", "device", "practised_at", "withdrawn_at", "restarted_at"}
    for table in ("participants", "comparisons", "studies"):
        path = folder / "raw" / f"{table}.jsonl"
        rows = [json.loads(line) for line in path.read_text().splitlines()]
        kept = [{k: v for k, v in row.items() if k not in later} for row in rows]
        for row in kept:
            if table == "studies":
                row["toml"] = OLD_STUDY
        path.write_text("".join(json.dumps(row) + "\n" for row in kept))
    package["resources"] = [r for r in package["resources"] if "external_runs" not in r["path"]]
    for resource in package["resources"]:
        content = (folder / resource["path"]).read_bytes()
        resource["hash"] = f"sha256:{hashlib.sha256(content).hexdigest()}"
    (folder / "datapackage.json").write_text(json.dumps(package))


def test_answers_can_be_imported_into_an_older_store(migrated, tmp_path):
    path = tmp_path / "answers.csv"
    path.write_text("participant,question,mode_a,mode_b,response\nbert,Q1,M1,M2,A=B\n")
    stored = migrated.study()
    assert import_responses(path, stored.study, stored.toml, migrated) == 1
