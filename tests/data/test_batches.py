"""Files without comparisons: other batches pass, a continued file is never counted twice."""

from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from data.batches import Batch, UnnamedAnswer, batch_name, repetitions
from data.errors import InputError
from data.importing import import_responses
from data.records import Comparison, Participant
from data.study_file import study_text

TEXT = study_text("carmichael2017")
HEADER = "participant,question,mode_a,mode_b,response"
ROW = st.tuples(
    st.sampled_from(["Anna", "Bea"]),
    st.sampled_from(["Q1", "Q2"]),
    st.sampled_from(["M1,M2", "M2,M1", "M2,M3", "M3,M1"]),
    st.sampled_from(["A>>B", "A>B", "A=B", "B>A", "B>>A"]),
)
FILE = st.lists(ROW, min_size=6, max_size=16)
many = settings(max_examples=300, deadline=None)


def answers(rows) -> tuple[UnnamedAnswer, ...]:
    return tuple(UnnamedAnswer(who, q, *pair.split(","), answer, 1, False) for who, q, pair, answer in rows)


def rows_alike(new, earlier) -> int:
    return sum(r.rows for r in repetitions(answers(new), [Batch("b", answers(earlier), None)]))


@given(FILE, st.lists(ROW, max_size=6), st.randoms())
@many
def test_a_file_that_holds_an_earlier_one_repeats_it_in_whatever_order(earlier, more, random):
    longer = [*earlier, *more]
    random.shuffle(longer)
    assert rows_alike(longer, earlier) == len(earlier)
    assert rows_alike(earlier, longer) == len(earlier)


@given(FILE, st.integers(0, 15), st.lists(ROW, max_size=6))
@many
def test_a_longer_file_with_one_row_put_right_still_repeats_the_earlier(earlier, place, more):
    earlier = (earlier * 3)[:20]
    put_right = [*earlier]
    who, question, pair, answer = put_right[place]
    put_right[place] = (who, question, pair, "A=B" if answer != "A=B" else "A>B")
    assert rows_alike([*put_right, *more], earlier) >= len(earlier) - 1


