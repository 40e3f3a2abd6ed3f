"""Judging claims."""

from sim_trials.reproductions.verdict import Judgement, Verdict, judge, verdict_table


def test_a_claim_is_reproduced_only_if_it_holds_under_every_reading() -> None:
    assert judge([True, True]) is Judgement.REPRODUCED
    assert judge([True, False]) is Judgement.UNDER_ASSUMPTION
    assert judge([False, False]) is Judgement.CONTRADICTED
    assert judge([]) is Judgement.NOT_DETERMINABLE


def test_a_claim_that_needs_an_assumption_is_never_plainly_reproduced() -> None:
    assert judge(True, "a start") is Judgement.UNDER_ASSUMPTION
    assert judge(False, "a start") is Judgement.CONTRADICTED


def test_the_table_has_the_columns_of_the_contract() -> None:
    table = verdict_table([Verdict("c", "p", "o", "a", Judgement.CONTRADICTED)])
    assert list(table) == ["claim", "published", "ours", "assumption", "verdict"]
    assert table.iloc[0].tolist() == ["c", "p", "o", "a", "contradicted"]
