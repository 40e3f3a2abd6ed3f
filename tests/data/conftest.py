"""What the tests of the ground floor share: the built-in study, a store with people in it."""

from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path

import pytest

from data.records import Comparison, Participant, Source, StuckEvent, Switch, Trial
from data.schedule import plan_session
from data.store import Store, StoredStudy
from data.study import Study
from data.study_file import read_study, study_text

NOON = datetime(2026, 3, 4, 12, 0, tzinfo=UTC)
Fill = Callable[..., StoredStudy]


@pytest.fixture(scope="session")
def study() -> Study:
    return read_study("carmichael2017")


@pytest.fixture
def noon() -> datetime:
    return NOON


@pytest.fixture(scope="session")
def empty_store(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A new store's file: copying it is faster than making it again."""
    path = tmp_path_factory.mktemp("template") / "empty.sqlite"
    Store.open(path).close()
    return path.read_bytes()


@pytest.fixture
def store(tmp_path: Path, empty_store: bytes) -> Iterator[Store]:
    (tmp_path / "study.sqlite").write_bytes(empty_store)
    with Store.open(tmp_path / "study.sqlite", clock=lambda: NOON) as opened:
        yield opened


@pytest.fixture
def fill(study: Study) -> Fill:
    """Puts participants with comparisons, trials, recordings and answers into a store."""

    def filled(store: Store, people: int = 2, source: Source = "human") -> StoredStudy:
        stored = store.add_study(study, study_text("carmichael2017"))
        for number in range(1, people + 1):
            who = f"{source[0]}-p{number:03d}"
            with store.transaction():
                store.add_participant(stored, Participant(who, number, source, NOON, {"age": "30-39"}))
                store.record_consent(who, "1", NOON)
                planned = plan_session(study, number)
                store.add_comparisons(
                    Comparison(
                        f"{who}.c{p.position:02d}", who, p.position, p.repetition, p.mode_a, p.mode_b, p.check
                    )
                    for p in planned
                )
                for comparison in store.comparisons(participant=who):
                    store.start_comparison(comparison.id, NOON)
                    store.add_switch(Switch(comparison.id, 1, "A", NOON))
                    for slot in ("A", "B"):
                        store.add_trial(a_trial(store, comparison, slot))
                    store.submit_responses(comparison.id, {q.name: "A>B" for q in study.questions}, NOON)
                store.finish_participant(who, NOON)
        return stored

    def a_trial(store: Store, comparison: Comparison, slot: str) -> Trial:
        name = f"{comparison.id}.{slot}1.parquet"
        content = f"recording of {name}".encode()
        (store.recordings_folder / name).write_bytes(content)
        mode = comparison.mode_of(slot)
        is_stuck = mode == "M1"
        return Trial(
            id=f"{comparison.id}.{slot}1",
            comparison=comparison.id,
            slot=slot,
            number=1,
            mode=mode,
            source="observed",
            outcome="stuck" if is_stuck else "completed",
            started_at=NOON,
            duration_s=31.25,
            seed=2**62 + 1,
            metrics={"force_mean_n": 17.5, "exit_force_n": float("nan")},
            events=(StuckEvent("stuck", 12.5, 0.0041, "edge", "sigma-dwell/1"),) if is_stuck else (),
            recording=name,
            recording_sha256=sha256(content).hexdigest(),
        )

    return filled
