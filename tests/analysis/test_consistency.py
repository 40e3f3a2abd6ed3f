"""Circular triads, repeated pairs and agreement, on answers whose order is planted."""

import pandas as pd
import pytest

from analysis.consistency import consistencies

COLUMNS = ["participant", "mode_a", "mode_b", "response", "repetition"]


def table(table_of, rows):
    return table_of(pd.DataFrame(rows, columns=COLUMNS), modes=("M1", "M2", "M3"), levels=3)


def ordered(who, repetition=1):
    return [
        (who, "M1", "M2", "A>B", repetition),
        (who, "M3", "M2", "B>A", repetition),
        (who, "M1", "M3", "A>B", repetition),
    ]


def test_a_circle_is_circular_and_an_order_is_not(table_of):
    circle = [("c", "M1", "M2", "A>B", 1), ("c", "M2", "M3", "A>B", 1), ("c", "M1", "M3", "B>A", 1)]
    together, straight, round_ = consistencies(table(table_of, [*ordered("s"), *circle]))
    assert (straight.triads, straight.circular, straight.zeta) == (1, 0, 1.0)
    assert (round_.triads, round_.circular, round_.zeta) == (1, 1, 0.0)
    assert (together.participant, together.triads, together.circular) == ("all", 2, 1)


def test_people_of_one_order_agree_fully_whatever_the_sides(table_of):
    together = consistencies(table(table_of, [row for who in "abcdefgh" for row in ordered(who)]))[0]
    assert together.u == pytest.approx(1.0)
    assert together.u_p == 2.0 ** (-7 * 3)


def test_two_people_of_opposite_orders_agree_least(table_of):
    turned = {"A>B": "B>A", "B>A": "A>B"}
    opposite = [("b", a, b, turned[answer], r) for _, a, b, answer, r in ordered("a")]
    assert consistencies(table(table_of, [*ordered("a"), *opposite]))[0].u == pytest.approx(-1.0)


def test_a_repeated_pair_is_compared_with_the_answer_before_by_mode_and_not_by_side(table_of):
    rows = [
        ("a", "M1", "M2", "A>B", 1),
        ("a", "M2", "M1", "B>A", 2),
        ("a", "M1", "M2", "B>A", 3),
    ]
    mine = consistencies(table(table_of, rows))[1]
    assert (mine.repeated, mine.same, mine.reversed) == (2, 1, 1)


def test_pairs_that_everybody_decides_alike_are_no_retest_correlation(table_of):
    """Everybody prefers M1 strongly to M2 and is of two minds about M1 and M3, each time anew."""
    tossed = {"a": ("A>B", "B>A"), "b": ("B>A", "B>A"), "c": ("A>B", "A>B"), "d": ("B>A", "A>B")}
    rows = [
        (who, "M1", other, answer, repetition)
        for who, pair in tossed.items()
        for repetition, toss in enumerate(pair, start=1)
        for other, answer in (("M2", "A>B"), ("M3", toss), ("M2", "A>B"))
    ]
    assert consistencies(table(table_of, rows))[0].retest == pytest.approx(0.0, abs=1e-12)


def test_a_remembered_answer_is_a_retest_correlation(table_of):
    rows = [
        (who, "M1", "M2", answer, repetition)
        for who, answer in (("a", "A>B"), ("b", "B>A"), ("c", "A=B"))
        for repetition in (1, 2)
    ]
    assert consistencies(table(table_of, rows))[0].retest == pytest.approx(1.0)


def test_a_demo_s_answers_to_its_fourth_question_agree_by_chance_in_2_point_26_per_cent(table_of):
    """The leads and ties of the fourth question of ``elbowroom demo`` with seed 2017."""
    net = [(1, -1, -1), (1, -1, 1), (1, -1, -1), (0, -1, 0), (-1, -1, -1), (1, -1, -1), (1, 0, 1)]
    rows = [
        (who, a, b, ("A=B", "A>B", "B>A")[sign], 1)
        for who, signs in zip("abcdefg", net, strict=True)
        for (a, b), sign in zip((("M1", "M2"), ("M1", "M3"), ("M2", "M3")), signs, strict=True)
    ]
    together = consistencies(table(table_of, rows))[0]
    assert (together.u, together.u_p) == (pytest.approx(0.278, abs=5e-4), 0.02264404296875)
