"""Whatever is stored comes back from the store, from its export, and from a store rebuilt from that."""

import hashlib
import json
import tempfile
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from data.errors import ElbowroomError, InputError
from data.export import export_study
from data.records import (
    Comparison,
    Device,
    EventKind,
    ExternalRun,
    Outcome,
    Participant,
    Slot,
    Source,
    StuckEvent,
    Switch,
    Trial,
    TrialSource,
)
from data.restoring import import_export
from data.store import Store
from data.store.rows import same
from data.study_file import read_study, study_text

STUDY = read_study("carmichael2017")
TEXT = study_text("carmichael2017")

texts = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0"), max_size=20)
times = st.datetimes(datetime(1990, 1, 1), datetime(2100, 1, 1), timezones=st.just(UTC))
numbers = st.floats(allow_infinity=False)
metrics = st.dictionaries(st.from_regex(r"[a-z_]{1,12}", fullmatch=True), st.floats(), max_size=4)
events = st.builds(StuckEvent, st.sampled_from(get_args(EventKind)), numbers, numbers, texts, texts)


@st.composite
def sessions(draw):
    """A participant with a comparison, and any of what can have happened in it."""
    source = draw(st.sampled_from(get_args(Source)))
    participant = Participant(
        id=draw(st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,20}", fullmatch=True)),
        number=draw(st.integers(1, 10**6)),
        source=source,
        joined_at=draw(times),
        background=draw(st.dictionaries(texts, texts, max_size=3)),
        consent_version=draw(st.none() | texts),
        consented_at=draw(st.none() | times),
        finished_at=draw(st.none() | times),
        background_at=draw(st.none() | times),
        device=draw(st.none() | st.sampled_from(get_args(Device))),
        practised_at=draw(st.none() | times),
    )
    a, b = draw(st.permutations(STUDY.mode_names))[:2]
    comparison = Comparison(
        f"{participant.id}.c1",
        participant.id,
        1,
        draw(st.integers(0, 9)),
        a,
        b,
        draw(st.booleans()),
        draw(st.none() | times),
        restarted_at=draw(st.none() | times),
    )
    trials = []
    for number in range(draw(st.integers(0, 2))):
        content = draw(st.none() | st.binary(max_size=30))
        name = f"{comparison.id}.A{number + 1}"
        trial = Trial(
            id=name,
            comparison=comparison.id,
            slot="A",
            number=number + 1,
            mode=a,
            source=draw(st.sampled_from(get_args(TrialSource))),
            outcome=draw(st.sampled_from(get_args(Outcome))),
            started_at=draw(times),
            duration_s=draw(numbers),
            seed=draw(st.integers(-(2**63), 2**63 - 1)),
            metrics=draw(metrics),
            events=tuple(draw(st.lists(events, max_size=2))),
            recording=None if content is None else f"{name}.parquet",
            recording_sha256=None if content is None else hashlib.sha256(content).hexdigest(),
        )
        trials.append((trial, content))
    switches = [
        Switch(comparison.id, n + 1, draw(st.sampled_from("AB")), draw(times))
        for n in range(draw(st.integers(0, 3)))
    ]
    answers = draw(
        st.none() | st.fixed_dictionaries({q.name: st.sampled_from(q.scale) for q in STUDY.questions})
    )
    run = None
    if draw(st.booleans()):
        loaded = draw(st.none() | st.sampled_from(get_args(Slot)))
        started = draw(st.none() | times) if loaded else None
        run = ExternalRun(comparison.id, draw(st.sampled_from(get_args(Slot))), loaded, started)
    is_withdrawn = draw(st.booleans())
    return participant, comparison, trials, switches, answers, draw(times), run, is_withdrawn


cohorts = st.lists(sessions(), max_size=3, unique_by=lambda session: session[0].id.lower()).filter(
    lambda cohort: len({(s[0].source, s[0].number) for s in cohort}) == len(cohort)
)


def put(store: Store, cohort):
    stored = store.add_study(STUDY, TEXT)
    for participant, comparison, trials, switches, answers, at, run, is_withdrawn in cohort:
        store.add_participant(stored, participant)
        store.add_comparisons([comparison])
        for trial, content in trials:
            if content is not None:
                (store.recordings_folder / trial.recording).write_bytes(content)
            store.add_trial(trial)
        for switch in switches:
            store.add_switch(switch)
        if answers is not None:
            store.submit_responses(comparison.id, answers, at)
        if run is not None:
            store.want_slot(run.comparison, run.wanted)
            store.load_slot(run.comparison, run.loaded)
            if run.started_at is not None:
                store.start_run(run.comparison, run.started_at)
            assert store.external_run(run.comparison) == run
        store.log(participant.id, "took part", {"note": participant.consent_version or ""}, at)
        if is_withdrawn:
            store.withdraw(participant.id, "somebody", at)
    return stored


