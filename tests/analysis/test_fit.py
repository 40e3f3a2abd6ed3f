"""The whole fit: planted truths, symmetries, determinism, the gate, what is refused."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.counts import count_responses
from analysis.diagnostics import convergence
from analysis.engines import fast, nuts, pymc_engine
from analysis.engines.density import packed
from analysis.engines.pymc_engine import compiler_note
from analysis.fit import fit
from analysis.model import Model, Problem
from analysis.results import Draws, FitSettings, QuestionFit
from data.answers import MIRRORED
from data.errors import InputError

SETTINGS = FitSettings(seed=7)


def by_name(question: QuestionFit) -> dict[str, tuple[float, float]]:
    """Mean and sd of every reported quantity."""
    return {m.mode: (m.ability_mean, m.ability_sd) for m in question.modes} | {
        p.name: (p.mean, p.sd) for p in question.parameters
    }


def assert_alike(one: QuestionFit, other: QuestionFit, errors: float = 5.0) -> None:
    """Equal within the Monte-Carlo error of both."""
    a, b = by_name(one), by_name(other)
    assert a.keys() == b.keys()
    slack = errors * np.sqrt(1 / one.ess_min + 1 / other.ess_min)
    for name, (mean, sd) in a.items():
        assert b[name][0] == pytest.approx(mean, abs=slack * sd), name
        assert b[name][1] == pytest.approx(sd, rel=slack), name


def bytes_of(draws: Draws | None) -> bytes:
    assert draws is not None
    return draws.ability.tobytes() + b"".join(values.tobytes() for values in draws.parameters.values())


@pytest.mark.parametrize("levels", [2, 3, 5])
def test_planted_abilities_are_recovered(simulated, truth, levels):
    found = fit(simulated(levels, participants=80, seed=3), SETTINGS).questions[0]
    planted = dict(zip(["M1", "M2", "M3"], truth.ability, strict=True))
    planted |= {"side_effect": truth.side_effect, "subject_sd": truth.subject_sd}
    planted |= {f"cut_{k + 1}": truth.cuts[k] for k in range(levels // 2 if levels > 2 else 0)}
    estimates = by_name(found)
    assert estimates.keys() == planted.keys()
    for name, value in planted.items():
        mean, sd = estimates[name]
        assert abs(mean - value) < 3 * sd, name
        assert sd < 0.25, name
    assert [m.mode for m in sorted(found.modes, key=lambda m: m.rank_mean)] == ["M1", "M3", "M2"]
    assert found.hierarchical
    assert found.n_participants == 80


def test_worths_sum_to_one_and_abilities_to_zero_in_every_draw(simulated):
    question = fit(simulated(5), SETTINGS).questions[0]
    assert question.draws is not None
    np.testing.assert_allclose(question.draws.worth.sum(axis=-1), 1.0, atol=1e-12)
    np.testing.assert_allclose(question.draws.ability.sum(axis=-1), 0.0, atol=1e-12)
    assert sum(m.p_best for m in question.modes) == pytest.approx(1.0)
    assert [sum(m.rank_probabilities) for m in question.modes] == pytest.approx([1.0] * 3)


def test_leaving_out_the_participants_narrows_the_intervals(simulated):
    table = simulated(5, participants=30)
    own, pooled = (fit(table, replace(SETTINGS, pooled=p)).questions[0] for p in (False, True))
    assert all(a.ability_sd > 1.1 * b.ability_sd for a, b in zip(own.modes, pooled.modes, strict=True))
    assert "subject_sd" not in by_name(pooled)


def test_exchanging_sides_leaves_the_posterior_unchanged(answers_of, truth, table_of):
    rows = answers_of(truth, levels=5, participants=12)
    mirrored = rows.assign(
        mode_a=rows["mode_b"], mode_b=rows["mode_a"], response=rows["response"].map(MIRRORED)
    )
    one, other = (fit(table_of(r, modes=["M1", "M2", "M3"]), SETTINGS).questions[0] for r in (rows, mirrored))
    flipped = tuple(replace(p, mean=-p.mean) if p.name == "side_effect" else p for p in other.parameters)
    assert_alike(one, replace(other, parameters=flipped))


def test_renaming_modes_leaves_the_posterior_unchanged(answers_of, truth, table_of):
    rows = answers_of(truth, levels=3, participants=12)
    names = {"M1": "zebra", "M2": "lion", "M3": "ant"}
    renamed = rows.assign(mode_a=rows["mode_a"].map(names), mode_b=rows["mode_b"].map(names))
    one = fit(table_of(rows, modes=["M1", "M2", "M3"]), SETTINGS).questions[0]
    other = fit(table_of(renamed, modes=list(names.values())), SETTINGS).questions[0]
    assert [m.mode for m in other.modes] == list(names.values())
    back = tuple(replace(m, mode=old) for m, old in zip(other.modes, names, strict=True))
    assert_alike(one, replace(other, modes=back))


def test_neither_row_order_nor_grouping_changes_a_byte(answers_of, truth, table_of):
    rows = answers_of(truth, levels=5, participants=6)
    shuffled = rows.sample(frac=1.0, random_state=1)
    grouped = rows.groupby(list(rows.columns), as_index=False).size().rename(columns={"size": "count"})
    modes = ["M3", "M1", "M2"]
    draws = [
        bytes_of(fit(table_of(r, modes=modes), SETTINGS).questions[0].draws)
        for r in (rows, shuffled, grouped)
    ]
    assert draws[0] == draws[1] == draws[2]


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(simulated):
    table = simulated(3)
    one, again, other = (fit(table, replace(SETTINGS, seed=s)).questions[0] for s in (1, 1, 2))
    assert bytes_of(one.draws) == bytes_of(again.draws)
    assert bytes_of(one.draws) != bytes_of(other.draws)


def test_the_number_of_threads_does_not_change_a_byte(simulated):
    counts = count_responses(simulated(5), simulated(5).questions[0])
    problem = Problem(counts, Model(5, "cumulative", True, True, 1.0))
    drawn = [
        nuts.sample(
            packed(problem),
            problem.n_dim,
            problem.n_global,
            seed=1,
            draws=200,
            tune=200,
            chains=4,
            target_accept=0.8,
            cores=cores,
        ).position.tobytes()
        for cores in (1, 2, 4)
    ]
    assert drawn[0] == drawn[1] == drawn[2]


def test_a_question_is_fitted_as_if_it_were_alone(answers_of, truth, table_of):
    first = answers_of(truth, levels=3, participants=6, question="Q1")
    second = answers_of(truth, levels=5, participants=6, question="Q2", seed=2)
    modes = ["M1", "M2", "M3"]
    both = fit(table_of(pd.concat([second, first]), modes=modes), SETTINGS)
    alone = fit(table_of(first, modes=modes), SETTINGS)
    assert bytes_of(both.questions[1].draws) == bytes_of(alone.questions[0].draws)


def test_a_weak_prior_brings_the_posterior_to_the_likelihood(cems):
    # 4,454 answers: mean and maximum differ by less than a tenth of a standard error.
    found = fit(cems, FitSettings(pooled=True, side_effect=False, prior_sd=10.0)).questions[0]
    ability = {m.mode: m.ability_mean for m in found.modes}
    published = {
        "Barcelona": 0.5307,
        "London": 1.6299,
        "Milano": 0.3883,
        "Paris": 0.9125,
        "St.Gallen": 0.5156,
    }
    for mode, value in published.items():
        assert ability[mode] - ability["Stockholm"] == pytest.approx(value, abs=0.012)


def test_a_hundred_modes_are_ranked(table_of):
    rng = np.random.default_rng(5)
    worth = np.linspace(-1.5, 1.5, 100)
    pairs = np.array([(i, (i + d) % 100) for i in range(100) for d in (1, 7, 33)])
    p = 1 / (1 + np.exp(worth[pairs[:, 1]] - worth[pairs[:, 0]]))
    won = rng.binomial(10, p)
    rows = [(f"m{i:03d}", f"m{j:03d}", "A>B", n) for (i, j), n in zip(pairs, won, strict=True) if n]
    rows += [
        (f"m{i:03d}", f"m{j:03d}", "B>A", 10 - n) for (i, j), n in zip(pairs, won, strict=True) if n < 10
    ]
    table = table_of(pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"]))
    question = fit(table, SETTINGS).questions[0]
    assert question.ranked
    ability = [m.ability_mean for m in sorted(question.modes, key=lambda m: m.mode)]
    assert np.corrcoef(ability, worth)[0, 1] > 0.9
    assert len(question.pairs) == 4950


def test_a_question_that_does_not_converge_is_sampled_longer_and_then_not_ranked(simulated, monkeypatch):
    asked: list[int] = []
    sample = fast.sample

    def stuck_chain(problems, settings, done=lambda k: None):
        asked.append(settings.draws)
        draws = sample(problems, settings, done)
        for d in draws:
            d.ability[0] += np.array([1.0, -1.0, 0.0])
        return draws

    monkeypatch.setattr(fast, "sample", stuck_chain)
    found = fit(simulated(3), SETTINGS)
    assert asked == [1000, 2000, 4000]
    question = found.questions[0]
    assert not question.ranked
    assert not found.converged
    assert not found.ranked
    assert "did not converge" in question.reason
    assert question.modes == ()
    assert question.draws is not None
    assert np.isnan(question.pairs[0].p_i_above_j)
    assert question.pairs[0].n > 0


def test_longer_sampling_is_enough_where_it_mixes_slowly(simulated, monkeypatch):
    sample = fast.sample

    def short(problems, settings, done=lambda k: None):
        return sample(problems, settings if settings.draws > 1000 else replace(settings, draws=100), done)

    monkeypatch.setattr(fast, "sample", short)
    question = fit(simulated(3), SETTINGS).questions[0]
    assert question.ranked
    assert question.draws is not None
    assert question.draws.ability.shape == (4, 1000, 3)


def test_the_diagnostics_of_a_question_are_the_worst_of_what_it_reports(simulated):
    question = fit(simulated(5), SETTINGS).questions[0]
    assert question.draws is not None
    ability = question.draws.ability
    spread = convergence(question.draws.parameters["subject_sd"][None])
    lead = convergence((ability[..., 0] - ability[..., 1])[None])
    rank = convergence(1.0 + (ability > ability[..., :1]).sum(axis=-1)[None])
    for quantity in (spread, lead, rank):
        assert question.ess_min <= quantity.ess_min
        assert question.rhat_max >= quantity.rhat_max


def test_the_sampler_takes_bolder_steps_the_more_dimensions_there_are():
    settings = FitSettings()
    assert settings.acceptance(3) == settings.acceptance(100) == settings.target_accept == 0.9
    assert settings.acceptance(101) == settings.acceptance(9_999) == pytest.approx(0.8)
    assert settings.acceptance(10_000) == settings.acceptance(10**6) == pytest.approx(0.65)
    cautious = replace(settings, target_accept=0.95)
    assert cautious.acceptance(10_000) > settings.acceptance(10_000)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"engine": "stan"}, "engine: 'stan' is not one of: fast, pymc, gibbs"),
        ({"link": "probit"}, "link: 'probit' is not one of: cumulative, adjacent"),
        ({"link": "adjacent"}, "adjacent needs a scale of 3 levels, not 5"),
        ({"engine": "gibbs", "link": "adjacent"}, "link: adjacent is not known to the engine gibbs"),
        ({"prior_sd": 0.0}, "prior_sd: 0.0 is not a positive number"),
        ({"prior_sd": float("nan")}, "prior_sd: nan is not a positive number"),
        ({"seed": -1}, "seed: -1 is negative"),
        ({"draws": 3}, "draws: 3 is fewer than 100"),
        ({"target_accept": 1.0}, "target_accept: 1.0 is not between 0 and 1"),
    ],
)
def test_settings_that_make_no_sense_are_refused_before_sampling(simulated, changes, message):
    with pytest.raises(InputError, match=message):
        fit(simulated(5), replace(SETTINGS, **changes))


def test_progress_counts_the_questions(answers_of, truth, table_of):
    rows = pd.concat(
        [answers_of(truth, levels=3, participants=4, question=q, seed=k) for k, q in enumerate(("Q1", "Q2"))]
    )
    calls: list[tuple[int, int, str]] = []
    fit(table_of(rows, modes=["M1", "M2", "M3"]), SETTINGS, lambda *call: calls.append(call))
    assert calls[0] == (0, 2, "sampling")
    assert calls[-1][:2] == (2, 2)
    assert [done for done, _, _ in calls] == sorted(done for done, _, _ in calls)


def test_the_fast_engine_imports_neither_pymc_nor_arviz():
    code = """
