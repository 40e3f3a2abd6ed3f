"""Recordings: nothing is lost, nothing is large, and what is no recording is refused in one line."""

import json
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from data.errors import InputError
from data.study import Study
from sim_trials.guidance import HAND
from sim_trials.operators import draw_operator
from sim_trials.recording import STATE_EVERY, file_sha256, read
from sim_trials.trial import TrialResult, replay, simulate

FirstLap = Callable[[str], TrialResult]


def test_what_is_written_is_read_to_the_last_bit(first_lap: FirstLap, tmp_path: Path) -> None:
    recording = first_lap("M1").recording
    path = tmp_path / "new folder" / "lap.parquet"
    sha256 = recording.write(path)
    assert sha256 == file_sha256(path)
    assert read(path, sha256) == recording
    assert read(path).facts == recording.facts
    assert [file.name for file in path.parent.iterdir()] == ["lap.parquet"]


def test_a_lap_from_disk_replays_bit_for_bit(study: Study, first_lap: FirstLap, tmp_path: Path) -> None:
    path = tmp_path / "lap.parquet"
    first_lap("M3").recording.write(path)
    assert replay(read(path), study) == first_lap("M3")


def test_the_same_lap_gives_the_same_bytes(first_lap: FirstLap, tmp_path: Path) -> None:
    recording = first_lap("M2").recording
    assert recording.write(tmp_path / "a.parquet") == recording.write(tmp_path / "b.parquet")
    other = first_lap("M3").recording
    assert other.write(tmp_path / "c.parquet") != recording.write(tmp_path / "b.parquet")


def test_the_longest_lap_takes_less_than_300_kb(study: Study, first_lap: FirstLap, tmp_path: Path) -> None:
    recording = first_lap("M2").recording
    recording.write(tmp_path / "lap.parquet")
    assert (tmp_path / "lap.parquet").stat().st_size < 150_000
    n = 15_000
    times = -(-n // recording.triggers.size)
    longest = replace(
        recording,
        counts=np.tile(recording.counts, (times, 1))[:n],
        triggers=np.tile(recording.triggers, times)[:n],
        # Fresh digits, so that repetition doesn't help the compression.
        states=_jittered(np.tile(recording.states, times)[: n // STATE_EVERY]),
    )
    longest.write(tmp_path / "longest.parquet")
    assert (tmp_path / "longest.parquet").stat().st_size < 300_000


def _jittered(states: np.ndarray) -> np.ndarray:
    rng, states = np.random.default_rng(0), states.copy()
    for name in states.dtype.names or ():
        states[name] *= 1.0 + 1e-4 * rng.standard_normal(states[name].shape).astype(np.float32)
    return states


def test_kept_states_are_every_fifth_of_the_full_rate_in_single_precision(
    study: Study, first_lap: FirstLap
) -> None:
    recording = first_lap("M2").recording
    facts = recording.facts
    full = simulate(study, "M2", draw_operator(facts.seed), seed=facts.seed).ticks[::5]
    assert recording.states.size == full.size
    for name in ("q", "sigma", "cursor_y", "tilt"):
        np.testing.assert_array_equal(recording.states[name], full[name].astype(np.float32))


def test_a_plain_parquet_reader_finds_named_columns_and_the_facts(
    study: Study, first_lap: FirstLap, tmp_path: Path
) -> None:
    path = tmp_path / "lap.parquet"
    first_lap("M1").recording.write(path)
    table = pq.read_table(path)
    assert {"force_x", "moment_z", "triggers", "q_1_rad", "qdot_6_rad_s", "sigma", "cursor_y_m"} <= set(
        table.column_names
    )
    facts = json.loads(table.schema.metadata[b"elbowroom"])
    assert facts["mode"] == "M1"
    assert facts["study_sha256"] == study.sha256
    assert facts["parameters"] == {"lambda0": 0.2, "sigma_t": 0.25}
    assert set(facts["versions"]) == {"elbowroom", "mujoco", "numba", "numpy"}


def altered(table: pa.Table, path: Path, **facts: object) -> Path:
    known = json.loads(table.schema.metadata[b"elbowroom"])
    table = table.replace_schema_metadata({b"elbowroom": json.dumps(known | facts).encode()})
    pq.write_table(table, path)
    return path


def test_a_recording_from_before_people_could_guide_is_still_read(
    study: Study, first_lap: FirstLap, tmp_path: Path
) -> None:
    path = tmp_path / "lap.parquet"
    first_lap("M2").recording.write(path)
    table = pq.read_table(path)
    facts = json.loads(table.schema.metadata[b"elbowroom"])
    del facts["hand"]
    old = json.dumps(facts | {"format": "lap/1"}).encode()
    pq.write_table(table.replace_schema_metadata({b"elbowroom": old}), path)
    assert read(path) == first_lap("M2").recording
    assert replay(read(path), study) == first_lap("M2")


def test_what_is_no_recording_is_refused_in_one_line(first_lap: FirstLap, tmp_path: Path) -> None:
    good = tmp_path / "good.parquet"
    sha256 = first_lap("M1").recording.write(good)
    content, table = good.read_bytes(), pq.read_table(good)
    (tmp_path / "text.parquet").write_text("time,force\n0,1\n")
    (tmp_path / "empty.parquet").write_bytes(b"")
    (tmp_path / "cut.parquet").write_bytes(content[:-1000])
    flipped = bytearray(content)
    flipped[len(content) // 3] ^= 0xFF
    (tmp_path / "flipped.parquet").write_bytes(flipped)
    pq.write_table(pa.table({"a": [1, 2]}), tmp_path / "other.parquet")
    altered(table, tmp_path / "format.parquet", format="lap/9")
    altered(table, tmp_path / "ending.parquet", ending=17)
    altered(table, tmp_path / "fact.parquet", mood="good")
    altered(table, tmp_path / "word.parquet", start_rad=["a"] * 6)
    altered(table, tmp_path / "list.parquet", operator=[1.0, 2.0])
    altered(table, tmp_path / "nobody.parquet", operator=None)
    altered(table, tmp_path / "two people.parquet", hand=asdict(HAND))
    altered(table, tmp_path / "stranger.parquet", operator=None, hand={"strength": 1.0})
    altered(table.drop_columns(["moment_y"]), tmp_path / "column.parquet")
    altered(table.slice(1), tmp_path / "gaps.parquet")
    altered(table.slice(0, 0), tmp_path / "rows.parquet")
    floats = table.column("force_x").cast(pa.float64())
    altered(table.set_column(0, "force_x", floats), tmp_path / "type.parquet")
    bad = sorted(set(tmp_path.glob("*.parquet")) - {good})
    assert len(bad) == 17
    for path in [*bad, tmp_path / "missing.parquet"]:
        with pytest.raises(InputError) as caught:
            read(path)
        assert str(caught.value).startswith(f"{path}: "), path.name
        assert "\n" not in str(caught.value), path.name
    with pytest.raises(InputError, match="not the file that was written"):
        read(good, "0" * 64)
    assert read(good, sha256) == first_lap("M1").recording


def test_a_failed_write_leaves_no_file_behind(
    first_lap: FirstLap, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "lap.parquet"
    first_lap("M1").recording.write(path)
    before = path.read_bytes()

    def full(*_: object, **__: object) -> None:
        raise OSError("No space left on device")

    monkeypatch.setattr("sim_trials.recording.pq.write_table", full)
    with pytest.raises(OSError, match="No space"):
        first_lap("M2").recording.write(path)
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["lap.parquet"]
