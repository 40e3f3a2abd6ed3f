"""Joint statements: how many claims are expected to be wrong, and the chance that all are right."""

import pytest

from analysis.claims import Claim, all_right, expected_wrong


def test_claims_about_different_questions_are_right_together_with_the_product_of_their_chances() -> None:
    claims = [Claim("Worth", "a", 0.9, "Q1"), Claim("Worth", "b", 0.8, "Q2")]
    assert all_right(claims) == pytest.approx(0.72)
    assert expected_wrong(claims) == pytest.approx(0.3)


def test_of_claims_about_one_question_only_a_lower_limit_is_known() -> None:
    claims = [Claim("Worth", "a", 0.9, "Q1"), Claim("Worth", "b", 0.8, "Q1"), Claim("Worth", "c", 0.5, "Q2")]
    assert all_right(claims) == pytest.approx(0.7 * 0.5)


def test_no_claim_is_never_wrong() -> None:
    assert (expected_wrong([]), all_right([])) == (0.0, 1.0)