@given(FILE, FILE)
@many
def test_a_file_with_rows_of_its_own_in_both_directions_is_another_batch(one, other):
    """As many as one in ten of the smaller: then neither holds the other, in whole or nearly."""
    for who in {row[0] for row in one} & {row[0] for row in other}:
        fewest = min(sum(row[0] == who for row in rows) for rows in (one, other))
        one = [(who, "Q1", "M1,M2", "A>>B")] * (fewest // 5 + 2) + one
        other = [(who, "Q1", "M1,M2", "B>>A")] * (fewest // 5 + 2) + other
    both = {row[0] for row in one} & {row[0] for row in other}
    mine, theirs = ([row for row in rows if row[0] in both] for rows in (one, other))
    fewer = min(len(mine), len(theirs))
    shared = sum(min(mine.count(row), theirs.count(row)) for row in set(mine))
    assume(shared < 0.9 * fewer)
    assert rows_alike(one, other) == 0


@given(st.randoms(use_true_random=False), st.integers(12, 40))
@settings(max_examples=200, deadline=None)
def test_the_same_people_on_another_day_are_another_batch_while_one_answer_in_five_differs(random, n):
    pairs = ["M1,M2", "M2,M3", "M3,M1"]
    day = [("Anna", "Q1", pairs[k % 3], random.choice(["A>B", "A=B", "B>A"])) for k in range(n)]
    turned = {"A>B": "B>A", "B>A": "A=B", "A=B": "A>>B"}
    next_day = [(*row[:3], turned[row[3]]) if k % 5 == 0 else row for k, row in enumerate(day)]
    random.shuffle(day)
    assume(sorted(day) != sorted(next_day))
    in_place = sum(a == b for a, b in zip(day, next_day, strict=True))
    assume(in_place < 0.9 * n and any(day.count(row) > next_day.count(row) for row in day))
    assert rows_alike(next_day, day) == 0


@pytest.fixture
def bring(store, study, tmp_path):
    """Imports rows written as text; gives back how many answers were added."""

    def imported(rows: list[str], repeats=None, header: str = HEADER) -> int:
        path = Path(tmp_path) / f"{abs(hash((header, *rows)))}.csv"
        path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
        return import_responses(path, study, TEXT, store, repeats=repeats)

    return imported


FIRST = ["Anna,Q1,M1,M2,A>B", "Anna,Q2,M1,M2,A=B", "Anna,Q1,M1,M2,B>A", "Bea,Q1,M2,M3,A>>B"]


def test_a_continued_file_adds_its_new_rows_to_the_same_comparisons(store, bring):
    assert bring(FIRST) == 4
    assert bring([*FIRST, "Anna,Q2,M1,M2,B>A", "Cleo,Q1,M2,M3,A>B"], "continues") == 2
    rows = store.responses_table(store.study()).rows
    by_comparison = rows[rows["participant"] == "Anna"].groupby("comparison")["response"].apply(list)
    assert sorted(by_comparison) == [["A>B", "A=B"], ["B>A", "B>A"]]
    assert bring([*FIRST, "Anna,Q2,M1,M2,B>A", "Cleo,Q1,M2,M3,A>B", "Cleo,Q2,M2,M3,A>B"], "continues") == 1


def test_a_second_batch_is_further_comparisons_of_the_same_people(store, bring):
    assert bring(FIRST) == 4
    assert bring(["Anna,Q1,M1,M2,B>>A", "Anna,Q2,M1,M2,B>A", "Bea,Q1,M2,M3,A=B"]) == 3
    comparisons = store.comparisons(store.study())
    assert [(c.participant, c.position) for c in comparisons] == [
        ("Anna", 1),
        ("Anna", 2),
        ("Anna", 3),
        ("Bea", 1),
        ("Bea", 2),
    ]


def test_a_continued_file_whose_earlier_rows_changed_is_refused_whole(store, bring):
    rows = [f"Anna,Q1,M1,M2,{answer}" for answer in ["A>B", "A=B", "B>A", "A>>B"] * 3]
    bring(rows)
    changed = [*rows[:5], "Anna,Q1,M1,M2,B>>A", *rows[6:], "Bea,Q1,M1,M2,A>B"]
    with pytest.raises(InputError, match="11 of its 13 answers are as in an earlier file"):
        bring(changed)
    with pytest.raises(InputError, match="the store has A=B, not B>>A"):
        bring(changed, "continues")
    assert len(store.responses_table(store.study()).rows) == 12


def test_a_file_that_continues_nothing_says_so(bring):
    bring(FIRST)
    with pytest.raises(InputError, match="--continues: it repeats no file that was imported before"):
        bring(["Anna,Q1,M1,M3,B>>A", "Bea,Q1,M3,M1,A=B"], "continues")
    with pytest.raises(InputError, match="every row names its comparison"):
        bring(["Anna,Q1,M1,M3,B>>A,1"], "continues", f"{HEADER},comparison")


def test_a_file_that_holds_two_earlier_batches_cannot_continue_one(bring):
    other = ["Cleo,Q1,M1,M2,A>B", "Cleo,Q1,M2,M3,A>B"]
    bring(FIRST)
    bring(other)
    with pytest.raises(InputError, match="it holds the answers of several earlier files"):
        bring([*FIRST, *other, "Cleo,Q1,M3,M1,A=B"], "continues")


def test_the_largest_of_nested_batches_is_continued(store, bring):
    bring(FIRST)
    assert bring([*FIRST, "Cleo,Q1,M1,M2,A>B"], "another batch") == 5
    assert bring([*FIRST, "Cleo,Q1,M1,M2,A>B", "Cleo,Q1,M3,M1,A>B"], "continues") == 1
    assert len(store.responses_table(store.study()).rows) == 10


def test_answers_that_version_0_1_0_imported_are_an_earlier_batch(store, study, bring, noon):
    """Its ids named no batch: ``<participant>.u<what was shown>.<number>``."""
    from hashlib import sha256
    from json import dumps

    stored = store.add_study(study, TEXT)
    store.add_participant(stored, Participant("Anna", 1, "human", noon, {}))
    digest = sha256(dumps(("M1", "M2", "0", "False")).encode()).hexdigest()[:10]
    ids = [f"Anna.u{digest}.{n}" for n in (1, 2)]
    store.add_comparisons(
        [Comparison(key, "Anna", k, 0, "M1", "M2", False, noon, noon) for k, key in enumerate(ids, 1)]
    )
    from data.store.rows import insert_all
    from data.store.tables import responses

    with store.transaction() as connection:
        values = [
            {"comparison": key, "question": "Q1", "answer": answer, "answered_at": noon}
            for key, answer in zip(ids, ["A>B", "B>A"], strict=True)
        ]
        insert_all(connection, responses, values)
    longer = ["Anna,Q1,M1,M2,A>B", "Anna,Q1,M1,M2,B>A", "Anna,Q1,M1,M2,A=B"]
    with pytest.raises(InputError, match="2 of its 3 answers are as in an earlier file: add --continues"):
        bring(longer)
    assert bring(longer, "continues") == 1
    assert [c.id for c in store.comparisons(stored)] == [*ids, f"Anna.u{digest}.3"]


def test_an_export_keeps_its_batches_in_another_store(store, study, bring, tmp_path):
    from data.export import export_study
    from data.store import Store

    bring(FIRST)
    export_study(store, store.study(), tmp_path / "out")
    with Store.open(tmp_path / "other.sqlite") as other:
        assert import_responses(tmp_path / "out" / "responses.csv", study, TEXT, other) == 4
        ids = [c.id for c in other.comparisons(other.study())]
    assert ids == [c.id for c in store.comparisons(store.study())]
    assert all(key.split(".")[1].startswith("b") for key in ids)
    assert len(batch_name("ab" * 32)) == 8
