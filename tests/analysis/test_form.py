"""The form of participants follows what their answers say; the model is the same in every form."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize

from analysis.counts import count_responses
from analysis.engines.density import log_density, packed
from analysis.engines.form import form_of
from analysis.engines.people import Form
from analysis.fit import fit
from analysis.model import Model, Problem
from analysis.results import FitSettings
from analysis.zero_sum import zero_sum_basis

MODEL = Model(3, "cumulative", True, True, 1.0)
ABILITY = np.array([0.4, 0.0, -0.4])
PAIRS = ((0, 1), (0, 2), (1, 2), (1, 0), (2, 0), (2, 1))


def problem_of(table, model: Model = MODEL) -> Problem:
    return Problem(count_responses(table, table.questions[0]), model)


@pytest.fixture
def people_of(table_of):
    """Answers to three modes on three levels by ten people who differ by so much, each pair so often."""

    def answers(subject_sd: float, times: int):
        rng = np.random.default_rng(5)
        rows = []
        for s in range(10):
            own = ABILITY + subject_sd * rng.normal(size=3)
            for a, b in PAIRS:
                felt = own[a] - own[b] + rng.logistic(size=times)
                for answer, count in (
                    ("A>B", int((felt > 0.5).sum())),
                    ("B>A", int((felt < -0.5).sum())),
                    ("A=B", int((abs(felt) <= 0.5).sum())),
                ):
                    if count:
                        rows.append((f"p{s}", f"M{a + 1}", f"M{b + 1}", answer, count))
        columns = ["participant", "mode_a", "mode_b", "response", "count"]
        return table_of(pd.DataFrame(rows, columns=columns), modes=("M1", "M2", "M3"), levels=3)

    return answers


@pytest.mark.parametrize("link", ["cumulative", "adjacent"])
def test_every_form_has_the_same_density_but_for_the_change_of_variables(simulated, link):
    problem = problem_of(simulated(3, participants=4), replace(MODEL, link=link))
    c, h = np.array([0.0, 0.3, 0.8, 1.0]), np.array([0.0, 1.0, 0.5, 2.0])
    g = np.random.default_rng(7).normal(size=(4, 2))
    n_own = problem.n_dim - problem.n_global
    for x in np.random.default_rng(2).normal(size=(5, problem.n_dim)):
        u, log_sd = x[:2], x[problem.n_global - 1]
        v = x[problem.n_global :].reshape(4, -1)
        # subject_sd z = subject_sd^(1-c) basis (v' - c u), and z = basis v.
        sd = np.exp(log_sd)
        tau = sd ** (1 + c) / (1 + sd**2 * h)
        moved = np.exp(log_sd * c)[:, None] * v + c[:, None] * u - tau[:, None] * g
        there = np.concatenate([x[: problem.n_global], moved.ravel()])
        slope = np.empty_like(x)
        plain = log_density(x, slope, packed(problem))
        centred = log_density(there, slope, packed(problem, Form(c, g, h)))
        assert centred + log_sd * c.sum() * n_own / 4 == pytest.approx(plain, abs=1e-9)


def test_the_slopes_of_a_partly_centred_form_are_those_of_finite_differences(simulated):
    problem = problem_of(simulated(5, participants=4), replace(MODEL, levels=5))
    c, h = np.array([0.0, 0.3, 0.8, 1.0]), np.array([0.0, 1.0, 0.5, 2.0])
    data = packed(problem, Form(c, np.random.default_rng(7).normal(size=(4, 2)), h))
    x = np.random.default_rng(1).normal(size=problem.n_dim)
    slope, other = np.empty_like(x), np.empty_like(x)
    log_density(x, slope, data)
    step = 1e-5
    numeric = [
        (log_density(x + step * e, other, data) - log_density(x - step * e, other, data)) / (2 * step)
        for e in np.eye(len(x))
    ]
    np.testing.assert_allclose(slope, numeric, atol=2e-7)


def test_where_participants_are_expected_hardly_moves_with_the_spread(people_of):
    problem = problem_of(people_of(0.6, 1))
    form = form_of(problem)
    group = np.concatenate([zero_sum_basis(3).T @ ABILITY, [0.0, np.log(0.5)]])

    def expected(sd: float, data: np.ndarray) -> np.ndarray:
        """The most probable deviations, as they stand in the position."""
        start = np.append(group, np.log(sd))

        def uphill(v: np.ndarray) -> tuple[float, np.ndarray]:
            x = np.concatenate([start, v])
            slope = np.empty_like(x)
            return -log_density(x, slope, data), -slope[len(start) :]

        return minimize(uphill, np.zeros(problem.n_dim - len(start)), jac=True, tol=1e-10).x

    def moved(data: np.ndarray) -> float:
        return float(np.linalg.norm(expected(0.8, data) - expected(0.3, data)))

    assert moved(packed(problem, form)) < 0.4 * moved(packed(problem))


def test_a_study_of_dozens_of_answers_is_hardly_centred(simulated):
    assert form_of(problem_of(simulated(3, participants=7))).centring.max() < 0.3


def test_people_who_differ_and_answer_often_are_centred_and_people_alike_never(people_of):
    assert form_of(problem_of(people_of(0.8, 1000))).centring.min() > 0.9
    assert form_of(problem_of(people_of(0.0, 1000))).centring.max() < 0.1


def test_someone_whose_answers_do_not_connect_the_modes_is_not_centred(people_of):
    table = people_of(0.8, 1000)
    one_pair = (table.rows["participant"] != "p0") | (
        table.rows["mode_a"].isin(["M1", "M2"]) & table.rows["mode_b"].isin(["M1", "M2"])
    )
    c = form_of(problem_of(replace(table, rows=table.rows[one_pair]))).centring
    assert c[0] < 0.01
    assert c[1:].min() > 0.9


@pytest.mark.parametrize(("subject_sd", "times"), [(0.8, 10_000), (0.0, 10_000), (0.1, 300)])
def test_thousands_of_answers_a_person_converge_at_once(people_of, monkeypatch, subject_sd, times):
    monkeypatch.setattr("analysis.fit.LONGER", ())
    found = fit(people_of(subject_sd, times), FitSettings(seed=3)).questions[0]
    assert found.ranked, found.reason
    spread = next(p for p in found.parameters if p.name == "subject_sd")
    assert spread.hdi_low - 0.02 < subject_sd < spread.hdi_high
