"""Answers and stuck events from elsewhere: whole or not at all, and once."""

from pathlib import Path

import pytest

from data.errors import InputError
from data.export import export_study
from data.importing import import_responses
from data.store import Store
from data.stuck_importing import import_stuck
from data.study_file import study_text

TEXT = study_text("carmichael2017")
HEADER = "participant,question,mode_a,mode_b,response"


def write(folder: Path, text: str, name: str = "given.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def bring(store, study, tmp_path):
    """Imports responses written as text; gives back how many were added."""
    return lambda text: import_responses(write(tmp_path, text), study, TEXT, store)


def test_an_imported_file_gives_the_answers_it_holds(store, bring):
    added = bring(f"{HEADER}\nAnna,Q1,M1,M2,A>>B\nAnna,Q4,M1,M2,A=B\nשרה,Q1,M3,M1,B>A\n")
    rows = store.responses_table(store.study()).rows
    assert added == 3
    assert rows[["question", "mode_a", "mode_b", "response"]].values.tolist() == [
        ["Q1", "M1", "M2", "A>>B"],
        ["Q4", "M1", "M2", "A=B"],
        ["Q1", "M3", "M1", "B>A"],
    ]
    assert rows["comparison"].nunique() == 2
    people = store.participants(store.study())
    assert (people[0].id, dict(people[0].background)) == ("Anna", {})
    assert dict(people[1].background) == {"imported_as": "שרה"}
    assert store.verify_audit().entries == 1


def test_the_same_file_again_changes_nothing(store, bring):
    text = f"{HEADER}\nAnna,Q1,M1,M2,A>>B\n"
    assert (bring(text), bring(text)) == (1, 0)
    assert len(store.responses_table(store.study()).rows) == 1


def test_a_longer_file_adds_what_is_new_when_comparisons_are_named(store, bring):
    first = "Anna,Q1,M1,M2,A>B,1\nAnna,Q1,M2,M3,A>B,2\n"
    assert bring(f"{HEADER},comparison\n{first}") == 2
    assert bring(f"{HEADER},comparison\n{first}Anna,Q2,M1,M2,A=B,1\nBea,Q1,M1,M2,A>B,1\n") == 2
    table = store.responses_table(store.study()).rows
    assert sorted(table["comparison"].unique()) == ["Anna.1", "Anna.2", "Bea.1"]


def test_a_count_is_as_many_comparisons(store, bring):
    assert bring(f"{HEADER},count\nAnna,Q1,M1,M2,A>B,3\nAnna,Q1,M1,M2,B>A,2\nAnna,Q2,M1,M2,A=B,4\n") == 9
    rows = store.responses_table(store.study()).rows
    assert rows.groupby("response").size().to_dict() == {"A=B": 4, "A>B": 3, "B>A": 2}
    assert rows["comparison"].nunique() == 5


def test_answers_without_participants_stay_pooled(store, bring, tmp_path, study):
    bring("question,mode_a,mode_b,response,count\nQ1,M1,M2,A>B,5\nQ1,M2,M3,B>A,2\n")
    table = store.responses_table(store.study())
    assert not table.has_participants
    assert len(table.rows) == 7
    with pytest.raises(InputError, match="holds responses without"):
        bring(f"{HEADER}\nAnna,Q1,M1,M2,A>>B\n")
    export_study(store, store.study(), tmp_path / "out")
    assert "participant" not in (tmp_path / "out" / "responses.csv").read_text().splitlines()[0].split(",")


def test_answers_without_participants_are_refused_where_people_are_known(store, bring, fill):
    fill(store, 1)
    with pytest.raises(InputError, match="the column participant is missing"):
        bring("question,mode_a,mode_b,response\nQ1,M1,M2,A>B\n")


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            "Anna,Q1,M1,M2,A>B,1\nAnna,Q1,M1,M2,B>A,1\n",
            "question 'Q1', has 'A>B' in line 2, but 'B>A' here",
        ),
        (
            "Anna,Q1,M1,M2,A>B,1\nAnna,Q2,M2,M1,B>A,1\n",
            "line 3, mode_a: comparison '1' of participant 'Anna' has 'M1' in line 2, but 'M2'",
        ),
        ("Bea,Q1,M1,M2,A>B,1\nAnna,Q7,M1,M2,B>A,1\n", "line 3, question: 'Q7'"),
    ],
)
def test_a_file_that_contradicts_itself_is_refused_whole(store, bring, rows, message):
    with pytest.raises(InputError, match=message):
        bring(f"{HEADER},comparison\n{rows}")
    assert store.studies() == ()
    assert store.audit_log() == ()


