"""The options of the model: planted values are found, and what has no meaning is refused in one line."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp

from analysis.answer_rows import answer_rows
from analysis.answer_shares import answer_probabilities, answer_shares, group_lead, thinned
from analysis.calibration.world import Design, Truth, draw_answers
from analysis.counts import count_responses
from analysis.engines.coordinates import Quantities, position_of, quantities_of
from analysis.engines.density import log_density, packed
from analysis.fit import NO_WIDTH, fit
from analysis.leaving_out import _variants
from analysis.marginal import log_likelihoods
from analysis.model import Model, Problem, describe, model_of, priors
from analysis.new_people import parameters_of, replicated
from analysis.persons import agreements
from analysis.predictive import predictive_checks
from analysis.results import OPTIONS, FitSettings
from analysis.zero_sum import zero_sum_basis
from data.errors import InputError

SETTINGS = FitSettings(draws=500, tune=500, chains=2)
ALL = FitSettings(
    draws=500, tune=500, chains=2, lapse=True, person_side=True, person_scale=True, position=True
)
ABILITY = np.array([0.8, -0.5, -0.3])
COMMON = {"side_effect": 0.2, "cut_1": 0.5, "cut_2": 1.6, "subject_sd": 0.5}
PLANTED = {
    "lapse": {"lapse": 0.15},
    "person_side": {"side_sd": 0.9},
    "person_scale": {"scale_sd": 0.7},
    "position": {"side_drift": 0.8, "learning_M1": 0.8, "learning_M2": -0.8, "learning_M3": 0.0},
}
NOTHING = {
    "lapse": 0.05,
    "side_sd": 0.3,
    "scale_sd": 0.3,
    "side_drift": 0.0,
    "learning_M1": 0.2,
    "learning_M2": -0.2,
    "learning_M3": 0.0,
}


def with_options(settings: FitSettings, *options: str) -> FitSettings:
    return replace(settings, **dict.fromkeys(options, True))


def planted_table(
    settings: FitSettings, people: int, times: int, levels: int = 5, ability=ABILITY, **parameters
):
    model = model_of(settings, levels, has_participants=True)
    design = Design(people, times, 3)
    parameters = {**COMMON, **NOTHING, **parameters}
    own = {name: parameters[name] for name in model.parameter_names(design.modes)}
    return draw_answers(model, Truth(ability, own), design, np.random.default_rng(1))


@pytest.mark.parametrize("option", OPTIONS)
def test_what_is_planted_is_found(option):
    settings = with_options(SETTINGS, option)
    (found,) = fit(planted_table(settings, 60, 6, **PLANTED[option]), settings).questions
    assert found.ranked, found.reason
    named = {p.name: p for p in found.parameters}
    for name, value in PLANTED[option].items():
        assert abs(named[name].mean - value) < 3 * named[name].sd, name
        assert named[name].mean == pytest.approx(value, abs=0.05 if name == "lapse" else 0.4), name
    assert [m.ability_mean for m in found.modes] == pytest.approx(ABILITY, abs=0.35)


def test_careless_answers_no_longer_pull_the_abilities_together():
    robust = with_options(SETTINGS, "lapse")
    table = planted_table(robust, 60, 6, ability=2 * ABILITY, lapse=0.25, subject_sd=0.1)

    def reach(settings):
        means = [m.ability_mean for m in fit(table, settings).questions[0].modes]
        return np.ptp(means) / np.ptp(2 * ABILITY)

    assert reach(SETTINGS) < 0.8
    assert reach(robust) == pytest.approx(1.0, abs=0.12)


@pytest.mark.parametrize(
    ("settings", "known", "message"),
    [
        (FitSettings(engine="gibbs", lapse=True), True, "lapse: the engine gibbs does not have this option"),
        (FitSettings(engine="gibbs", position=True), True, "position: the engine gibbs does not have"),
        (FitSettings(pooled=True, person_side=True), True, "person_side: .* they are pooled"),
        (FitSettings(person_scale=True), False, "person_scale: .* the answers name none"),
        (FitSettings(position=True), False, "position: .* the answers name none"),
    ],
)
def test_an_option_without_meaning_is_refused_before_sampling(simulated, settings, known, message):
    with pytest.raises(InputError, match=message):
        fit(replace(simulated(3, participants=4), has_participants=known), settings)


def test_rows_that_stand_for_several_answers_have_no_order(simulated):
    table = simulated(3, participants=4)
    rows = table.rows.assign(count=[2, 2, *[1] * (len(table.rows) - 2)])
    with pytest.raises(InputError, match=r"rows stand for several \(count\): 2 do"):
        fit(replace(table, rows=rows), with_options(SETTINGS, "position"))


def test_two_levels_have_no_width_and_say_so(simulated):
    (found,) = fit(simulated(2, participants=6), with_options(SETTINGS, "person_scale")).questions
    assert NO_WIDTH in found.warnings
    assert "scale_sd" not in [p.name for p in found.parameters]


def test_options_stand_in_the_words_of_the_fit():
    assert "careless answers (lapse), with each participant's own side effect" in describe(ALL, True)
    stated = priors(ALL, {5}, True)
    assert (stated["lapse"], stated["side_drift"], stated["learning"]) == (
        "Beta(1, 9)",
        "Normal(0, 0.5)",
        "ZeroSumNormal(0.5)",
    )
    assert (stated["side_sd"], stated["scale_sd"]) == ("HalfNormal(0.5)", "HalfNormal(0.5)")


def test_coordinates_and_quantities_are_each_others_inverse():
    modes = ("M1", "M2", "M3")
    model = Model(7, "cumulative", True, True, 1.0, True, True, True, True)
    position = np.random.default_rng(1).normal(size=(5, 13))
    found = quantities_of(position, model, modes)
    assert list(found.parameters) == list(model.parameter_names(modes))
    assert sum(found.parameters[f"learning_{mode}"] for mode in modes) == pytest.approx(
        np.zeros(5), abs=1e-12
    )
    assert position_of(Quantities(found.ability, found.parameters), model, modes) == pytest.approx(position)


def test_a_constant_width_is_a_wider_scale(simulated):
    """A width that everybody shares is the same density as cut-points multiplied by it."""
    table = simulated(5, participants=3)
    counts = count_responses(table, table.questions[0])
    own = Problem(counts, Model(5, "cumulative", True, True, 1.0, person_scale=True))
    common = Problem(counts, Model(5, "cumulative", True, True, 1.0))
    x = np.random.default_rng(2).normal(size=common.n_dim)
    wider = x.copy()
    wider[3:5] += 0.3
    prior_only = replace(counts, responses=counts.responses * 0)

    def likelihood(problem, at):
        slope = np.empty_like(at)
        silent = replace(problem, counts=prior_only)
        return log_density(at, slope, packed(problem)) - log_density(at, slope, packed(silent))

    # scale_sd 0.3 and w = 1 for everyone: the sampler's coordinates are log 0.3 and 1.
    extended = np.concatenate([x[:6], [np.log(0.3)], x[6:], np.ones(3)])
    assert likelihood(own, extended) == pytest.approx(likelihood(common, wider), abs=1e-9)


@pytest.fixture(scope="module")
def fitted_with_all():
    table = planted_table(ALL, 8, 2)
    fitted = fit(table, ALL)
    assert fitted.ranked, fitted.questions[0].reason
    return table, fitted


@pytest.mark.parametrize("levels", [3, 5])
def test_own_sides_and_widths_are_integrated_out_as_many_random_people_do(levels):
    table = planted_table(ALL, 3, 2, levels=levels)
    fitted = fit(table, ALL)
    draws = thinned(fitted.questions[0].draws, 10)
    counts = count_responses(table, table.questions[0], in_order=True)
    model = model_of(ALL, levels, has_participants=True)
    found = log_likelihoods(counts, model, draws, 128)
    rng, n = np.random.default_rng(3), 60_000
    columns = {name: values[:, None] for name, values in draws.parameters.items()}
    lead = group_lead(counts, draws.ability, columns)
    z = rng.standard_normal((n, 2)) @ zero_sum_basis(3).T
    s, w = rng.standard_normal((2, n))
    at = {name: values[:, 0] for name, values in columns.items()}
    brute = np.empty_like(found)
    for d in range(len(draws.ability)):
        one = {name: np.array([[values[d]]]) for name, values in at.items()}
        between = z[:, counts.mode_a] - z[:, counts.mode_b]
        eta = lead[d] + at["subject_sd"][d] * between + (at["side_sd"][d] * s)[:, None]
        p = answer_probabilities(eta, one, levels, (at["scale_sd"][d] * w)[:, None])
        by_cell = (counts.responses * np.log(p)).sum(axis=-1)
        for person in range(3):
            own = by_cell[:, counts.participant == person].sum(axis=1)
            brute[person, d] = logsumexp(own) - np.log(n)
    assert np.sqrt(((found - brute) ** 2).mean()) < 0.08
    assert np.abs(found - brute).max() < 0.4


def test_expected_answers_are_those_of_simulated_new_people(fitted_with_all):
    table, fitted = fitted_with_all
    ((first, *_),) = answer_shares(table, fitted)
    modes = fitted.questions[0].mode_names
    rows = answer_rows(table, table.questions[0], modes, in_order=True)
    draws = thinned(fitted.questions[0].draws)
    rng = np.random.default_rng(4)
    total = np.zeros(5)
    i, j = modes.index(first.mode_i), modes.index(first.mode_j)
    for k in range(len(draws.ability)):
        drawn = replicated(rows, parameters_of(draws.ability, draws.parameters, modes, k), 40, rng)
        total += np.bincount(drawn[:, (rows.mode_a == i) & (rows.mode_b == j)].ravel(), minlength=5)
        total += np.bincount(drawn[:, (rows.mode_a == j) & (rows.mode_b == i)].ravel(), minlength=5)[::-1]
    assert first.expected == pytest.approx(total / total.sum(), abs=0.01)
    assert first.much_i[0] == pytest.approx(first.expected[0])


def test_checks_of_the_model_leave_out_what_an_option_holds(fitted_with_all):
    table, fitted = fitted_with_all
    kinds = {check.kind for check in predictive_checks(table, fitted).checks}
    assert kinds & {"wins", "ties", "level", "spread"}
    assert not kinds & {"lapse", "width_by_person", "side_by_person", "side_drift"}


def test_people_have_own_worths_with_all_options_on(fitted_with_all):
    table, fitted = fitted_with_all
    (agreement,) = agreements(table, fitted)
    assert len(agreement.people) == 8 * 3, agreement.reason
    assert 0 < agreement.share_mean < 1


def test_learning_has_an_axis_of_modes_whatever_they_are_called(fitted_with_all):
    _, fitted = fitted_with_all
    posterior = fitted.posterior["posterior"]
    assert posterior["learning"].dims == ("chain", "draw", "question", "mode")
    assert not [name for name in posterior if str(name).startswith("learning_")]
    draws = fitted.questions[0].draws.parameters["learning_M2"]
    assert np.array_equal(posterior["learning"].sel(mode="M2").to_numpy()[..., 0], draws)


def test_each_option_is_compared_on_and_off():
    names = list(_variants(SETTINGS, 5, knows_order=True))
    assert names == [
        *("as reported", "without a side effect", "people alike"),
        *("with careless answers", "with own side effects", "with own widths of the scale"),
        "with position and learning",
    ]
    assert "without careless answers" in _variants(ALL, 5, knows_order=True)
    assert not _variants(ALL, 5, knows_order=True)["people alike"].person_side
    assert "with own widths of the scale" not in _variants(SETTINGS, 2, knows_order=True)
    assert "with position and learning" not in _variants(SETTINGS, 5, knows_order=False)
    pooled = list(_variants(replace(SETTINGS, pooled=True), 5, knows_order=True))
    assert "with own side effects" not in pooled
    assert "with careless answers" in pooled


def test_the_fit_without_options_is_the_fit_of_before(simulated):
    """Options that are off leave no trace: neither in the parameters nor in the counting."""
    (found,) = fit(simulated(5, participants=5), SETTINGS).questions
    assert [p.name for p in found.parameters] == ["side_effect", "cut_1", "cut_2", "subject_sd"]


def test_both_engines_draw_from_the_same_extended_posterior():
    # The other options are compared by their densities alone (test_density.py): compiling all takes minutes.
    settings = with_options(SETTINGS, "lapse", "position")
    table = planted_table(settings, 6, 2, levels=3)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (fast,), (other,) = (
            fit(table, replace(settings, engine=name, draws=1000, chains=4)).questions
            for name in ("fast", "pymc")
        )
    assert other.ranked, other.reason
    slack = 4.5 * np.sqrt(1 / fast.ess_min + 1 / other.ess_min)
    for one, two in zip(fast.parameters, other.parameters, strict=True):
        assert one.name == two.name
        assert one.mean == pytest.approx(two.mean, abs=slack * one.sd), one.name
    for one, two in zip(fast.modes, other.modes, strict=True):
        assert one.ability_mean == pytest.approx(two.ability_mean, abs=slack * one.ability_sd)
