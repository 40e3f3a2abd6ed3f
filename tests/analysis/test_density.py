"""The compiled density against finite differences, scipy and PyMC."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import expit
from scipy.stats import beta, halfnorm, norm

from analysis.counts import count_responses
from analysis.engines.density import log_density, packed
from analysis.engines.exponential import exp, log, log_between_1_and_2
from analysis.model import Model, Problem
from analysis.zero_sum import zero_sum_basis
from data.answers import MIRRORED

MODELS = [
    pytest.param(Model(levels, link, hierarchical, side, sd), id=f"{link}{levels}-{hierarchical=}-{side=}")
    for levels, link in (*((n, "cumulative") for n in range(2, 10)), (3, "adjacent"))
    for hierarchical in (True, False)
    for side, sd in ((True, 1.0), (False, 0.5))
]
REACH_OF_WIDTHS = 0.4
"""Of the coordinates where people have widths of their own: an exponential of an exponential soon puts
cut-points where plain formulas, and PyMC's, lose their digits."""
OPTIONS = [
    ("lapse",),
    ("person_side",),
    ("person_scale",),
    ("position",),
    ("lapse", "person_scale"),
    ("lapse", "person_side", "person_scale", "position"),
]
POOLED_OPTIONS = [("lapse",), ("position",), ("lapse", "position")]
EXTENDED = [
    pytest.param(
        Model(levels, link, hierarchical, side, 1.0, **dict.fromkeys(options, True)),
        id=f"{link}{levels}-{'+'.join(options)}-{hierarchical=}",
    )
    for levels, link in (*((n, "cumulative") for n in (2, 3, 4, 7)), (3, "adjacent"))
    for hierarchical, listed in ((True, OPTIONS), (False, POOLED_OPTIONS))
    for options in listed
    for side in ((True, False) if len(options) == 4 else (True,))
    if levels > 2 or "person_scale" not in options
]


def problem_of(table, model: Model) -> Problem:
    counts = count_responses(table, table.questions[0], in_order=model.position)
    return Problem(counts if model.hierarchical else counts.pooled(), model)


def value(problem: Problem, x: np.ndarray) -> float:
    return float(log_density(x, np.empty_like(x), packed(problem)))


def naive_log_posterior(problem: Problem, x: np.ndarray) -> float:
    """Priors from scipy and probabilities as plain differences: right where nothing is extreme."""
    counts, model = problem.counts, problem.model
    basis = zero_sum_basis(len(counts.modes))
    rest = list(x)
    u = np.array([rest.pop(0) for _ in range(basis.shape[1])])
    total = norm(0, model.prior_sd).logpdf(u).sum()
    ability, side, spread, cuts = basis @ u, 0.0, 0.0, []
    if model.side_effect:
        side = rest.pop(0)
        total += norm(0, 0.5).logpdf(side)
    if model.link == "adjacent":
        log_nu = rest.pop(0)
        total += norm(0, 1).logpdf(log_nu)
    for _ in range(model.n_gaps):
        y = rest.pop(0)
        total += halfnorm(0, 1).logpdf(np.exp(y)) + y
        cuts.append((cuts[-1] if cuts else 0.0) + np.exp(y))
    lapse, drift, learning, side_sd, scale_sd = 0.0, 0.0, np.zeros(len(basis)), 0.0, 0.0
    if model.lapse:
        y = rest.pop(0)
        lapse = expit(y)
        total += beta(1, 9).logpdf(lapse) + np.log(lapse * (1 - lapse))
    if model.position:
        drift = rest.pop(0)
        gains = np.array([rest.pop(0) for _ in range(basis.shape[1])])
        learning = basis @ gains
        total += norm(0, 0.5).logpdf(drift) + norm(0, 0.5).logpdf(gains).sum()
    if model.hierarchical:
        y = rest.pop(0)
        spread = np.exp(y)
        total += halfnorm(0, 1).logpdf(spread) + y
    if model.person_side:
        y = rest.pop(0)
        side_sd = np.exp(y)
        total += halfnorm(0, 0.5).logpdf(side_sd) + y
    if model.person_scale:
        y = rest.pop(0)
        scale_sd = np.exp(y)
        total += halfnorm(0, 0.5).logpdf(scale_sd) + y
    total += norm.logpdf(rest).sum()
    n = len(counts.participants) if model.hierarchical else 0
    v = np.array(rest[: n * basis.shape[1]]).reshape(-1, basis.shape[1])
    rest = rest[v.size :]
    own_side = np.array(rest[:n] if model.person_side else [0.0] * len(counts.participants))
    width = np.array(rest[-n:] if model.person_scale else [0.0] * len(counts.participants))
    order = np.zeros((len(counts.participant), 3)) if counts.order is None else counts.order
    for s, a, b, answers, (t, x_a, x_b) in zip(
        counts.participant, counts.mode_a, counts.mode_b, counts.responses, order, strict=True
    ):
        eta = ability[a] - ability[b] + side + side_sd * own_side[s]
        eta += drift * t + learning[a] * x_a - learning[b] * x_b
        wider = np.exp(scale_sd * width[s])
        if model.hierarchical:
            z = basis @ v[s]
            eta += spread * (z[a] - z[b])
        if model.link == "adjacent":
            odds = np.exp([eta / 2, log_nu + np.log(wider), -eta / 2])
            p = odds / odds.sum()
        else:
            middle = [] if model.levels % 2 else [0.0]
            theta = [-np.inf, *[-c for c in cuts[::-1]], *middle, *cuts, np.inf]
            p = np.diff(expit(np.array(theta) * wider - eta))[::-1]
        total += answers @ np.log((1 - lapse) * p + lapse / model.levels)
    return total


