"""What answers cannot rank is refused; what they can barely rank is said."""

import numpy as np
import pandas as pd
import pytest

from analysis.fit import fit
from analysis.results import FitSettings


def of_pairs(table_of, pairs, modes, **kwargs):
    """Ten answers for every pair, five each way."""
    rows = [(a, b, answer, 5) for a, b in pairs for answer in ("A>B", "B>A")]
    return table_of(
        pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"]), modes=modes, **kwargs
    )


def test_disconnected_groups_are_not_ranked_and_the_missing_pairs_are_named(table_of):
    found = fit(of_pairs(table_of, [("a", "b"), ("c", "d")], ["a", "b", "c", "d"]))
    question = found.questions[0]
    assert not question.ranked
    assert not found.ranked
    assert found.converged
    assert question.modes == ()
    assert question.draws is None
    assert question.missing_pairs == (("a", "c"), ("a", "d"), ("b", "c"), ("b", "d"))
    assert "2 groups never compared with each other: a and b; c and d" in question.reason
    assert "a against c" in question.reason
    assert [pair.n for pair in question.pairs] == [10, 0, 0, 0, 0, 10]
    assert all(np.isnan(pair.p_i_above_j) for pair in question.pairs)


def test_a_mode_never_shown_is_named(table_of):
    question = fit(of_pairs(table_of, [("a", "b")], ["a", "b", "c"])).questions[0]
    assert not question.ranked
    assert question.reason.startswith(
        "c was never compared with another mode. Missing: a against c or b against c"
    )


def test_a_chain_of_comparisons_is_ranked(table_of):
    question = fit(of_pairs(table_of, [("a", "b"), ("c", "b"), ("c", "d")], ["a", "b", "c", "d"])).questions[
        0
    ]
    assert question.ranked
    assert question.missing_pairs == ()
    assert any(
        w.startswith("Never shown against each other: a and c; a and d; b and d. ") for w in question.warnings
    )


def test_where_every_pair_was_shown_none_is_named(table_of):
    question = fit(of_pairs(table_of, [("a", "b"), ("c", "b"), ("a", "c")], ["a", "b", "c"])).questions[0]
    assert not any("Never shown" in warning for warning in question.warnings)


def test_one_unranked_question_leaves_the_other_ranked(table_of):
    whole = of_pairs(table_of, [("a", "b"), ("b", "c")], ["a", "b", "c"]).rows.assign(question="Q1")
    part = of_pairs(table_of, [("a", "b")], ["a", "b", "c"]).rows.assign(question="Q2")
    found = fit(table_of(pd.concat([whole, part]), modes=["a", "b", "c"], has_participants=False))
    assert [q.ranked for q in found.questions] == [True, False]
    assert not found.ranked
    assert np.isfinite(found.rhat_max)


def test_a_mode_that_always_wins_is_ranked_with_a_warning(wins_table):
    question = fit(wins_table([[0, 9, 9], [0, 0, 5], [0, 4, 0]])).questions[0]
    assert question.ranked
    assert any("M1 won every comparison" in warning for warning in question.warnings)
    assert question.modes[0].p_best > 0.95


def test_a_mode_that_always_loses_is_ranked_with_a_warning(wins_table):
    question = fit(wins_table([[0, 9, 5], [0, 0, 0], [5, 9, 0]])).questions[0]
    assert any("M2 lost every comparison" in warning for warning in question.warnings)


def test_wins_in_a_circle_are_no_separation(wins_table):
    question = fit(wins_table([[0, 9, 0], [0, 0, 9], [9, 0, 0]])).questions[0]
    assert not any("every comparison" in warning for warning in question.warnings)


def test_nothing_but_ties_is_ranked_with_a_warning(wins_table):
    question = fit(wins_table([[0] * 3] * 3, {(0, 1): 9, (1, 2): 9, (0, 2): 9})).questions[0]
    assert question.ranked
    assert any("Every answer is a tie" in warning for warning in question.warnings)
    assert all(mode.ability_mean == pytest.approx(0.0, abs=0.05) for mode in question.modes)


