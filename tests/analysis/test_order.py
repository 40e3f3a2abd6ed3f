"""Places of comparisons: from the order of the rows, by participant and question, scaled by the longest."""

from dataclasses import replace

import pandas as pd
import pytest

from analysis.counts import count_responses
from analysis.order import ORDER_COLUMNS, with_order


def order_of(table):
    return with_order(table).rows[list(ORDER_COLUMNS)].to_numpy()


@pytest.fixture
def three_rows_and_one(table_of):
    rows = [("p1", "M1", "M2"), ("p2", "M1", "M2"), ("p1", "M3", "M1"), ("p1", "M1", "M2")]
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b"]).assign(response="A>B")
    return table_of(frame, levels=3)


def test_places_run_from_minus_a_half_to_a_half_over_the_longest_sequence(three_rows_and_one):
    place = order_of(three_rows_and_one)[:, 0]
    assert place.tolist() == [-0.5, -0.5, 0.0, 0.5], "p2 made one comparison, p1 three"


def test_a_mode_was_met_as_often_as_in_earlier_comparisons_of_the_same_person(three_rows_and_one):
    before = order_of(three_rows_and_one)[:, 1:]
    # p1 meets M1 first, then again, then for the third time: 0, 1 and 2 of at most 2 times before.
    assert before[:, 0].tolist() == [-0.5, -0.5, -0.5, 0.5]
    assert before[:, 1].tolist() == [-0.5, -0.5, 0.0, 0.0]


def test_rows_of_one_comparison_share_its_place(table_of):
    rows = pd.DataFrame(
        [("p1", "Q1", "c1"), ("p1", "Q1", "c2"), ("p1", "Q2", "c1"), ("p1", "Q2", "c2")],
        columns=["participant", "question", "comparison"],
    ).assign(mode_a="M1", mode_b="M2", response="A>B")
    assert order_of(table_of(rows, levels=3))[:, 0].tolist() == [-0.5, 0.5, -0.5, 0.5]


def test_checks_have_no_place(three_rows_and_one):
    rows = three_rows_and_one.rows.assign(check=[True, False, False, False])
    place = order_of(replace(three_rows_and_one, rows=rows))[:, 0]
    assert place[1:].tolist() == [-0.5, -0.5, 0.5]


def test_a_part_of_a_table_keeps_the_places_of_the_whole(three_rows_and_one):
    whole = with_order(three_rows_and_one)
    part = replace(whole, rows=whole.rows[1:])
    assert order_of(part).tolist() == order_of(whole)[1:].tolist()


def test_counts_keep_places_apart_only_if_asked(three_rows_and_one):
    question = three_rows_and_one.questions[0]
    plain = count_responses(three_rows_and_one, question)
    ordered = count_responses(three_rows_and_one, question, in_order=True)
    assert (len(plain.mode_a), plain.order) == (3, None)
    assert len(ordered.mode_a) == 4
    assert ordered.order is not None
    assert ordered.pooled().n == 4
    assert len(ordered.pooled().mode_a) == 3, "the first comparison of both people is the same occasion"