@pytest.mark.parametrize("model", MODELS + EXTENDED)
def test_the_gradient_is_that_of_finite_differences(simulated, model):
    problem = problem_of(simulated(model.levels, participants=4), model)
    x = np.random.default_rng(1).normal(size=problem.n_dim)
    gradient = np.empty_like(x)
    log_density(x, gradient, packed(problem))
    step = 1e-5
    numeric = [
        (value(problem, x + step * e) - value(problem, x - step * e)) / (2 * step) for e in np.eye(len(x))
    ]
    np.testing.assert_allclose(gradient, numeric, atol=2e-7)


@pytest.mark.parametrize("model", MODELS + EXTENDED)
def test_the_density_is_that_of_plain_formulas_with_scipys_priors(simulated, model):
    problem = problem_of(simulated(model.levels, participants=4), model)
    rng = np.random.default_rng(2)
    reach = REACH_OF_WIDTHS if model.person_scale else 1.0
    differences = [
        value(problem, x) - naive_log_posterior(problem, x)
        for x in reach * rng.normal(size=(6, problem.n_dim))
    ]
    np.testing.assert_allclose(differences, differences[0], atol=1e-9)


@pytest.mark.parametrize("model", MODELS[::2] + [m for m in EXTENDED if m.values[0].levels in (3, 4)])
def test_the_density_is_that_of_the_pymc_model(simulated, model):
    from analysis.engines.pymc_engine import joint_model

    problem = problem_of(simulated(model.levels, participants=4), model)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        joint = joint_model([problem]).model
        density = joint.compile_logp(mode="FAST_COMPILE")
    shapes = {name: np.shape(start) for name, start in joint.initial_point().items()}
    order = (
        *("_ability_", "_side_effect", "_gaps_", "_log_nu", "_lapse_", "_side_drift", "_learning_"),
        *("_subject_sd_", "_side_sd_", "_scale_sd_", "_z_", "_s", "_w"),
    )
    prefix = "pooled" if not model.hierarchical else str(model.levels)
    names = sorted(shapes, key=lambda name: [f"{prefix}{part}" in name for part in order].index(True))
    differences = []
    reach = REACH_OF_WIDTHS if model.person_scale else 2.0
    for x in np.random.default_rng(3).normal(size=(5, problem.n_dim)) * reach:
        sizes = [int(np.prod(shapes[name])) for name in names]
        parts = np.split(x, np.cumsum(sizes)[:-1])
        point = {name: part.reshape(shapes[name]) for name, part in zip(names, parts, strict=True)}
        differences.append(value(problem, x) - float(density(point)))
    np.testing.assert_allclose(differences, differences[0], atol=1e-9)