def test_an_answer_that_contradicts_the_store_is_refused_whole(store, bring):
    bring(f"{HEADER},comparison\nAnna,Q1,M1,M2,A>B,1\n")
    before = store.responses_table(store.study()).sha256
    with pytest.raises(InputError, match="the store has A>B, not B>A"):
        bring(f"{HEADER},comparison\nBea,Q1,M1,M2,A>B,1\nAnna,Q1,M1,M2,B>A,1\n")
    assert store.responses_table(store.study()).sha256 == before


def test_one_person_is_not_both_human_and_simulated(bring):
    with pytest.raises(InputError, match="both human and simulated"):
        bring(f"{HEADER},source\nAnna,Q1,M1,M2,A>B,human\nAnna,Q1,M1,M3,A>B,simulated\n")


def test_imported_simulated_answers_stay_simulated(store, bring):
    bring(f"{HEADER},source\nAnna,Q1,M1,M2,A>B,simulated\n")
    with pytest.raises(InputError, match="--include-simulated"):
        store.responses_table(store.study())
    assert store.responses_table(store.study(), include_simulated=True).is_simulated


def test_an_absurd_count_is_refused(bring):
    with pytest.raises(InputError, match="at most 200000"):
        bring(f"{HEADER},count\nAnna,Q1,M1,M2,A>B,200001\n")


def test_an_exports_own_files_can_be_imported(store, fill, study, tmp_path):
    stored = fill(store, 2)
    export_study(store, stored, tmp_path / "out")
    with Store.open(tmp_path / "other.sqlite") as other:
        assert import_responses(tmp_path / "out" / "responses.csv", study, TEXT, other) == 72
        assert import_stuck(tmp_path / "out" / "stuck_events.csv", study, TEXT, other) == 8
        theirs, ours = other.responses_table(other.study()), store.responses_table(stored)
        assert theirs.rows.equals(ours.rows)
        columns = ["participant", "comparison", "mode", "stuck"]
        stuck = other.stuck_table(other.study()).rows
        assert stuck["exposure_s"].isna().all()
        assert stuck[columns].equals(store.stuck_table(stored).rows[columns])


@pytest.fixture
def collected(store, bring):
    """A store with three comparisons of two people and no trials."""
    bring(f"{HEADER},comparison\nAnna,Q1,M1,M2,A>B,1\nAnna,Q1,M2,M3,A>B,2\nBea,Q1,M3,M1,A>B,1\n")
    return store


def stuck_pairs(store: Store) -> dict[tuple[str, str], bool]:
    rows = store.stuck_table(store.study()).rows
    return {(row.comparison, row.mode): row.stuck for row in rows.itertuples()}


def test_nobody_is_a_participant_of_answers_without_participants(store, bring, study, tmp_path):
    bring("question,mode_a,mode_b,response,comparison\nQ1,M1,M2,A>B,1\nQ1,M2,M3,B>A,2\n")
    path = write(tmp_path, "comparison,mode,stuck\n1,M1,true\n2,M2,false\n", "stuck.csv")
    import_stuck(path, study, TEXT, store)
    rows = store.stuck_table(store.study()).rows
    assert set(rows["participant"]) == {""}
    assert rows["stuck"].sum() == 1


def test_statements_count_only_the_comparisons_they_name(collected, study, tmp_path):
    path = write(tmp_path, "participant,comparison,mode,stuck\nAnna,1,M1,true\nBea,1,M1,FALSE\n", "stuck.csv")
    assert import_stuck(path, study, TEXT, collected) == 1
    assert import_stuck(path, study, TEXT, collected) == 0
    assert stuck_pairs(collected) == {
        ("Anna.1", "M1"): True,
        ("Anna.1", "M2"): False,
        ("Bea.1", "M3"): False,
        ("Bea.1", "M1"): False,
    }


