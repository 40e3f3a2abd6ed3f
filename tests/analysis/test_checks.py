"""Answers to comparisons of a mode with itself."""

import pandas as pd

from analysis.checks import check_shares
from data.responses import QuestionScale, ResponseTable

QUESTIONS = (QuestionScale("Q1", "q", "?", 5), QuestionScale("Q2", "q", "?", 2))


def table(*rows: tuple[str, str, str, str, str, int, bool]) -> ResponseTable:
    names = ["participant", "question", "mode_a", "mode_b", "response", "count", "check"]
    frame = pd.DataFrame(rows, columns=names)
    return ResponseTable(frame, ("M1", "M2"), QUESTIONS, True, False, "x", "t")


def test_the_share_of_about_the_same_is_counted_person_by_person():
    shares = check_shares(
        table(
            ("zoe", "Q1", "M1", "M1", "A=B", 3, True),
            ("zoe", "Q1", "M2", "M2", "B>>A", 1, True),
            ("ann", "Q1", "M1", "M1", "A>B", 1, True),
        )
    )
    assert [(s.participant, s.answers, s.same, s.share) for s in shares] == [
        ("zoe", 4, 3, 0.75),
        ("ann", 1, 0, 0.0),
    ]


def test_other_checks_real_comparisons_and_scales_without_a_middle_are_left_out():
    assert (
        check_shares(
            table(
                ("ann", "Q1", "M1", "M2", "A=B", 1, True),
                ("ann", "Q1", "M1", "M2", "A=B", 1, False),
                ("ann", "Q2", "M1", "M1", "A>B", 1, True),
            )
        )
        == ()
    )
