"""Trials and their replay under coded labels."""

import json
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from app.cohort import simulate_cohort
from app.console.browsing import participants_table, responses_table, trials_table
from app.console.labels import coded_labels
from app.console.quality import quality, repeat_agreement
from app.console.replay import COLUMNS, replay_content
from app.console.replay_page import common_damping_threshold, facts, replay_data
from app.console.trial_rows import Filter, TrialRow, lines, trial_rows
from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.studies import OpenedStudy, resolved_modes
from data.errors import InputError
from data.store import Store
from data.study_file import parse_study
from sim_trials.recording import STATE_EVERY, read

from .conftest import SECRETS, TINY_STUDY


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Desk]:
    """A rehearsal of the tiny study by one simulated participant, stored as if by a person."""
    study = parse_study(TINY_STUDY, "tiny.toml")
    with Store.open(tmp_path_factory.mktemp("trials") / "study.sqlite") as store:
        simulate_cohort(
            OpenedStudy(study, TINY_STUDY, resolved_modes(study, "tiny.toml")), store, 1, seed=3, n_jobs=1
        )
        stored = store.studies()[0]
        yield Desk(stored, store, LapKeeper(stored.study, store.recordings_folder, 1))


@pytest.fixture
def rows(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> tuple[TrialRow, ...]:
    show_simulated(monkeypatch)
    return trial_rows(desk)


def show_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("trial_rows", "browsing"):
        monkeypatch.setattr(f"app.console.{module}.includes_simulated", lambda: True)


def test_simulated_trials_are_listed_only_where_they_are_asked_for(desk: Desk) -> None:
    assert trial_rows(desk) == ()


def test_trials_are_listed_under_letters_alone(desk: Desk, rows: tuple[TrialRow, ...]) -> None:
    assert {row.label for row in rows} == {"X", "Y"}
    assert all({row.label, row.other_label} == {"X", "Y"} for row in rows)
    letters = coded_labels(desk.study)
    assert [row.label for row in rows] == [letters[row.trial.mode] for row in rows]
    assert not any(secret in repr(lines(rows)) for secret in SECRETS[:4])


def test_no_table_to_browse_names_a_mode(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    show_simulated(monkeypatch)
    tables = [responses_table(desk), trials_table(desk), participants_table(desk)]
    assert [len(table) for table in tables] == [2, 2, 1]
    assert {"A", "B", "answer"} <= set(tables[0])
    assert set(tables[0]["A"]) | set(tables[0]["B"]) == {"X", "Y"}
    assert not any(secret in table.to_csv() for table in tables for secret in SECRETS[:4])


def test_a_filter_lets_what_it_asks_for(rows: tuple[TrialRow, ...]) -> None:
    everything = Filter()
    assert all(everything.lets(row) for row in rows)
    assert [row.label for row in rows if Filter(labels=("X",)).lets(row)] == ["X"]
    assert not any(Filter(people=("P77",)).lets(row) for row in rows)
    stuck = Filter(outcomes=("stuck",))
    assert [stuck.lets(row) for row in rows] == [row.trial.outcome == "stuck" for row in rows]


def test_what_a_page_is_given_of_a_trial_names_no_mode(desk: Desk, rows: tuple[TrialRow, ...]) -> None:
    for row in rows:
        given = json.dumps(replay_data(desk.study, row, common_damping_threshold(desk.study)))
        assert not any(secret in given for secret in SECRETS[:4])
        assert facts(row)[0] == (f"{row.trial.slot} was", row.label)


def test_the_damping_threshold_is_shown_only_where_it_tells_no_mode_from_another() -> None:
    same = parse_study(TINY_STUDY, "tiny.toml")
    assert common_damping_threshold(same) == 0.25
    told = parse_study(TINY_STUDY.replace("0.6, sigma_t = 0.25", "0.6, sigma_t = 0.2"), "tiny.toml")
    assert common_damping_threshold(told) is None


def unpacked(content: bytes) -> tuple[dict[str, object], np.ndarray]:
    (length,) = struct.unpack_from("<I", content)
    head = json.loads(content[4 : 4 + length])
    start = 4 + length + head["lap_bytes"]
    return head, np.frombuffer(content, "<f4", offset=start).reshape(head["rows"], len(COLUMNS))


def test_a_replay_has_force_speed_sigma_and_phase_of_every_recorded_state(
    desk: Desk, rows: tuple[TrialRow, ...]
) -> None:
    trial = rows[0].trial
    path = desk.store.recording_path(trial)
    content = replay_content(path, trial.recording_sha256, desk.study, trial.duration_s, trial.outcome)
    head, series = unpacked(content)
    lap = read(path)
    assert head["doubt"] == ""
    assert head["rows"] == lap.states.size == pytest.approx(25 * trial.duration_s, abs=1)
    force, speed, sigma, phase = series.T
    counts = lap.counts[::STATE_EVERY, :3].astype(float)
    assert force == pytest.approx(np.linalg.norm(counts, axis=1) / 128, rel=1e-5)
    assert sigma == pytest.approx(lap.states["sigma"])
    assert speed.mean() == pytest.approx(trial.metrics["speed_mean_m_s"], rel=0.05)
    assert set(phase) <= set(range(len(head["phases"])))  # type: ignore[arg-type]
    assert force.mean() == pytest.approx(trial.metrics["force_mean_n"], rel=0.05)
    assert not any(secret.encode() in content for secret in SECRETS[:4])


def test_a_replay_says_so_where_the_lap_cannot_be_run_again(desk: Desk, rows: tuple[TrialRow, ...]) -> None:
    trial = rows[0].trial
    other = desk.study.model_copy(update={"seed": 6})
    path = desk.store.recording_path(trial)
    head, series = unpacked(replay_content(path, None, other, trial.duration_s, trial.outcome))
    assert "was made for study" in str(head["doubt"])
    assert len(series) == head["rows"]


def test_a_file_that_was_changed_is_not_replayed(
    desk: Desk, rows: tuple[TrialRow, ...], tmp_path: Path
) -> None:
    trial = rows[0].trial
    changed = tmp_path / "changed.parquet"
    changed.write_bytes(desk.store.recording_path(trial).read_bytes() + b"\0")
    with pytest.raises(InputError, match="not the file that was written"):
        replay_content(changed, trial.recording_sha256, desk.study, trial.duration_s, trial.outcome)


def answers(*given: tuple[str, str, str, str]) -> pd.DataFrame:
    """Rows of (comparison, mode A, mode B, answer) of one participant to one question."""
    return pd.DataFrame(
        {
            "participant": "p",
            "question": "Q1",
            "mode_a": [a for _, a, _, _ in given],
            "mode_b": [b for _, _, b, _ in given],
            "response": [answer for *_, answer in given],
            "comparison": [comparison for comparison, *_ in given],
            "check": [a == b for _, a, b, _ in given],
        }
    )


def test_a_preference_repeated_with_the_sides_swapped_agrees() -> None:
    assert repeat_agreement(answers(("1", "N", "M", "A>B"), ("2", "M", "N", "B>>A"))) == (1, 1)
    assert repeat_agreement(answers(("1", "N", "M", "A>B"), ("2", "M", "N", "A>B"))) == (0, 1)
    assert repeat_agreement(answers(("1", "N", "M", "A=B"), ("2", "N", "M", "A>B"))) == (0, 1)
    assert repeat_agreement(answers(("1", "N", "M", "A>B"), ("2", "N", "O", "A>B"))) == (0, 0)


def test_a_pair_that_is_behind_is_told_by_its_letters() -> None:
    given = [(str(k), "N", "M", "A>B") for k in range(6)] + [("9", "N", "O", "A>B")]
    found = {line.what: line.mark for line in quality(answers(*given), (), {"N": "X", "M": "Y", "O": "Z"})}
    assert found["Pair X and Z"].sign == "warn"
    assert found["Pair X and Z"].text == "1, others up to 6"


def test_of_what_was_not_measured_nothing_is_said() -> None:
    assert quality(None, (), {}) == ()
