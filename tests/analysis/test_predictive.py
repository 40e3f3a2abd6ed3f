"""Checks of the fitted model: as many false alarms as stated, and an alarm where a fault is planted."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.answer_rows import answer_rows
from analysis.calibration.world import Design, draw_answers, draw_truth
from analysis.fit import fit
from analysis.model import model_of
from analysis.predictive import ONE_SIDED, PredictiveChecks, predictive_checks
from analysis.report.model_cautions import GRAVEST_FIRST, model_cautions
from analysis.results import Draws, FitSettings
from data.answers import SCALES

QUICK = FitSettings(draws=400, tune=300, chains=2)
PAIRS = ((0, 1), (0, 2), (1, 2))


def study(table_of, people, answer, seed=3):
    """Three pairs twice, the second time with the sides exchanged; ``answer(rng, who, a, b, last)`` gives a
    place on five levels, ``last`` being that of the same pair as it is shown now."""
    rng = np.random.default_rng(seed)
    rows = []
    for who in range(people):
        last: dict[tuple[int, int], int] = {}
        for repetition in range(2):
            for pair in PAIRS:
                a, b = pair if repetition == 0 else pair[::-1]
                level = answer(rng, who, a, b, 4 - last[pair] if pair in last else None)
                last[pair] = level
                rows.append((f"p{who:02d}", f"M{a}", f"M{b}", SCALES[5][level], repetition + 1))
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response", "repetition"])
    return table_of(frame, modes=("M0", "M1", "M2"), levels=5)


def felt(rng, lead, width=1.0):
    """Place on five levels of a lead with logistic noise."""
    edges = width * np.array([-1.5, -0.5, 0.5, 1.5])
    return 4 - int(np.searchsorted(edges, lead + rng.logistic()))


ABILITY = np.array([0.4, 0.0, -0.4])


def checks_of(table):
    return predictive_checks(table, fit(table, QUICK))


def kinds(found, sure=False):
    return {c.kind for c in found.checks if (c.is_surely_unlikely if sure else c.is_unlikely)}


def test_a_model_that_is_right_raises_as_many_alarms_as_are_said_to_be_expected():
    """With the true parameters for draws every study's answers are exchangeable with the new ones."""
    model = model_of(FitSettings(), 5, has_participants=True)
    alarms, expected, checks = [], [], []
    for k in range(60):
        rng = np.random.default_rng([11, k])
        truth = draw_truth(model, 3, rng)
        table = draw_answers(model, truth, Design(7, 2, 3), rng)
        if k == 0:
            base = fit(table, QUICK)
        draws = Draws(
            np.tile(truth.ability, (2, 200, 1)),
            np.ones((2, 200, 3)) / 3,
            {name: np.full((2, 200), value) for name, value in truth.parameters.items()},
            np.zeros((2, 200), bool),
        )
        known = replace(
            base,
            settings=replace(QUICK, seed=k),
            questions=(replace(base.questions[0], draws=draws),),
        )
        found = predictive_checks(table, known)
        alarms.append(sum(c.is_unlikely for c in found.checks))
        expected.append(found.expected)
        checks.append(len(found.checks))
    assert np.mean(expected) == pytest.approx(0.06 * np.mean(checks), rel=0.05)
    assert np.mean(alarms) == pytest.approx(np.mean(expected), abs=3 * np.std(alarms) / np.sqrt(60))
    assert np.mean(np.array(alarms) > found.at_most) < 0.15


def test_remembered_answers_are_seen_and_said(table_of):
    def answer(rng, who, a, b, last):
        if last is not None and rng.random() < 0.7:
            return last
        return felt(rng, ABILITY[a] - ABILITY[b])

    found = checks_of(study(table_of, 20, answer))
    assert "repeats" in kinds(found, sure=True)
    said = model_cautions(found)
    assert "the same answer more often than the model expects" in said[0]


def test_widths_of_the_scale_that_differ_are_seen_and_name_the_option(table_of):
    found = checks_of(
        study(
            table_of,
            20,
            lambda rng, who, a, b, last: felt(rng, ABILITY[a] - ABILITY[b], np.exp(1.4 * (-1) ** who)),
        )
    )
    assert "width_by_person" in kinds(found, sure=True)
    assert any("--person-scale" in text for text in model_cautions(found))


def test_sides_that_differ_from_person_to_person_are_seen(table_of):
    found = checks_of(
        study(
            table_of, 20, lambda rng, who, a, b, last: felt(rng, ABILITY[a] - ABILITY[b] + 1.5 * (-1) ** who)
        )
    )
    assert "side_by_person" in kinds(found, sure=True)
    assert any("--person-side" in text for text in model_cautions(found))


