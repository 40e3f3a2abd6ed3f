"""Reports on scales of any number of levels, and with the options of the model, from a CSV to the page."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from app.cli.main import run
from data.answers import SCALES


def answers(path: Path, levels: int, people: int = 4) -> Path:
    """Every answer of the scale at least once, about three modes of which M1 is liked."""
    rng, scale = np.random.default_rng(levels), SCALES[levels]
    rows = []
    for s in range(people):
        for a, b in (("M1", "M2"), ("M3", "M1"), ("M2", "M3"), ("M2", "M1")):
            lead = (a == "M1") - (b == "M1") + rng.normal()
            k = int(np.clip(np.floor(levels * (0.5 - lead / 4)), 0, levels - 1))
            rows.append((f"p{s}", "Q1", a, b, scale[k]))
    rows += [("p0", "Q1", "M2", "M3", answer) for answer in scale]
    frame = pd.DataFrame(rows, columns=["participant", "question", "mode_a", "mode_b", "response"])
    frame.to_csv(path, index=False)
    return path


@pytest.mark.parametrize("levels", [4, 7, 9])
def test_a_scale_of_any_length_is_reported_from_start_to_end(tmp_path, levels):
    out, file = tmp_path / "out", answers(tmp_path / "a.csv", levels)
    told = ["--levels", str(levels)] if levels % 2 == 0 else []
    assert run(["report", "--responses", str(file), *told, "--out", str(out)]) == 0
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))["questions"]["Q1"]
    assert (summary["levels"], summary["levels_inferred"], summary["ranked"]) == (
        levels,
        levels % 2 == 1,
        True,
    )
    parameters = pd.read_csv(out / "parameters.csv")["name"].tolist()
    cuts = [f"cut_{k + 1}" for k in range((levels - 1) // 2)]
    assert parameters == ["side_effect", *cuts, "subject_sd"]
    strength = pd.read_csv(out / "strength.csv")
    table = pd.read_csv(file)
    is_strong = table["response"].str.count(">") > 1
    assert strength[["much_i", "much_j"]].to_numpy().sum() == is_strong.sum()
    page = (out / "report.html").read_text(encoding="utf-8")
    assert {4: "with four levels", 7: "with seven levels", 9: "with nine levels"}[levels] in page
    markers = {
        4: "Cut-point: how large",
        7: "circle, square and diamond.",
        9: "circle, square, diamond and tri",
    }
    assert markers[levels] in page
    checked = pd.read_csv(out / "predictive.csv")
    assert ("ties" in checked["kind"].tolist()) == (levels % 2 == 1)
    assert (checked["kind"] == "level").sum() == 2 * (levels // 2)


def test_options_reach_parameters_methods_and_summary(tmp_path):
    out, file = tmp_path / "out", answers(tmp_path / "a.csv", 3)
    options = ["--lapse", "--person-side", "--person-scale", "--position"]
    assert run(["report", "--responses", str(file), *options, "--out", str(out)]) == 0
    names = pd.read_csv(out / "parameters.csv")["name"].tolist()
    assert names == [
        *("side_effect", "cut_1", "lapse", "side_drift", "learning_M1", "learning_M2", "learning_M3"),
        *("subject_sd", "side_sd", "scale_sd"),
    ]
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert "with careless answers (lapse)" in summary["model"]
    assert "the place of a comparison and learning (position)" in summary["model"]
    assert summary["priors"]["lapse"] == "Beta(1, 9)"
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "On the logit scale, except “careless” and “own widths”, with" in page
    for source in ("Wichmann, F. A.", "Meade, A. W.", "Johnson, T. R."):
        assert source in page


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--levels", "5"], "is not on a scale of 5 levels: A>>B, A>B, A=B, B>A, B>>A"),
        (["--levels", "6"], "is not on a scale of 6 levels: A>>>B, A>>B"),
        (["--levels", "10"], "levels: 10 is not one of: 2, 3, 4, 5, 6, 7, 8, 9"),
        (["--levels", "7", "--study", "carmichael2017"], "--levels: a study says how many levels"),
        (["--lapse", "--engine", "gibbs"], "lapse: the engine gibbs does not have this option"),
        (["--pooled", "--person-scale"], "person_scale: this option needs participants, and they are pooled"),
    ],
)
def test_what_does_not_fit_is_one_line(tmp_path, capsys, arguments, message):
    out, file = tmp_path / "out", answers(tmp_path / "a.csv", 7)
    assert run(["report", "--responses", str(file), *arguments, "--out", str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert not out.exists()