def test_a_list_of_events_says_that_nothing_else_happened(collected, study, tmp_path):
    path = write(
        tmp_path,
        "participant,comparison,mode,kind,time_s\nAnna,1,M1,stuck,12.5\nAnna,2,M3,protective_stop,\n",
    )
    assert import_stuck(path, study, TEXT, collected) == 2
    pairs = stuck_pairs(collected)
    assert len(pairs) == 6
    assert [pair for pair, stuck in pairs.items() if stuck] == [("Anna.1", "M1")]
    assert [t.events[0].time_s for t in collected.trials() if t.outcome == "stuck"] == [12.5]


def events(store: Store) -> int:
    return sum(len(trial.events) for trial in store.trials())


def test_a_repeated_statement_is_one_event_and_is_said(collected, study, tmp_path):
    text = "participant,comparison,mode,stuck\nAnna,1,M1,true\nAnna,1,M2,false\nAnna,1,M1,TRUE\n"
    notes: list[str] = []
    path = write(tmp_path, text, "stuck.csv")
    assert import_stuck(path, study, TEXT, collected, note=notes.append) == 1
    assert events(collected) == 1
    assert notes == ["1 row repeats an earlier one and is counted once."]


def test_two_events_of_a_kind_at_one_time_are_one_and_without_times_two(collected, study, tmp_path):
    header = "participant,comparison,mode,kind,time_s\n"
    timed = write(tmp_path, header + "Anna,1,M1,stuck,4.5\n" * 2, "a.csv")
    assert import_stuck(timed, study, TEXT, collected) == 1
    untimed = write(tmp_path, header + "Bea,1,M1,stuck,\n" * 2, "b.csv")
    assert import_stuck(untimed, study, TEXT, collected) == 2


def test_a_list_of_events_that_has_grown_adds_the_new_ones_alone(collected, study, tmp_path):
    header, first = "participant,comparison,mode,stuck\n", "Anna,1,M1,true\n"
    assert import_stuck(write(tmp_path, header + first, "a.csv"), study, TEXT, collected) == 1
    notes: list[str] = []
    longer = write(tmp_path, f"{header}{first}Anna,2,M3,true\n", "b.csv")
    assert import_stuck(longer, study, TEXT, collected, note=notes.append) == 1
    assert events(collected) == 2
    assert notes == ["1 of 2 events are in the store already, and are not added again."]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "participant,comparison,mode,stuck\nAnna,1,M1,true\nAnna,1,M1,false\n",
            "line 3, stuck: says the contrary of line 2",
        ),
        ("participant,comparison,mode\nAnna,1,M1\n", "line 1: a column stuck or kind is needed"),
        ("participant,mode,stuck\nAnna,M1,true\n", "line 1: the column comparison is missing"),
        (
            "participant,comparison,mode,stuck\nAnna,9,M1,true\n",
            "line 2, comparison: '9' is not in the store",
        ),
        (
            "participant,comparison,mode,stuck\nAnna,1,M1,true\nAnna,1,M3,true\n",
            "line 3, mode: 'M3' was not shown",
        ),
        (
            "participant,comparison,mode,stuck\nAnna,1,M8,true\n",
            "line 2, mode: 'M8' is not one of: M1, M2, M3",
        ),
        ("participant,comparison,mode,stuck\nAnna,1,M1,maybe\n", "line 2, stuck: 'maybe' is not one of"),
        (
            "participant,comparison,mode,kind\nAnna,1,M1,locked\n",
            "line 2, kind: 'locked' is not one of: stuck",
        ),
        ("participant,comparison,mode,kind,time_s\nAnna,1,M1,stuck,-1\n", "line 2, time_s: '-1'"),
        ("participant,comparison,mode,kind,time_s\nAnna,1,M1,stuck,nan\n", "line 2, time_s: 'nan'"),
        ("participant,comparison,mode,stuck\n", "a header without rows: there are no stuck events"),
    ],
)
def test_a_bad_stuck_file_is_one_line_and_adds_nothing(collected, study, tmp_path, text, message):
    with pytest.raises(InputError) as raised:
        import_stuck(write(tmp_path, text, "stuck.csv"), study, TEXT, collected)
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)
    assert collected.trials() == ()
