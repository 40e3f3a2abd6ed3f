"""Joint statements: how many claims are expected to be wrong, and the chance that all are right."""

import pytest

from analysis.claims import Claim, all_right, expected_wrong, joint_sentence


def test_claims_about_different_questions_are_right_together_with_the_product_of_their_chances() -> None:
    claims = [Claim("Worth", "a", 0.9, "Q1"), Claim("Worth", "b", 0.8, "Q2")]
    assert all_right(claims) == pytest.approx(0.72)
    assert expected_wrong(claims) == pytest.approx(0.3)


def test_of_claims_about_one_question_only_a_lower_limit_is_known() -> None:
    claims = [Claim("Worth", "a", 0.9, "Q1"), Claim("Worth", "b", 0.8, "Q1"), Claim("Worth", "c", 0.5, "Q2")]
    assert all_right(claims) == pytest.approx(0.7 * 0.5)


def test_no_claim_is_never_wrong() -> None:
    assert (expected_wrong([]), all_right([])) == (0.0, 1.0)


def test_the_sentence_gives_both_numbers_and_says_where_one_is_a_limit() -> None:
    apart = [Claim("", "a", 0.9, "Q1"), Claim("", "b", 0.8, "Q2")]
    assert joint_sentence(apart, "first", "firsts") == (
        "Of the 2 firsts 0.30 are expected to be wrong; the chance that all of them are right is 72 %."
    )
    together = [Claim("", "a", 0.99, "Q1"), Claim("", "b", 0.98, "Q1")]
    assert joint_sentence(together, "first", "firsts").endswith("all of them are right is at least 97 %.")
    assert joint_sentence(apart[:1], "first", "firsts") == "The chance that this first is wrong is 10 %."
    assert joint_sentence([], "first", "firsts") == ""


def test_a_limit_that_says_nothing_is_not_said() -> None:
    many = [Claim("", str(k), 0.8, "Q1") for k in range(5)]
    assert joint_sentence(many, "pair", "pairs") == "Of the 5 pairs 1.0 are expected to be wrong."


def test_sure_claims_are_not_called_certain() -> None:
    sure = [Claim("", "a", 1.0, "Q1"), Claim("", "b", 1.0, "Q2")]
    assert "fewer than 0.01 are expected" in joint_sentence(sure, "first", "firsts")
    assert "over 99 %" in joint_sentence(sure, "first", "firsts")


def test_a_lower_limit_is_never_rounded_up() -> None:
    """0.74525 is not “at least 75 %”, and a limit of 0.997 is not “at least over 99 %”."""
    unsure = [Claim("", "a", 0.87, "Q1"), Claim("", "b", 0.87525, "Q1")]
    assert joint_sentence(unsure, "pair", "pairs").endswith("right is at least 74 %.")
    sure = [Claim("", "a", 0.998, "Q1"), Claim("", "b", 0.999, "Q1")]
    assert joint_sentence(sure, "pair", "pairs").endswith("right is at least 99 %.")
    whole = [Claim("", "a", 0.95, "Q1"), Claim("", "b", 0.85, "Q1")]
    assert joint_sentence(whole, "pair", "pairs").endswith("right is at least 80 %.")