def test_camps_are_seen_as_one_direction_and_as_two_groups(table_of):
    def answer(rng, who, a, b, last):
        own = ABILITY + 2.0 * (-1) ** who * np.array([1.0, 0.0, -1.0])
        return felt(rng, own[a] - own[b])

    found = checks_of(study(table_of, 40, answer))
    assert {"one_line", "camps"} <= kinds(found)
    assert "one_line" in kinds(found, sure=True)


def test_careless_answers_are_seen_where_preferences_are_strong(table_of):
    def answer(rng, who, a, b, last):
        return int(rng.integers(5)) if rng.random() < 0.2 else felt(rng, 8 * (ABILITY[a] - ABILITY[b]))

    found = checks_of(study(table_of, 60, answer))
    assert "lapse" in kinds(found)


def test_a_model_without_a_side_effect_is_told_that_a_side_was_favoured(table_of):
    table = study(table_of, 20, lambda rng, who, a, b, last: felt(rng, ABILITY[a] - ABILITY[b] + 1.0))
    without = predictive_checks(table, fit(table, replace(QUICK, side_effect=False)))
    assert "side" in kinds(without, sure=True)
    assert "side" not in {c.kind for c in checks_of(table).checks}
    assert any("shown as A was favoured" in text for text in model_cautions(without))
    winner_first = study(table_of, 8, lambda rng, who, a, b, last: int(rng.integers(2)))
    assert not {"side", "side_by_person", "side_drift"} & {c.kind for c in checks_of(winner_first).checks}


def test_every_kind_has_a_sentence_and_the_gravest_stands_first(table_of):
    found = checks_of(study(table_of, 7, lambda rng, who, a, b, last: felt(rng, ABILITY[a] - ABILITY[b])))
    one = found.checks[0]
    for is_high in (True, False):
        able = [kind for kind in GRAVEST_FIRST if is_high or kind not in ONE_SIDED]
        checks = tuple(replace(one, kind=kind, p_all=0.001, is_high=is_high) for kind in able[::-1])
        said = model_cautions(PredictiveChecks(checks, 0.8, 2))
        assert len(said) == len(set(said)) == len(able)
        assert ("asked about a pair again" in said[0]) == is_high


def test_many_weak_alarms_are_said_with_how_many_are_expected(table_of):
    found = checks_of(study(table_of, 7, lambda rng, who, a, b, last: felt(rng, ABILITY[a] - ABILITY[b])))
    checks = tuple(replace(c, p=0.03, p_all=0.5) for c in found.checks)
    (said,) = model_cautions(replace(found, checks=checks, expected=1.02, at_most=3))
    assert said.startswith(f"The model predicts {len(checks)} of {len(checks)} checked quantities badly")
    assert "1.0 would be expected" in said
    assert model_cautions(replace(found, checks=checks[:3], at_most=3)) == []


def test_an_answer_knows_the_answer_before_to_the_same_pair(table_of):
    rows = [
        ("q", "M1", "M2", "A>B", 2),
        ("p", "M1", "M2", "A>B", 1),
        ("q", "M2", "M1", "A=B", 1),
        ("p", "M1", "M3", "A>B", 1),
        ("p", "M2", "M1", "B>A", 2),
    ]
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response", "repetition"])
    table = table_of(frame, modes=("M1", "M2", "M3"), levels=3)
    found = answer_rows(table, table.questions[0], table.modes)
    assert found.person.tolist() == [0, 0, 0, 1, 1]
    assert found.before.tolist() == [-1, -1, 0, 4, -1]
    alone = found.of_people(np.array([False, True]))
    assert (alone.people, alone.before.tolist()) == (("q",), [1, -1])
    grouped = table_of(frame.assign(count=2), modes=("M1", "M2", "M3"), levels=3)
    assert not answer_rows(grouped, grouped.questions[0], grouped.modes).has_order


def test_of_many_answers_people_drawn_at_random_are_looked_at(table_of, monkeypatch):
    table = study(table_of, 12, lambda rng, who, a, b, last: felt(rng, ABILITY[a] - ABILITY[b]))
    fitted = fit(table, QUICK)
    monkeypatch.setattr("analysis.predictive.MOST_ANSWERS", 30)
    found = predictive_checks(table, fitted)
    assert (found.answers, found.answers_in_all) == (30, 72)
