"""A study may compare any number of methods, not three: six of them, in all their pairs."""

import itertools
from pathlib import Path

import pandas as pd
import pytest

from app.atlas import study_atlas, write_atlas
from app.cli.main import run
from data.study_file import read_study, study_text

SIX = (
    "asymmetric_dls",
    "constant_dls",
    "filtered_selectively_damped_dls",
    "pseudo_inverse",
    "transpose",
    "variable_damping_svd",
)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six methods at their defaults on a narrow maze, one lap each, asked one question."""
    text = study_text("carmichael2017")
    head, questions = text[: text.index("[[modes]]")], text[text.index("[[questions]]") :]
    asked, protocol = questions[: questions.index('name = "Q2"')], questions[questions.index("[protocol]") :]
    modes = "".join(f'[[modes]]\nname = "{name}"\nmethod = "{name}"\n\n' for name in SIX)
    rest = asked.rsplit("[[questions]]", 1)[0] + protocol.replace(
        "laps_per_condition = 3", "laps_per_condition = 1"
    )
    rest = rest.replace("repetitions = 2", "repetitions = 1").replace(
        "right_y_m = -1.045", "right_y_m = -0.4"
    )
    path = tmp_path_factory.mktemp("many") / "six.toml"
    path.write_text(head + modes + rest.replace("break_every = 3", "break_every = 0"))
    return path


def test_six_modes_are_compared_in_fifteen_pairs_and_ranked(study: Path) -> None:
    store, report = str(study.parent / "six.sqlite"), study.parent / "report"
    assert run(["simulate", "--study", str(study), "--store", store, "--participants", "2"]) == 0
    assert run(["report", "--store", store, "--include-simulated", "--out", str(report)]) == 0
    worth = pd.read_csv(report / "worth.csv").query("question == 'Q1'")
    assert set(worth["mode"]) == set(SIX)
    assert worth["worth_mean"].sum() == pytest.approx(1.0)
    pairs = pd.read_csv(report / "pairwise.csv").query("question == 'Q1'")
    found = {frozenset(pair) for pair in zip(pairs.iloc[:, 1], pairs.iloc[:, 2], strict=True)}
    assert found == {frozenset(pair) for pair in itertools.combinations(SIX, 2)}


def test_the_strategies_of_beaudoin_2022_ship_as_a_guided_study() -> None:
    study = read_study("beaudoin2022")
    assert study.protocol.trial_source == "guided"
    assert [mode.method for mode in study.modes] == ["constant_dls", "transpose", "variable_damping_svd"]
    for mode in (study.modes[0], study.modes[2]):
        assert mode.parameters["lambda"] ** 2 == pytest.approx(0.1)


def test_the_atlas_is_one_page_with_every_mode_and_needs_no_other_file(tmp_path: Path) -> None:
    paths = write_atlas(study_atlas(read_study("beaudoin2022"), "beaudoin2022", operators=1), tmp_path)
    page = paths[0].read_text()
    assert all(path.stat().st_size > 1000 for path in paths)
    for name in ("DPI", "JT", "SVD"):
        assert f"<th scope=row class=words>{name}</th>" in page
        assert f"<small>{name}</small></h3>" in page
    assert page.count("<svg") == 1
    assert "src=" not in page
    assert "stylesheet" not in page
