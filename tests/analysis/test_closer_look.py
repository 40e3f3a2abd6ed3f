"""What goes beyond the ranking, on answers whose truth is planted."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.closer_look import closer_look
from analysis.equivalence import EQUIVALENT_BELOW, equivalences
from analysis.fit import fit
from analysis.persons import agreements
from analysis.predictive import predictive_checks
from analysis.report.pairs import equivalence_section
from analysis.results import Draws, FitSettings

QUICK = FitSettings(draws=400, tune=300, chains=2)


@pytest.fixture(scope="module")
def divided(table_of):
    """Seven people always prefer M1, three always M2."""
    rows = [(f"p{k}", "M1", "M2", "A>B" if k < 7 else "B>A") for k in range(10) for _ in range(8)]
    return table_of(pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response"]), levels=2)


@pytest.fixture(scope="module")
def divided_fit(divided):
    return fit(divided, QUICK)


def test_each_person_has_the_own_first_that_the_answers_show(divided, divided_fit):
    (agreement,) = agreements(divided, divided_fit)
    assert agreement.first == "M1"
    assert agreement.share_mean == pytest.approx(0.7, abs=0.05)
    own = {p.participant: p.p_first for p in agreement.people if p.mode == "M1"}
    assert min(own[f"p{k}"] for k in range(7)) > 0.9
    assert max(own[f"p{k}"] for k in range(7, 10)) < 0.1


def test_a_pooled_model_does_not_predict_how_far_people_lie_apart(divided, divided_fit):
    pooled = fit(divided, replace(QUICK, pooled=True))
    spread = {c.kind: c for c in predictive_checks(divided, pooled).checks}["spread"]
    assert spread.is_unlikely
    assert spread.observed > spread.predicted_high
    assert not {c.kind: c for c in predictive_checks(divided, divided_fit).checks}["wins"].is_unlikely


def test_equal_draws_are_equal_in_practice_and_far_ones_different(divided_fit):
    (question,) = divided_fit.questions
    lead = np.full((2, 400), EQUIVALENT_BELOW * 0.99)
    near = np.stack([lead / 2, -lead / 2], axis=-1)

    def read(ability):
        draws = Draws(ability, ability, {}, np.zeros(ability.shape[:2], bool))
        (found,) = equivalences(replace(divided_fit, questions=(replace(question, draws=draws),)))
        return found

    assert (read(near).reading, read(near).p_equal) == ("equal in practice", 1.0)
    assert (read(near * 1.1).reading, read(near * 1.1).p_i_above) == ("different", 1.0)


@pytest.mark.parametrize(
    ("reading", "sentence"),
    [
        ("different", "The two modes are likely different."),
        ("open", "Whether the two modes are different or equal in practice is open."),
        ("equal in practice", "Likely equal in practice: M1 and M2 (preference)."),
    ],
)
def test_of_one_pair_no_numbers_of_pairs_are_said(divided, divided_fit, reading, sentence):
    (pair,) = equivalences(divided_fit)
    look = replace(closer_look(divided, divided_fit), equivalences=(replace(pair, reading=reading),))
    section = equivalence_section(look, divided_fit, "")
    words = " ".join(section.words)
    assert sentence in words
    assert "1 of 1" not in words
    assert "0 of 1" not in words
