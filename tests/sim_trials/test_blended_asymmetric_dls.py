"""The blended M3: M2 on a steady way in, M1 on a steady way out, and no chatter in between."""

import numpy as np
import pytest

from data.study import Mode
from sim_trials.kinematics import handle_jacobian
from sim_trials.modes.method import MEMORY_LENGTH, ResolvedMode
from sim_trials.modes.registry import resolve
from sim_trials.singular_value import smallest_singular_value

NEAR_LOCK = np.array([3.4504, -1.4226, 0.4, -0.2959, 1.8796, 0.0])
DT = 0.008
J = np.empty((6, 6))
handle_jacobian(NEAR_LOCK, J)
SIGMA = smallest_singular_value(J)
BEND = J @ np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])


def trace(mode: ResolvedMode, elbow_speeds: np.ndarray) -> np.ndarray:
    """Joint velocities for a series of commands, each a motion of the elbow at the given speed [rad/s]."""
    memory, out = np.zeros(MEMORY_LENGTH), np.empty((len(elbow_speeds), 6))
    for k, speed in enumerate(elbow_speeds):
        mode.function(NEAR_LOCK, J, SIGMA, speed * BEND, DT, mode.packed(), memory, out[k])
    return out


def method(name: str, **parameters: float) -> ResolvedMode:
    return resolve(Mode(name="X", method=name, parameters=parameters))


@pytest.mark.parametrize(("speed", "lambda0"), [(-3.0, 0.6), (3.0, 0.2)])
def test_a_steady_motion_ends_at_the_damping_of_its_direction(speed: float, lambda0: float) -> None:
    steady = trace(method("blended_asymmetric_dls"), np.full(200, speed))[-1]
    np.testing.assert_allclose(steady, trace(method("dls", lambda0=lambda0), np.array([speed]))[0], rtol=1e-9)


def test_a_trembling_hand_does_not_make_it_chatter() -> None:
    """Joint speed per command: M3 jumps with every change of sign, the blended mode hardly moves."""
    tremor = 0.3 * (-1.0) ** np.arange(200)
    jumps = {}
    for name in ("asymmetric_dls", "blended_asymmetric_dls"):
        gains = np.linalg.norm(trace(method(name), tremor), axis=1)[50:] / 0.3
        jumps[name] = np.abs(np.diff(gains)).max() / gains.mean()
    assert jumps["blended_asymmetric_dls"] < 0.1 * jumps["asymmetric_dls"]


def test_damping_never_changes_faster_than_its_limit() -> None:
    rng = np.random.default_rng(59)
    mode, memory, out = (
        method("blended_asymmetric_dls", lambda0_rate_per_s=2.0),
        np.zeros(MEMORY_LENGTH),
        np.empty(6),
    )
    lambdas = []
    for speed in np.repeat(rng.normal(size=20), 30):
        mode.function(NEAR_LOCK, J, SIGMA, speed * BEND, DT, mode.packed(), memory, out)
        lambdas.append(memory[2])
    assert np.abs(np.diff(lambdas)).max() == pytest.approx(2.0 * DT, rel=1e-9)
    assert 0.2 <= min(lambdas) < 0.25
    assert 0.55 < max(lambdas) <= 0.6


def test_with_equal_dampings_it_is_plain_dls() -> None:
    equal = method("blended_asymmetric_dls", lambda0_towards=0.6, lambda0_away=0.6)
    speeds = np.random.default_rng(61).normal(size=50)
    np.testing.assert_allclose(trace(equal, speeds), trace(method("dls", lambda0=0.6), speeds), rtol=1e-14)