@pytest.mark.parametrize("link", ["cumulative", "adjacent"])
def test_the_density_stays_exact_far_from_the_cut_points(wins_table, link):
    table = wins_table([[0, 1, 0], [0, 0, 1], [1, 0, 0]], {(0, 1): 3})
    problem = problem_of(table, Model(3, link, False, False, 1.0))
    x = np.array([80.0, -90.0, -3.0])
    gradient = np.empty_like(x)
    density = log_density(x, gradient, packed(problem))
    assert np.isfinite(density)
    step = 1e-4
    numeric = [(value(problem, x + step * e) - value(problem, x - step * e)) / (2 * step) for e in np.eye(3)]
    np.testing.assert_allclose(gradient, numeric, rtol=1e-6)


@pytest.mark.parametrize("model", [m for m in MODELS if m.values[0].side_effect])
def test_exchanging_sides_mirrors_the_side_effect_and_changes_nothing_else(
    answers_of, truth, table_of, model
):
    rows = answers_of(truth, levels=model.levels, participants=4)
    mirrored = rows.assign(
        mode_a=rows["mode_b"], mode_b=rows["mode_a"], response=rows["response"].map(MIRRORED)
    )
    one = problem_of(table_of(rows, levels=model.levels), model)
    other = problem_of(table_of(mirrored, levels=model.levels), model)
    x = np.random.default_rng(4).normal(size=one.n_dim)
    flipped = x.copy()
    flipped[len(one.counts.modes) - 1] *= -1
    assert value(one, x) == pytest.approx(value(other, flipped), abs=1e-11)
    assert value(one, x) != pytest.approx(value(other, x), abs=1e-3)


def test_counts_of_many_weigh_as_many_rows(answers_of, truth, table_of):
    rows = answers_of(truth, levels=5, participants=3)
    thrice = table_of(rows.assign(count=3))
    model = Model(5, "cumulative", False, True, 1.0)
    prior_alone = replace(problem_of(table_of(rows), model))
    once, three = problem_of(table_of(rows), model), problem_of(thrice, model)
    empty = Problem(replace(prior_alone.counts, responses=prior_alone.counts.responses * 0), model)
    x = np.random.default_rng(5).normal(size=once.n_dim)
    likelihood = value(once, x) - value(empty, x)
    assert value(three, x) - value(empty, x) == pytest.approx(3 * likelihood, rel=1e-12)


@pytest.mark.parametrize("n", [2, 3, 7, 100])
def test_the_zero_sum_basis_is_orthonormal_and_sums_to_zero(n):
    basis = zero_sum_basis(n)
    np.testing.assert_allclose(basis.T @ basis, np.eye(n - 1), atol=1e-12)
    np.testing.assert_allclose(basis.sum(axis=0), 0.0, atol=1e-12)


def test_exponential_and_logarithm_are_numpys_to_the_last_places():
    x = np.random.default_rng(6).uniform(-700, 700, size=2000)
    np.testing.assert_allclose([exp(value) for value in x], np.exp(x), rtol=5e-16)
    y = np.random.default_rng(7).uniform(1, 2, size=2000)
    np.testing.assert_allclose([log_between_1_and_2(value) for value in y], np.log(y), rtol=0, atol=5e-16)
    wide = np.exp(x)
    np.testing.assert_allclose([log(value) for value in wide], np.log(wide), rtol=5e-16, atol=5e-16)


def test_cells_of_many_blocks_add_up_like_cells_of_one(answers_of, truth, table_of):
    # 1,800 cells take several blocks of the likelihood; their parts fit in one each.
    rows = answers_of(truth, levels=5, participants=300)
    model = Model(5, "cumulative", False, True, 1.0)
    whole = count_responses(table_of(rows), table_of(rows).questions[0])
    assert len(whole.mode_a) == 1800
    x = np.random.default_rng(8).normal(size=5)
    alone = replace(whole, participants=("",), participant=np.zeros_like(whole.participant))
    assert value(Problem(alone, model), x) == pytest.approx(
        value(Problem(whole.pooled(), model), x), abs=1e-9
    )
