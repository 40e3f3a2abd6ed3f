"""What the console calls the modes before unblinding."""

import pandas as pd
import pytest
from scipy.stats import beta

from app.console.findings import ranking_at_a_glance, stuck_at_a_glance
from app.console.labels import coded_labels
from data.responses import QuestionScale, ResponseTable, StuckTable
from data.study_file import parse_study, read_study, study_text


def test_coded_labels_are_x_y_z_and_stay_the_same() -> None:
    study = read_study("carmichael2017")
    labels = coded_labels(study)
    assert list(labels.values()) == ["X", "Y", "Z"]
    assert sorted(labels) == ["M1", "M2", "M3"]
    assert labels == coded_labels(study)


def test_which_mode_is_x_differs_from_study_to_study() -> None:
    text = study_text("carmichael2017")
    first = {
        next(iter(coded_labels(parse_study(text.replace("seed = 2017", f"seed = {seed}", 1), "s"))))
        for seed in range(20)
    }
    assert first == {"M1", "M2", "M3"}


def test_a_reason_not_to_rank_names_no_mode_while_blinded() -> None:
    rows = pd.DataFrame(
        {
            "participant": ["p"] * 2,
            "question": ["Q1"] * 2,
            "mode_a": ["M1", "M2"],
            "mode_b": ["M2", "M1"],
            "response": ["A>B", "B>A"],
            "count": [1, 1],
            "comparison": ["c1", "c2"],
            "repetition": [1, 2],
            "source": ["human"] * 2,
            "check": [False] * 2,
        }
    )
    table = ResponseTable(rows, ("M1", "M2", "M3"), (QuestionScale("Q1", "s", "w", 3),), True, False, "", "t")
    (question,) = ranking_at_a_glance(table, {"M2": "X", "M3": "Y", "M1": "Z"})
    assert question.standings == ()
    assert question.reason
    assert "M" not in question.reason
    (open_question,) = ranking_at_a_glance(table, {name: name for name in table.modes})
    assert "M3" in open_question.reason


def test_stuck_rates_stand_under_their_labels_and_count_comparisons_as_independent() -> None:
    rows = [(f"p{k}", f"p{k}.c{c}", "M1", c < k, 60.0) for k in range(4) for c in range(4)]
    columns = ["participant", "comparison", "mode", "stuck", "exposure_s"]
    table = StuckTable(pd.DataFrame(rows, columns=columns))
    known, untried = stuck_at_a_glance(table, {"M1": "X", "M2": "Y"})
    assert (known.label, known.stuck, known.comparisons) == ("X", 6, 16)
    assert known.rate == pytest.approx(7 / 18)
    assert beta(7, 11).cdf(known.high) - beta(7, 11).cdf(known.low) == pytest.approx(0.94)
    assert (untried.label, untried.comparisons, untried.rate) == ("Y", 0, 0.5)
