"""What other priors would change: much where answers are few, nothing where they are many."""

from math import isnan

import pytest

from analysis.fit import fit
from analysis.results import FitSettings
from analysis.sensitivity import prior_shifts

SETTINGS = FitSettings(draws=1000, tune=500, chains=2)


def shifts_of(table, settings=SETTINGS):
    return [s for s in prior_shifts(table, fit(table, settings)) if not isnan(s.worth_then)]


def largest(shifts, prior):
    return max(abs(s.worth_then - s.worth) for s in shifts if s.prior.startswith(prior))


def test_the_prior_on_abilities_matters_for_few_answers_and_not_for_many(table_of, answers_of, truth):
    few = table_of(answers_of(truth, levels=2, participants=3, repetitions=1), levels=2)
    rows = answers_of(truth, levels=2, participants=20, repetitions=2).assign(count=20)
    many = table_of(rows.assign(participant="all"), levels=2, has_participants=False)
    assert largest(shifts_of(few), "ability") > 0.05
    assert largest(shifts_of(many), "ability") < 0.02


def test_a_narrower_prior_moves_worths_towards_each_other(simulated):
    shifts = shifts_of(simulated(2, participants=4))
    narrow = {s.mode: s for s in shifts if s.prior == "ability ~ ZeroSumNormal(0.5)"}
    best = max(narrow.values(), key=lambda s: s.worth)
    assert best.worth_then < best.worth


def test_weighted_draws_shift_as_a_fit_under_the_other_prior_does(simulated, monkeypatch):
    table = simulated(3, participants=5)
    settings = FitSettings(draws=2000, tune=300, chains=2)
    weighted = {
        s.mode: s.worth_then for s in shifts_of(table, settings) if s.prior == "subject_sd ~ HalfNormal(0.5)"
    }
    monkeypatch.setattr("analysis.engines.density.SUBJECT_SD_SCALE", 0.5)
    again = {m.mode: m.worth_mean for m in fit(table, settings).questions[0].modes}
    assert weighted == pytest.approx(again, abs=0.015)


def test_the_gibbs_engine_has_no_prior_to_scale(simulated):
    assert shifts_of(simulated(3), FitSettings(engine="gibbs", draws=1000, tune=300)) == []
