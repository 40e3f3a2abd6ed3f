"""Counts know nothing of row order or grouping."""

import numpy as np
import pandas as pd
import pytest

from analysis.counts import count_responses
from data.answers import MIRRORED
from data.errors import InputError


def same(one, other) -> bool:
    return (
        one.modes == other.modes
        and one.participants == other.participants
        and all(
            np.array_equal(getattr(one, name), getattr(other, name))
            for name in ("participant", "mode_a", "mode_b", "responses")
        )
    )


@pytest.mark.parametrize("levels", [2, 3, 5])
def test_shuffled_rows_count_alike(answers_of, truth, table_of, levels):
    rows = answers_of(truth, levels=levels, participants=5)
    shuffled = rows.sample(frac=1.0, random_state=4).reset_index(drop=True)
    one, other = table_of(rows, levels=levels), table_of(shuffled, levels=levels)
    assert other.modes != ("M1", "M2", "M3")
    assert same(count_responses(one, one.questions[0]), count_responses(other, other.questions[0]))


def test_rows_and_their_counts_count_alike(answers_of, truth, table_of):
    rows = answers_of(truth, levels=5, participants=5, repetitions=4)
    grouped = rows.groupby(list(rows.columns), as_index=False).size().rename(columns={"size": "count"})
    assert len(grouped) < len(rows)
    one, other = table_of(rows), table_of(grouped)
    assert same(count_responses(one, one.questions[0]), count_responses(other, other.questions[0]))


def test_which_mode_was_shown_as_a_is_kept(table_of):
    rows = pd.DataFrame(
        [("p", "X", "Y", "A>B"), ("p", "Y", "X", "B>A")],
        columns=["participant", "mode_a", "mode_b", "response"],
    )
    counts = count_responses(table_of(rows), table_of(rows).questions[0])
    assert counts.mode_a.tolist() == [0, 1]
    assert counts.responses.tolist() == [[1, 0], [0, 1]]
    assert counts.wins().tolist() == [[0, 2], [0, 0]]


def test_mirrored_rows_have_the_same_wins(answers_of, truth, table_of):
    rows = answers_of(truth, levels=5, participants=5)
    mirrored = rows.assign(
        mode_a=rows["mode_b"], mode_b=rows["mode_a"], response=rows["response"].map(MIRRORED)
    )
    one, other = table_of(rows, modes=["M1", "M2", "M3"]), table_of(mirrored, modes=["M1", "M2", "M3"])
    a, b = count_responses(one, one.questions[0]), count_responses(other, other.questions[0])
    assert np.array_equal(a.wins(), b.wins())
    assert np.array_equal(a.ties(), b.ties())
    assert int(a.wins().sum() + np.triu(a.ties()).sum()) == len(rows)


def test_attention_checks_stay_out(answers_of, truth, table_of):
    rows = answers_of(truth, levels=3, participants=3).assign(check=False)
    check = pd.DataFrame([("p000", "Q1", "M1", "M1", "A>B", True)], columns=rows.columns)
    table = table_of(pd.concat([rows, check], ignore_index=True))
    assert count_responses(table, table.questions[0]).n == len(rows)


def test_a_mode_against_itself_is_an_error_without_check(table_of):
    rows = pd.DataFrame([("M1", "M1", "A>B")], columns=["mode_a", "mode_b", "response"])
    table = table_of(rows, modes=["M1", "M2"])
    with pytest.raises(InputError, match="'M1' is compared with itself"):
        count_responses(table, table.questions[0])


def test_an_answer_off_the_scale_is_an_error_that_lists_the_scale(table_of):
    rows = pd.DataFrame([("M1", "M2", "A=B")], columns=["mode_a", "mode_b", "response"])
    table = table_of(rows, levels=2)
    with pytest.raises(InputError, match="'A=B' is not one of: A>B, B>A"):
        count_responses(table, table.questions[0])


def test_collapsing_five_levels_keeps_wins_and_ties(simulated):
    table = simulated(5)
    counts = count_responses(table, table.questions[0])
    assert np.array_equal(counts.collapsed().wins(), counts.wins())
    assert np.array_equal(counts.collapsed().ties(), counts.ties())
    assert counts.collapsed().levels == 3
