"""What every method promises: finite joint velocities everywhere, and whatever it declares of itself.

Parametrised over the registry, so that a new method is tested on arrival.
"""

import itertools

import numpy as np
import pytest

from data.errors import InputError
from data.study import Mode
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S, handle_jacobian
from sim_trials.modes.method import MEMORY_LENGTH, Property, ResolvedMode
from sim_trials.modes.registry import METHODS, resolve
from sim_trials.singular_value import smallest_singular_value

START = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.0])


def variants(method: str) -> list[ResolvedMode]:
    """The method with its defaults, and with each parameter at the ends of its range."""
    changes: list[dict[str, float]] = [{}]
    for parameter in METHODS[method].parameters:
        changes += [{parameter.name: parameter.low}, {parameter.name: parameter.high}]
    return [
        resolve(Mode(name="X", method=method, parameters=change))
        for change in changes
        if not contradicts(method, change)
    ]


def contradicts(method: str, change: dict[str, float]) -> bool:
    values = {parameter.name: parameter.default for parameter in METHODS[method].parameters} | change
    return any(values[smaller] >= values[larger] for smaller, larger in METHODS[method].ascending)


def poses() -> list[np.ndarray]:
    """The task's start, random poses, poses near and exactly in elbow-lock and wrist-lock."""
    rng = np.random.default_rng(17)
    found = [START, *rng.uniform(-np.pi, np.pi, size=(20, 6))]
    for joint, value in itertools.product((2, 4), (0.0, 1e-15, 1e-9, -1e-4, 0.01, -0.1, 0.4)):
        q = START + rng.normal(scale=0.3, size=6)
        q[joint] = value
        found.append(q)
    return [*found, np.zeros(6)]


def commands() -> np.ndarray:
    rng = np.random.default_rng(23)
    return np.vstack([np.zeros(6), 0.3 * np.eye(6), -0.1 * np.eye(6), rng.normal(scale=0.3, size=(8, 6))])


class Command:
    """A method called at one pose for one command, with memory of its own."""

    def __init__(self, mode: ResolvedMode, q: np.ndarray, xdot: np.ndarray) -> None:
        self.q, self.xdot, self.J = q.copy(), xdot.copy(), np.empty((6, 6))
        handle_jacobian(self.q, self.J)
        self.sigma = smallest_singular_value(self.J)
        self.qdot = np.full(6, np.nan)
        parameters, memory = mode.packed(), np.zeros(MEMORY_LENGTH)
        inputs = [self.q.copy(), self.J.copy(), self.xdot.copy(), parameters.copy()]
        mode.function(self.q, self.J, self.sigma, self.xdot, 0.008, parameters, memory, self.qdot)
        self.memory = memory
        self.changed_inputs = [
            not np.array_equal(before, after)
            for before, after in zip(inputs, (self.q, self.J, self.xdot, parameters), strict=True)
        ]


def calls(method: str) -> list[tuple[ResolvedMode, Command]]:
    return [
        (mode, Command(mode, q, xdot)) for mode in variants(method) for q in poses() for xdot in commands()
    ]


def declaring(claim: Property) -> list[str]:
    return [name for name, method in METHODS.items() if claim in method.properties]


@pytest.mark.parametrize("method", METHODS)
def test_joint_velocities_are_finite_everywhere(method: str) -> None:
    for _, command in calls(method):
        assert np.isfinite(command.qdot).all(), command.q
        assert np.isfinite(command.memory).all(), command.q


@pytest.mark.parametrize("method", METHODS)
def test_no_command_means_no_motion(method: str) -> None:
    for mode in variants(method):
        for q in poses():
            np.testing.assert_array_equal(Command(mode, q, np.zeros(6)).qdot, 0.0)


@pytest.mark.parametrize("method", METHODS)
def test_inputs_are_only_read(method: str) -> None:
    for _, command in calls(method):
        assert not any(command.changed_inputs)


@pytest.mark.parametrize("method", METHODS)
def test_same_inputs_give_the_same_bits(method: str) -> None:
    mode = variants(method)[0]
    for q in poses():
        xdot = commands()[-1]
        np.testing.assert_array_equal(Command(mode, q, xdot).qdot, Command(mode, q, xdot).qdot)


