"""posterior.nc holds the draws, and ArviZ opens it."""

import json
import warnings

import numpy as np
import pandas as pd

from analysis.diagnostics import convergence
from analysis.fit import fit
from analysis.posterior import write_posterior
from analysis.results import FitSettings


def test_arviz_opens_the_draws_and_finds_the_same_convergence(answers_of, truth, table_of, tmp_path):
    rows = pd.concat(
        [
            answers_of(truth, levels=levels, participants=6, question=f"Q{levels}", seed=levels)
            for levels in (2, 3, 5)
        ]
    )
    found = fit(table_of(rows, modes=["M1", "M2", "M3"]), FitSettings(seed=3))
    write_posterior(found, tmp_path / "posterior.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import arviz as az

        data = az.from_netcdf(tmp_path / "posterior.nc")
        summary = az.summary(data, var_names=["subject_sd"], round_to="none")
    assert data.posterior["ability"].dims == ("chain", "draw", "question", "mode")
    assert list(data.posterior["mode"].values) == ["M1", "M2", "M3"]
    assert list(data.posterior["question_cut_1"].values) == ["Q3", "Q5"]
    assert list(data.posterior["question_cut_2"].values) == ["Q5"]
    for question in found.questions:
        assert question.draws is not None
        name = question.question.name
        np.testing.assert_array_equal(data.posterior["worth"].sel(question=name), question.draws.worth)
        spread = convergence(question.draws.parameters["subject_sd"][None])
        np.testing.assert_allclose(summary.loc[f"subject_sd[{name}]", "ess_bulk"], spread.ess_bulk[0])
    assert data.sample_stats["diverging"].dims == ("chain", "draw")
    assert int(data.observed_data["wins"].sum() + data.observed_data["ties"].sum() / 2) == len(rows)
    assert json.loads(data.attrs["settings"])["seed"] == 3


def test_a_fit_without_draws_is_written_too(table_of, tmp_path):
    rows = pd.DataFrame([("a", "b", "A>B")], columns=["mode_a", "mode_b", "response"])
    write_posterior(fit(table_of(rows, modes=["a", "b", "c"])), tmp_path / "posterior.nc")
    import xarray as xr

    with xr.open_datatree(tmp_path / "posterior.nc", engine="h5netcdf") as tree:
        assert "posterior" not in tree.children
        assert int(tree["observed_data"]["wins"].sum()) == 1
