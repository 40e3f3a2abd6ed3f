"""How a study's mode becomes a method: names, parameters, and a new method by one file."""

import pickle
import sys
from pathlib import Path

import numpy as np
import pytest

from data.errors import ElbowroomError, InputError
from data.study import Controller, Mode
from data.study_file import read_study
from sim_trials import modes
from sim_trials.admittance import COMMAND, TWIST, control_step, initial_state, pack_controller
from sim_trials.modes import registry
from sim_trials.modes.method import Method
from sim_trials.modes.registry import METHODS, method_names, resolve

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])

NEW_METHOD = '''
"""The Jacobian's transpose, scaled."""
import numpy as np
from sim_trials.modes.method import Method, Parameter, mode_function

@mode_function
def qdot_command(q, J, sigma, xdot, dt, parameters, memory, qdot_out):
    for j in range(6):
        qdot_out[j] = 0.0
        for i in range(6):
            qdot_out[j] += parameters[0] * J[i, j] * xdot[i]

METHOD = Method(
    name="{name}", summary="Jacobian transpose", equation="qdot = gain J' xdot", source="Wolovich (1984)",
    parameters=(Parameter("gain", 0.5, 0.0, 2.0, "", "scale"),), function=qdot_command,
)
'''


@pytest.fixture
def folder_of_modes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(modes, "__path__", [*modes.__path__, str(tmp_path)])
    before = set(sys.modules)
    yield tmp_path
    for name in set(sys.modules) - before:
        if name.startswith("sim_trials.modes."):
            del sys.modules[name]


def test_a_new_method_is_one_file(folder_of_modes: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder_of_modes / "scaled_transpose.py").write_text(NEW_METHOD.format(name="scaled_transpose"))
    monkeypatch.setattr(registry, "METHODS", registry.discover())
    mode = resolve(Mode(name="M4", method="scaled_transpose", parameters={"gain": 0.25}))
    state, T, J = initial_state(START), np.empty((4, 4)), np.empty((6, 6))
    measured = np.array([5.0, 0.0, 10.0, 0.0, 0.3, 0.0])
    signatures = len(control_step.signatures)
    control_step(
        mode.function, mode.packed(), pack_controller(Controller()), START, measured, True, 0.008, state, T, J
    )
    assert np.abs(state[TWIST]).max() > 0.0
    np.testing.assert_allclose(state[COMMAND], 0.25 * J.T @ state[TWIST], atol=1e-15)
    assert len(control_step.signatures) == signatures, "the control step was compiled anew"


def test_a_method_must_bear_the_name_of_its_file(folder_of_modes: Path) -> None:
    (folder_of_modes / "one_name.py").write_text(NEW_METHOD.format(name="other_name"))
    with pytest.raises(ElbowroomError, match=r"METHOD\.name is 'other_name'"):
        registry.discover()


def test_every_mode_of_the_2017_study_resolves_to_its_parameters() -> None:
    resolved = {mode.name: resolve(mode) for mode in read_study("carmichael2017").modes}
    assert resolved["M1"].values == (0.2, 0.25)
    assert resolved["M2"].values == (0.6, 0.25)
    assert resolved["M3"].values == (0.6, 0.2, 0.25, 0.01)
    assert resolved["M1"].method is resolved["M2"].method is METHODS["dls"]


@pytest.mark.parametrize("method", METHODS.values(), ids=lambda method: method.name)
def test_a_method_goes_to_another_process_by_its_name(method: Method) -> None:
    sent = pickle.dumps(method)
    assert len(sent) < 200, "machine code must not travel"
    assert pickle.loads(sent) is method


def test_defaults_fill_what_a_study_leaves_out() -> None:
    assert resolve(Mode(name="M", method="dls", parameters={"sigma_t": 0.1})).values == (0.2, 0.1)


def test_an_unknown_method_is_answered_with_the_valid_ones() -> None:
    with pytest.raises(InputError) as error:
        resolve(Mode(name="M9", method="dsl"))
    assert "M9" in str(error.value)
    assert all(name in str(error.value) for name in method_names())
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("method", METHODS)
def test_an_unknown_parameter_is_answered_with_the_valid_ones(method: str) -> None:
    with pytest.raises(InputError) as error:
        resolve(Mode(name="M9", method=method, parameters={"lamda0": 0.2}))
    assert "lamda0" in str(error.value)
    assert all(name in str(error.value) for name in METHODS[method].parameter_names)


@pytest.mark.parametrize("value", [-0.2, 0.0, 1e6])
def test_a_value_outside_its_range_is_answered_with_the_range(value: float) -> None:
    with pytest.raises(InputError, match=r"lambda0 = .* is not between 0\.001 and 10"):
        resolve(Mode(name="M9", method="dls", parameters={"lambda0": value}))
