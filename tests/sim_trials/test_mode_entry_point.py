"""A method in a package of its own, as the README shows it: found by its entry point, as good as any."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from data.errors import ElbowroomError
from data.study_file import study_text
from sim_trials.modes import registry

README = Path(registry.__file__).parents[1] / "README.md"


def block(language: str) -> str:
    """The one block of a language that the README shows for a package with a method."""
    said = README.read_text(encoding="utf-8").partition("#### In a package of your own")[2]
    return re.findall(rf"^```{language}\n(.*?)^```$", said, re.MULTILINE | re.DOTALL)[0]


MODULE = block("python")
POINTS = tomllib.loads(block("toml"))["project"]["entry-points"][registry.ENTRY_POINT_GROUP]

SESSION = """
import sys
from app.cli.main import run
from data.study_file import read_study
from sim_trials.live import LiveTrial
from sim_trials.operators import draw_operator
from sim_trials.scripted_hand import ScriptedHand
from sim_trials.trial import finish, replay, run_trial
from sim_trials.modes.registry import method_names

good, bad, atlas = sys.argv[1:]
assert run(["study", "check", good]) == 0
assert run(["study", "check", bad]) == 2
assert run(["study", "atlas", good, "--operators", "0", "--out", atlas]) == 0
study = read_study(good)
lap = run_trial(study, "G", draw_operator(1), seed=1)
print("lap", lap.outcome, replay(lap.recording, study).metrics == lap.metrics)
trial, hand = LiveTrial(study, "G"), ScriptedHand(study)
while trial.ending is None:
    trial.advance(hand.aim(trial.view, 0.008))
print("live", finish(study, "G", trial.inputs, lap=1).outcome)
"""


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """A folder of installed packages with one in it: what an installer leaves behind."""
    folder = tmp_path / "site"
    package, info = folder / "wall_modes", folder / "wall_modes-1.0.dist-info"
    package.mkdir(parents=True)
    info.mkdir()
    (package / "__init__.py").write_text("")
    (package / "slowing_dls.py").write_text(MODULE)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: wall-modes\nVersion: 1.0\n")
    announce(folder, *(f"{name} = {value}" for name, value in POINTS.items()))
    return folder


def announce(site: Path, *lines: str) -> None:
    text = "\n".join((f"[{registry.ENTRY_POINT_GROUP}]", *lines, ""))
    (site / "wall_modes-1.0.dist-info" / "entry_points.txt").write_text(text)


@pytest.fixture
def forgotten() -> None:
    """No module of the package is left to the next test."""
    yield
    for name in [name for name in sys.modules if name.startswith("wall_modes")]:
        del sys.modules[name]


def test_a_packaged_method_is_checked_listed_and_runs_a_lap_and_a_live_trial(
    site: Path, tmp_path: Path
) -> None:
    text = study_text("carmichael2017").replace("right_y_m = -1.045", "right_y_m = -0.6")
    mode = '[[modes]]\nname = "G"\nmethod = "slowing_dls"\nparameters = { lambda = 0.2 }\n\n[[questions]]'
    good, bad = tmp_path / "good.toml", tmp_path / "bad.toml"
    good.write_text(text.replace("[[questions]]", mode, 1))
    bad.write_text(good.read_text().replace('"slowing_dls"', '"slowing_dsl"'))
    ended = subprocess.run(
        [sys.executable, "-W", "error", "-c", SESSION, str(good), str(bad), str(tmp_path / "atlas")],
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join((str(site), str(Path(registry.__file__).parents[2]))),
        },
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert ended.returncode == 0, ended.stderr
    assert "lap completed True" in ended.stdout
    assert "live completed" in ended.stdout
    assert "<h3>slowing_dls <small>G</small></h3>" in (tmp_path / "atlas" / "atlas.html").read_text()
    assert "'slowing_dsl'" in ended.stderr
    assert "slowing_dls, " in ended.stderr, "the packaged method is not among the valid names"


@pytest.mark.usefixtures("forgotten")
def test_it_stands_among_the_others_in_alphabetical_order(
    site: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(site)
    found = registry.discover()
    assert list(found) == sorted([*registry.METHODS, *POINTS])


@pytest.mark.usefixtures("forgotten")
@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("slowing_dls = wall_modes.nowhere:METHOD", "cannot be imported: ModuleNotFoundError"),
        ("slowing_dls = wall_modes.slowing_dls:qdot_command", "not a sim_trials.modes.method.Method"),
        ("soft = wall_modes.slowing_dls:METHOD", "METHOD.name is 'slowing_dls'"),
        ("dls = wall_modes.slowing_dls:METHOD", "there is a method of this name already"),
    ],
)
def test_a_package_that_announces_nonsense_is_named(
    site: Path, monkeypatch: pytest.MonkeyPatch, line: str, said: str
) -> None:
    announce(site, line)
    monkeypatch.syspath_prepend(site)
    with pytest.raises(ElbowroomError) as error:
        registry.discover()
    assert "wall-modes" in str(error.value)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.usefixtures("forgotten")
def test_a_function_that_is_not_compiled_is_refused(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (site / "wall_modes" / "slowing_dls.py").write_text(MODULE.replace("@mode_function\n", ""))
    monkeypatch.syspath_prepend(site)
    with pytest.raises(ElbowroomError, match="not decorated with @mode_function"):
        registry.discover()
