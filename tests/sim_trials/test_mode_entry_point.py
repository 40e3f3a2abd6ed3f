"""A method in a package of its own: found by its entry point, as good as those that ship."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from data.errors import ElbowroomError
from data.study_file import study_text
from sim_trials.modes import registry

MODULE = '''
"""Damped least squares at half speed."""

import numpy as np

from sim_trials.modes.damped_inverse import damped_inverse
from sim_trials.modes.method import Method, Parameter, Property, mode_function


@mode_function
def qdot_command(q, J, sigma, xdot, dt, parameters, memory, qdot_out):
    damped_inverse(J, 0.4, xdot, qdot_out)
    for i in range(6):
        qdot_out[i] *= parameters[0]


METHOD = Method(
    name="gentle", summary="Damped and slow", equation="qdot = speed J' (J J' + 0.16 I)^-1 xdot",
    source="a test",
    parameters=(Parameter("speed", 0.5, 0.0, 1.0, "", "scale"),),
    properties=frozenset({Property.NEVER_REVERSES, Property.NEVER_AMPLIFIES}), function=qdot_command,
)
'''

SESSION = """
import sys
from app.cli.main import run
from data.study_file import read_study
from sim_trials.live import LiveTrial
from sim_trials.operators import draw_operator
from sim_trials.scripted_hand import ScriptedHand
from sim_trials.trial import finish, replay, run_trial
from sim_trials.modes.registry import method_names

good, bad = sys.argv[1:]
assert run(["study", "check", good]) == 0
assert run(["study", "check", bad]) == 2
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
    package, info = folder / "gentle_modes", folder / "gentle_modes-1.0.dist-info"
    package.mkdir(parents=True)
    info.mkdir()
    (package / "__init__.py").write_text("")
    (package / "gentle.py").write_text(MODULE)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: gentle-modes\nVersion: 1.0\n")
    announce(folder, "gentle = gentle_modes.gentle:METHOD")
    return folder


def announce(site: Path, line: str) -> None:
    text = f"[{registry.ENTRY_POINT_GROUP}]\n{line}\n"
    (site / "gentle_modes-1.0.dist-info" / "entry_points.txt").write_text(text)


@pytest.fixture
def forgotten() -> None:
    """No module of the package is left to the next test."""
    yield
    for name in [name for name in sys.modules if name.startswith("gentle_modes")]:
        del sys.modules[name]


def test_a_packaged_method_is_checked_listed_and_runs_a_lap_and_a_live_trial(
    site: Path, tmp_path: Path
) -> None:
    text = study_text("carmichael2017").replace("right_y_m = -1.045", "right_y_m = -0.6")
    mode = '[[modes]]\nname = "G"\nmethod = "gentle"\nparameters = { speed = 0.8 }\n\n[[questions]]'
    good, bad = tmp_path / "good.toml", tmp_path / "bad.toml"
    good.write_text(text.replace("[[questions]]", mode, 1))
    bad.write_text(good.read_text().replace('method = "gentle"', 'method = "gentel"'))
    ended = subprocess.run(
        [sys.executable, "-W", "error", "-c", SESSION, str(good), str(bad)],
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join((str(site), str(Path(registry.__file__).parents[2]))),
        },
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert ended.returncode == 0, ended.stderr
    assert "lap completed True" in ended.stdout
    assert "live completed" in ended.stdout
    assert "'gentel'" in ended.stderr
    assert "gentle, " in ended.stderr, "the packaged method is not among the valid names"


@pytest.mark.usefixtures("forgotten")
def test_it_stands_among_the_others_in_alphabetical_order(
    site: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(site)
    found = registry.discover()
    assert list(found) == sorted([*registry.METHODS, "gentle"])


@pytest.mark.usefixtures("forgotten")
@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("gentle = gentle_modes.nowhere:METHOD", "cannot be imported: ModuleNotFoundError"),
        ("gentle = gentle_modes.gentle:qdot_command", "not a sim_trials.modes.method.Method"),
        ("soft = gentle_modes.gentle:METHOD", "METHOD.name is 'gentle'"),
        ("dls = gentle_modes.gentle:METHOD", "there is a method of this name already"),
    ],
)
def test_a_package_that_announces_nonsense_is_named(
    site: Path, monkeypatch: pytest.MonkeyPatch, line: str, said: str
) -> None:
    announce(site, line)
    monkeypatch.syspath_prepend(site)
    with pytest.raises(ElbowroomError) as error:
        registry.discover()
    assert "gentle-modes" in str(error.value)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.usefixtures("forgotten")
def test_a_function_that_is_not_compiled_is_refused(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (site / "gentle_modes" / "gentle.py").write_text(MODULE.replace("@mode_function\n", ""))
    monkeypatch.syspath_prepend(site)
    with pytest.raises(ElbowroomError, match="not decorated with @mode_function"):
        registry.discover()