@pytest.mark.parametrize("method", declaring(Property.NEVER_REVERSES))
def test_the_handle_never_moves_against_the_command(method: str) -> None:
    for _, command in calls(method):
        assert command.xdot @ command.J @ command.qdot >= -1e-12 * (command.xdot @ command.xdot)


@pytest.mark.parametrize("method", declaring(Property.NEVER_AMPLIFIES))
def test_the_handle_never_moves_faster_than_commanded(method: str) -> None:
    for _, command in calls(method):
        commanded = np.linalg.norm(command.xdot)
        assert np.linalg.norm(command.J @ command.qdot) <= commanded * (1 + 1e-8)


@pytest.mark.parametrize("method", declaring(Property.INVERSE_ABOVE_SIGMA_T))
def test_far_from_singularity_it_is_the_plain_inverse(method: str) -> None:
    checked = 0
    for mode, command in calls(method):
        sigma_t = mode.values[METHODS[method].parameter_names.index("sigma_t")]
        if command.sigma >= max(sigma_t, 0.05):
            checked += 1
            np.testing.assert_allclose(command.qdot, np.linalg.solve(command.J, command.xdot), atol=1e-10)
    assert checked > 50


def value(mode: ResolvedMode, parameter: str) -> float:
    return mode.values[mode.method.parameter_names.index(parameter)]


def speed_share(command: Command) -> float:
    return float(np.max(np.abs(command.qdot) / JOINT_SPEED_LIMITS_RAD_S))


@pytest.mark.parametrize("method", declaring(Property.WITHIN_SPEED_SHARE))
def test_no_joint_passes_its_share_of_the_speed_limit(method: str) -> None:
    fastest = 0.0
    for mode, command in calls(method):
        share = speed_share(command) / value(mode, "speed_share")
        assert share <= 1 + 1e-12
        fastest = max(fastest, share)
    assert fastest > 0.999, "the limit was never met, so nothing was tested"


@pytest.mark.parametrize("method", declaring(Property.WITHIN_GAMMA_MAX))
def test_no_joint_passes_gamma_max(method: str) -> None:
    for mode, command in calls(method):
        assert np.abs(command.qdot).max() <= value(mode, "gamma_max") * (1 + 1e-12)


@pytest.mark.parametrize("method", declaring(Property.DAMPED_GAIN))
def test_joint_velocities_are_bounded_by_the_damping(method: str) -> None:
    for mode, command in calls(method):
        bound = np.linalg.norm(command.xdot) / (2 * value(mode, "lambda"))
        assert np.linalg.norm(command.qdot) <= bound * (1 + 1e-9)


@pytest.mark.parametrize("method", declaring(Property.LEAST_RESIDUAL))
def test_what_is_missing_is_orthogonal_to_what_is_done(method: str) -> None:
    checked = 0
    for mode, command in calls(method):
        if speed_share(command) < 0.999 * value(mode, "speed_share"):
            done = command.J @ command.qdot
            assert abs((command.xdot - done) @ done) <= 1e-9 * (command.xdot @ command.xdot)
            checked += bool(done.any())
    assert checked > 50


@pytest.mark.parametrize("method", [name for name, method in METHODS.items() if method.ascending])
def test_contradictory_parameters_are_refused_with_both_values(method: str) -> None:
    for smaller, larger in METHODS[method].ascending:
        parameters = {parameter.name: parameter.default for parameter in METHODS[method].parameters}
        parameters[smaller] = parameters[larger]
        with pytest.raises(InputError, match=f"{smaller} = .* must be smaller than {larger} = "):
            resolve(Mode(name="X", method=method, parameters=parameters))


@pytest.mark.parametrize("claim", Property)
def test_every_claim_is_made_by_some_method(claim: Property) -> None:
    assert declaring(claim)


@pytest.mark.parametrize("method", METHODS)
def test_method_explains_itself(method: str) -> None:
    entry = METHODS[method]
    assert entry.summary
    assert entry.equation
    assert entry.source
    for parameter in entry.parameters:
        assert parameter.low <= parameter.default <= parameter.high
        assert parameter.meaning
