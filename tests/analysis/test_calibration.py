"""Calibration: right posteriors pass, wrong ones are named, and nothing is dropped in silence."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.calibration import CALIBRATION_FILES, Calibration, Design, calibrate, notes, verdict, world_of
from analysis.calibration.experiment import ranked_truths, settings_for
from analysis.calibration.files import write_calibration
from analysis.calibration.outcome import Replicate
from analysis.calibration.quantities import LOG_LIKELIHOOD, quantities, true_quantities
from analysis.calibration.uniformity import (
    DRAWS_RANKED,
    LEVELS,
    coverages,
    ecdf,
    ecdf_band,
    is_inside,
    leaving_probability,
    rank_of,
    uniformities,
)
from analysis.calibration.world import Truth, draw_answers, draw_truth
from analysis.counts import count_responses
from analysis.model import adjacent_log_probabilities, cumulative_log_probabilities
from analysis.results import Draws, FitSettings
from analysis.softmax import worth_of
from app.cli.main import run
from data.errors import InputError

THREE = world_of(FitSettings(), 3)
POOLED = world_of(FitSettings(pooled=True), 3)


def normal_calibration(
    n: int, posterior: Callable[[float], tuple[float, float]], failures: int = 0
) -> Calibration:
    """Of mu ~ Normal(0, 1) seen as y ~ Normal(mu, 1), by draws from a posterior (mean, sd) given y."""
    rng = np.random.default_rng(5)
    replicates = []
    for k in range(n):
        mu = rng.normal()
        mean, sd = posterior(mu + rng.normal())
        draws = {"mu": mean + sd * rng.normal(size=400), "nu": rng.normal(size=400)}
        true = {"mu": float(mu), "nu": float(rng.normal())}
        replicates.append(Replicate(k, k >= failures, 1.0, 500.0, 0, ranked_truths(true, draws, rng)))
    return Calibration(THREE, Design(), settings_for(THREE), 5, tuple(replicates))


def exact(y: float) -> tuple[float, float]:
    return y / 2, np.sqrt(1 / 2)


def prior_sd_halved(y: float) -> tuple[float, float]:
    return y / 5, np.sqrt(1 / 5)


def test_an_exact_posterior_passes_every_check() -> None:
    result = normal_calibration(1000, exact)
    assert result.is_calibrated
    assert verdict(result).startswith("Calibrated: all 8 coverages and all 2 ECDFs")
    assert notes(result) == ("All 1000 replicates converged.",)
    assert {c.level: c.coverage for c in result.coverages if c.parameter == "mu"} == pytest.approx(
        dict(zip(LEVELS, LEVELS, strict=True)), abs=0.05
    )


def test_a_fit_with_half_the_prior_sd_is_caught_and_named() -> None:
    result = normal_calibration(200, prior_sd_halved)
    said = verdict(result)
    assert said.startswith("MISCALIBRATED")
    assert "mu (intervals too narrow" in said
    assert "nu (" not in said
    assert all(c.coverage < c.level for c in result.coverages if c.parameter == "mu")


@pytest.mark.parametrize(
    ("posterior", "said"),
    [
        (lambda y: (y / 2 + 0.5, np.sqrt(1 / 2)), "draws rather too high"),
        (lambda y: (y / 2 - 0.5, np.sqrt(1 / 2)), "draws rather too low"),
        (lambda y: (y / 2, np.sqrt(2.0)), "intervals too wide"),
    ],
)
def test_the_verdict_says_in_which_way_a_posterior_is_wrong(posterior, said) -> None:
    assert said in verdict(normal_calibration(400, posterior))


def test_a_pass_of_few_replicates_is_not_called_calibrated() -> None:
    result = normal_calibration(60, exact)
    assert verdict(result).startswith("No fault found")
    assert "60 replicates show only gross faults" in notes(result)[-1]


def test_replicates_without_convergence_are_left_out_and_said() -> None:
    result = normal_calibration(1100, exact, failures=7)
    assert result.failures == 7
    assert len(result.ranks["mu"]) == 1093
    assert notes(result)[0].startswith("7 of 1100 replicates did not converge and are left out")
    assert (~result.table["converged"]).sum() == 7 * 2


def test_central_intervals_hold_exactly_their_share_of_the_ranks() -> None:
    every = np.arange(DRAWS_RANKED + 1)
    for level in LEVELS:
        inside = is_inside(every, level)
        assert inside.mean() == pytest.approx(level, abs=1e-12)
        assert (inside == inside[::-1]).all()


def test_the_chance_of_leaving_the_band_is_that_of_simulated_ranks() -> None:
    n, pointwise = 60, 0.01
    rng = np.random.default_rng(2)
    shares = np.stack([ecdf(r) for r in rng.integers(DRAWS_RANKED + 1, size=(20_000, n))])
    exactly = leaving_probability(n, pointwise)
    band = ecdf_band(n, exactly * (1 + 1e-3))
    left = ((shares < band.low - 1e-12) | (shares > band.high + 1e-12)).any(axis=1).mean()
    assert left == pytest.approx(exactly, abs=4 * np.sqrt(exactly / 20_000))
    assert 0.02 < exactly < 0.3


def test_p_values_of_uniform_ranks_are_no_smaller_than_chance() -> None:
    rng = np.random.default_rng(3)
    ranks = {str(k): rng.integers(DRAWS_RANKED + 1, size=40) for k in range(120)}
    p = np.array([u.p_value for u in uniformities(ranks)])
    for level in (0.05, 0.2, 0.5):
        assert (p <= level).mean() == pytest.approx(level, abs=4 * np.sqrt(level / 120))


def test_bands_widen_with_the_number_of_checks() -> None:
    ranks = np.arange(500) % (DRAWS_RANKED + 1)
    one, many = coverages({"a": ranks})[2], coverages({str(k): ranks for k in range(20)})[2]
    assert many.band_low < one.band_low < 0.9 < one.band_high < many.band_high
    assert uniformities({"a": ranks, "b": ranks})[0].limit == uniformities({"a": ranks})[0].limit / 2


def test_a_rank_counts_thinned_draws_below_and_shares_out_equals() -> None:
    rng = np.random.default_rng(1)
    draws = np.arange(4000.0)
    assert rank_of(-1.0, draws, rng) == 0
    assert rank_of(2000.5, draws, rng) == 50
    assert rank_of(5000.0, draws, rng) == DRAWS_RANKED
    equal = [rank_of(1.0, np.ones(4000), rng) for _ in range(300)]
    assert min(equal) < 10
    assert max(equal) > 90


@pytest.mark.parametrize("levels", [2, 3, 4, 5])
@pytest.mark.parametrize("link", ["cumulative", "adjacent"])
def test_answers_have_the_probabilities_of_the_model(levels, link) -> None:
    if link == "adjacent" and levels != 3:
        with pytest.raises(InputError, match="adjacent needs a scale of 3 levels"):
            world_of(FitSettings(link=link), levels)
        return
    model = world_of(FitSettings(pooled=True, link=link), levels)
    truth = Truth(np.array([0.8, -0.8]), {"side_effect": 0.3, "cut_1": 0.4, "cut_2": 1.3, "log_nu": 0.4})
    table = draw_answers(model, truth, Design(2000, 2, 2), np.random.default_rng(1))
    counts = count_responses(table, table.questions[0]).pooled()
    for a, b, found in zip(counts.mode_a, counts.mode_b, counts.responses, strict=True):
        eta = np.array([truth.ability[a] - truth.ability[b] + 0.3])
        log_p = (
            adjacent_log_probabilities(eta, np.array([0.4]))
            if link == "adjacent"
            else cumulative_log_probabilities(eta, np.array([0.4, 1.3])[: model.n_gaps], levels)
        )
        assert found / found.sum() == pytest.approx(np.exp(log_p[0]), abs=4 * 0.5 / np.sqrt(found.sum()))
    assert counts.responses.sum(axis=1).tolist() == [2000, 2000], "each mode is A equally often"


def test_true_values_have_the_scales_of_the_priors() -> None:
    rng = np.random.default_rng(1)
    truths = [draw_truth(world_of(FitSettings(), 5), 3, rng) for _ in range(4000)]
    ability = np.array([t.ability for t in truths])
    assert ability.sum(axis=1) == pytest.approx(0.0, abs=1e-12)
    assert np.cov(ability.T) == pytest.approx(np.eye(3) - 1 / 3, abs=0.06)
    values = pd.DataFrame([t.parameters for t in truths])
    half_normal = np.sqrt(2 / np.pi)
    expected = {"cut_1": half_normal, "cut_2": 2 * half_normal, "subject_sd": half_normal, "side_effect": 0}
    assert values.mean().to_dict() == pytest.approx(expected, abs=0.05)
    assert values["side_effect"].std() == pytest.approx(0.5, abs=0.03)


def test_an_engine_that_ignores_the_answers_is_caught_by_the_log_likelihood_alone() -> None:
    design, rng = Design(), np.random.default_rng(4)
    replicates = []
    for k in range(60):
        truth = draw_truth(POOLED, 3, rng)
        table = draw_answers(POOLED, truth, design, rng)
        counts = count_responses(table, table.questions[0])
        prior = [draw_truth(POOLED, 3, rng) for _ in range(DRAWS_RANKED)]
        ability = np.array([t.ability for t in prior])[None]
        parameters = {name: np.array([[t.parameters[name] for t in prior]]) for name in truth.parameters}
        draws = Draws(ability, worth_of(ability), parameters, np.zeros((1, DRAWS_RANKED), dtype=bool))
        ranked = ranked_truths(
            true_quantities(truth, counts, POOLED, design), quantities(draws, counts, POOLED, design), rng
        )
        replicates.append(Replicate(k, True, 1.0, 500.0, 0, ranked))
    result = Calibration(POOLED, design, settings_for(POOLED), 4, tuple(replicates))
    assert {check.parameter for check in result.outside} == {LOG_LIKELIHOOD}


def test_a_report_fitted_with_a_quarter_of_the_prior_sd_is_caught() -> None:
    wrong = FitSettings(pooled=True, prior_sd=0.25)
    result = calibrate(POOLED, Design(4, 1, 3), replicates=30, seed=1, settings=wrong)
    assert verdict(result).startswith("MISCALIBRATED")
    assert "intervals too narrow" in verdict(result)
    assert {c.parameter for c in result.outside} >= {"M1 - M2", "M1 - M3"}


def test_every_reported_quantity_is_ranked_whatever_the_number_of_processes() -> None:
    design = Design(3, 1, 3)
    one, two = (calibrate(THREE, design, replicates=4, seed=2, n_jobs=n) for n in (1, 2))
    assert one == two
    assert calibrate(THREE, design, replicates=1, seed=3).replicates[0] != one.replicates[0]
    names = [ranked.parameter for ranked in one.replicates[0].ranked]
    modes = ("M1", "M2", "M3")
    assert names == [
        *(f"ability {mode}" for mode in modes),
        *(f"worth {mode}" for mode in modes),
        *("M1 - M2", "M1 - M3", "M2 - M3"),
        *("side_effect", "cut_1", "subject_sd", LOG_LIKELIHOOD),
    ]


def test_figures_mark_what_lies_outside(tmp_path: Path) -> None:
    write_calibration(normal_calibration(200, prior_sd_halved), tmp_path / "out")
    svg = (tmp_path / "out" / "ecdf_differences.svg").read_text(encoding="utf-8")
    assert "mu: outside" in svg
    assert "nu: outside" not in svg
    found = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert found["calibrated"] is False
    assert {o["parameter"] for o in found["outside"]} == {"mu"}


def test_the_command_prints_a_verdict_and_writes_what_it_counted(tmp_path: Path, capsys) -> None:
    out = tmp_path / "calibration"
    arguments = ["--pooled", "--link", "adjacent", "--replicates", "16", "--jobs", "1", "--out", str(out)]
    assert run(["calibrate", *arguments]) == 0
    said = capsys.readouterr().out
    assert "No fault found: all 48 coverages and all 12 ECDFs" in said
    assert "16 replicates" in said
    assert sorted(path.name for path in out.iterdir()) == sorted(CALIBRATION_FILES)
    ranks = pd.read_csv(out / "ranks.csv")
    assert set(ranks["parameter"]) >= {"log_nu", "side_effect"}
    assert ranks["rank"].between(0, DRAWS_RANKED).all()
    coverage = pd.read_csv(out / "coverage.csv")
    assert list(coverage) == ["parameter", "level", "coverage", "band_low", "band_high", "inside"]
    wide = ranks[ranks["parameter"] == "log_nu"]["rank"].between(10, 89).mean()
    row = coverage[(coverage["parameter"] == "log_nu") & (coverage["level"] == 0.8)].iloc[0]
    assert row["coverage"] == pytest.approx(wide)
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert (summary["replicates"], summary["not_converged"], summary["seed"]) == (16, 0, 1)
    assert summary["fitted_with"]["draws"] == FitSettings().draws


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--levels", "10"], "levels: 10 is not one of: 2, 3, 4, 5, 6, 7, 8, 9"),
        (["--link", "probit"], "--link: 'probit' is not one of: cumulative, adjacent"),
        (["--link", "adjacent", "--levels", "5"], "adjacent needs a scale of 3 levels, not 5"),
        (["--participants", "0"], "participants: 0 is fewer than 1"),
        (["--pooled", "--person-side"], "person_side: this option needs participants, and they are pooled"),
        (["--modes", "1"], "modes: 1 is fewer than 2"),
        (["--modes", "9"], "modes: 9 is more than 8"),
        (["--participants", "9000"], "more than 20000"),
        (["--replicates", "0"], "replicates: 0 is not between 1 and 20000"),
    ],
)
def test_wrong_input_is_one_line_and_nothing_is_written(arguments, said, tmp_path: Path, capsys) -> None:
    out = tmp_path / "calibration"
    assert run(["calibrate", *arguments, "--out", str(out)]) == 2
    error = capsys.readouterr().err.splitlines()
    assert len(error) == 1
    assert said in error[0]
    assert not out.exists()