import sys
import pandas as pd
from analysis.fit import fit
from data.responses import QuestionScale, ResponseTable
rows = pd.DataFrame([("p", "q", "M1", "M2", "A>B", 9, False), ("p", "q", "M2", "M1", "A>B", 5, False)],
    columns=["participant", "question", "mode_a", "mode_b", "response", "count", "check"])
table = ResponseTable(rows, ("M1", "M2"), (QuestionScale("q", "q", "q", 2),), True, False, "", "")
assert fit(table).questions[0].ranked
heavy = {"arviz", "pymc", "pytensor", "nutpie", "matplotlib", "xarray"} & set(sys.modules)
assert not heavy, heavy
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_pymc_engine_agrees_with_the_fast_one(simulated):
    table = simulated(3, participants=8)
    assert_alike(fit(table, SETTINGS).questions[0], fit(table, replace(SETTINGS, engine="pymc")).questions[0])


def test_a_draw_that_diverges_in_questions_sampled_together_counts_once(simulated, table_of, monkeypatch):
    one = simulated(3, participants=4).rows
    table = table_of(pd.concat([one, one.assign(question="Q2")]), modes=("M1", "M2", "M3"))
    together = np.zeros((4, 1000), dtype=bool)
    together[1, 7] = together[2, 30] = True

    def jointly(problems, settings, done=lambda k: None):
        return [replace(draws, diverging=together) for draws in fast.sample(problems, settings, done)]

    monkeypatch.setattr(pymc_engine, "sample", jointly)
    found = fit(table, replace(SETTINGS, engine="pymc", pooled=True))
    assert [q.divergences for q in found.questions] == [2, 2]
    assert found.divergences == 2


def test_a_missing_compiler_is_said_with_what_it_slows_down(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    (note,) = compiler_note()
    assert "No C++ compiler" in note
    assert "sampling keeps its speed" in note
    for name in ("g++", "clang++"):
        (tmp_path / name).write_text("")
        (tmp_path / name).chmod(0o755)
        assert compiler_note() == ()