def everything(store: Store):
    study = store.study()
    comparisons = store.comparisons(study)
    return (
        replace(study, id=0),
        store.participants(study),
        comparisons,
        store.trials(study),
        tuple(store.responses(c.id) for c in comparisons),
        tuple(store.switches(c.id) for c in comparisons),
        tuple(store.external_run(c.id) for c in comparisons),
        store.audit_log(),
    )


def files(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@given(cohort=cohorts)
@settings(max_examples=25, deadline=None)
def test_records_survive_the_store_its_export_and_a_store_rebuilt_from_that(empty_store, cohort):
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for name in ("one", "two"):
            (folder / f"{name}.sqlite").write_bytes(empty_store)
        with Store.open(folder / "one.sqlite") as one, Store.open(folder / "two.sqlite") as two:
            study = put(one, cohort)
            kept = everything(one)
            given_people = {participant.id: participant for participant, *_, gone in cohort if not gone}
            assert {p.id: p for p in kept[1] if p.withdrawn_at is None} == given_people
            given_trials = {
                trial.id: trial for _, _, trials, *_, gone in cohort for trial, _ in trials if not gone
            }
            assert all(same(trial, given_trials[trial.id]) for trial in kept[3])
            assert len(kept[3]) == len(given_trials)

            export_study(one, study, folder / "out", include_simulated=True)
            import_export(folder / "out", two)
            assert same(everything(two), kept)
            assert two.verify_audit().is_intact
            export_study(two, two.study(), folder / "again", include_simulated=True)
            assert files(folder / "again") == files(folder / "out")
            assert import_export(folder / "out", two) == 0


def test_links_sessions_numbers_and_imports_are_rebuilt_too(store, fill, noon, tmp_path, study):
    stored = fill(store, 1)
    store.create_link("participant", stored, "t", label="door")
    store.redeem_participant_link("t", "late", noon)
    store.open_session("c", stored, "late")
    export_study(store, stored, tmp_path / "out")
    with Store.open(tmp_path / "other.sqlite") as other:
        import_export(tmp_path / "out", other)
        rebuilt = other.study()
        assert other.links(rebuilt) == store.links(stored)
        assert other.session("c").participant == "late"
        assert other.next_number(rebuilt, "human") == store.next_number(stored, "human") == 3
        assert rebuilt.locked


def test_a_changed_or_missing_file_is_found_before_anything_is_written(store, fill, tmp_path):
    export_study(store, fill(store, 1), tmp_path / "out")
    with Store.open(tmp_path / "other.sqlite") as other:
        path = tmp_path / "out" / "raw" / "responses.jsonl"
        path.write_text(path.read_text().replace("A>B", "B>A", 1))
        with pytest.raises(InputError, match=r"responses\.jsonl: was changed after the export"):
            import_export(tmp_path / "out", other)
        path.unlink()
        with pytest.raises(InputError, match=r"responses\.jsonl: the file is missing"):
            import_export(tmp_path / "out", other)
        assert other.studies() == ()


@pytest.mark.parametrize("content", [None, "", "{}", "[]", '{"resources": [{"path": "../x", "hash": "y"}]}'])
def test_a_folder_that_is_no_export_is_refused(store, tmp_path, content):
    folder = tmp_path / "folder"
    folder.mkdir()
    if content is not None:
        (folder / "datapackage.json").write_text(content)
    with pytest.raises(InputError) as raised:
        import_export(folder, store)
    assert "\n" not in str(raised.value)


def test_a_store_with_other_data_in_the_same_place_is_left_alone(store, fill, tmp_path, noon):
    export_study(store, fill(store, 2), tmp_path / "out")
    with Store.open(tmp_path / "other.sqlite") as other:
        study = fill(other, 1)
        other.log("somebody", "was here", at=noon)
        store.log("somebody else", "was here", at=noon)
        export_study(store, store.study(), tmp_path / "out")
        before = everything(other)
        with pytest.raises(ElbowroomError, match="import into a new store"):
            import_export(tmp_path / "out", other)
        assert same(everything(other), before)
        assert len(other.participants(study)) == 1


def test_the_raw_rows_are_strict_json(store, fill, tmp_path):
    export_study(store, fill(store, 1), tmp_path / "out")

    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    for path in (tmp_path / "out").rglob("*.json*"):
        texts = path.read_text().split("\n") if path.suffix == ".jsonl" else [path.read_text()]
        for text in filter(None, texts):
            json.loads(text, parse_constant=refuse)