def test_a_single_participant_is_ranked_with_a_warning(simulated):
    question = fit(simulated(3, participants=1)).questions[0]
    assert question.ranked
    assert any("one participant" in warning for warning in question.warnings)
    assert any("Few data" in warning for warning in question.warnings)


def test_a_file_that_names_the_winner_first_is_ranked_without_a_side_effect(table_of):
    """Three wins in four: worth .74 by the prior alone, .65 if a side effect takes up the rest."""
    for answer, turned in (("A>B", False), ("B>A", True)):
        rows = [("M1", "M2", answer, 30), ("M2", "M1", answer, 10)]
        rows = [(b, a, r, n) if turned else (a, b, r, n) for a, b, r, n in rows]
        table = table_of(pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"]), levels=2)
        fitted = fit(table)
        question = fitted.questions[0]
        worth = {m.mode: m.worth_mean for m in question.modes}
        assert worth["M1"] == pytest.approx(0.74, abs=0.005)
        assert [p.name for p in question.parameters] == []
        assert "without a side effect" in fitted.model
        assert "side_effect" not in fitted.priors
        assert any("the sides say nothing here" in warning for warning in question.warnings)
        assert ("winner first" if answer == "A>B" else "loser first") in question.warnings[-1]


def test_few_answers_for_one_side_are_chance_and_one_for_the_other_is_an_answer(table_of):
    def fitted(rows):
        frame = pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"])
        return fit(table_of(frame, levels=3)).questions[0]

    for rows in (
        [("M1", "M2", "A>B", 6), ("M2", "M1", "A>B", 4), ("M1", "M2", "A=B", 20)],
        [("M1", "M2", "A>B", 30), ("M2", "M1", "A>B", 10), ("M1", "M2", "B>A", 1)],
    ):
        assert "side_effect" in {p.name for p in fitted(rows).parameters}
    rows = [("M1", "M2", "A>B", 6), ("M2", "M1", "A>B", 5), ("M1", "M2", "A=B", 20)]
    assert "side_effect" not in {p.name for p in fitted(rows).parameters}


def test_enough_people_bring_no_warning(simulated):
    assert fit(simulated(3, participants=12)).questions[0].warnings == ()


def test_sides_that_were_never_exchanged_bring_a_warning_only_with_a_side_effect(table_of):
    pairs = [("M1", "M2"), ("M1", "M3"), ("M2", "M3")]
    rows = [(*pair, answer, n) for pair in pairs for answer, n in (("A>B", 20), ("A=B", 9), ("B>A", 5))]
    table = table_of(pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"]))
    with_side, without = (fit(table, FitSettings(side_effect=s)).questions[0] for s in (True, False))
    assert any("sides exchanged" in warning for warning in with_side.warnings)
    assert not any("sides exchanged" in warning for warning in without.warnings)


def test_unknown_participants_are_pooled_and_the_fit_says_so(wins_table):
    found = fit(wins_table([[0, 9, 5], [4, 0, 5], [5, 9, 0]]))
    assert not found.questions[0].hierarchical
    assert any("name no participants" in warning for warning in found.warnings)
    assert "subject_sd" not in found.priors


def test_a_name_cannot_turn_round_or_break_the_sentence_it_stands_in(table_of):
    names = ["a\nb", "\u202ec", "\u05d3"]
    refused = fit(of_pairs(table_of, [tuple(names[:2])], names)).questions[0]
    assert refused.reason == (
        "\u2068\u05d3\u2069 was never compared with another mode. "
        "Missing: a b against \u2068\u05d3\u2069 or c against \u2068\u05d3\u2069. "
        "“elbowroom report --largest-group” ranks the largest group alone."
    )
    rows = pd.DataFrame([("a\nb", "\u202ec", "A>B")], columns=["mode_a", "mode_b", "response"])
    warned = " ".join(fit(table_of(rows)).questions[0].warnings)
    assert "a b and c are in fewer" in warned
    assert "\n" not in warned
    assert "\u202e" not in warned
