"""MuJoCo against a plant without dynamics: joints that trail their references by the servo's lag."""

import numpy as np
import pytest

from data.study import Study
from sim_trials.admittance import (
    CONTROL_PERIOD_S,
    SIGMA,
    control_step,
    initial_state,
    pack_controller,
    servo_target,
)
from sim_trials.loop import ENABLE, SUBSTEPS, counted
from sim_trials.model import PHYSICS_STEP_S
from sim_trials.modes.registry import resolve
from sim_trials.operators import draw_operator
from sim_trials.start import start_angles
from sim_trials.trial import mode_of, simulate

SERVO_LAG_S = np.array([0.025, 0.025, 0.020, 0.015, 0.015, 0.015])
"""kv / kp of the model's servos."""


@pytest.mark.parametrize("mode_name", ["M1", "M2", "M3"])
def test_mujoco_follows_the_lagging_kinematic_plant_within_4_mm(study: Study, mode_name: str) -> None:
    """The same forces on both, open loop: what they differ by adds up over the lap."""
    trace = simulate(study, mode_name, draw_operator(3), seed=3)
    mode = resolve(mode_of(study, mode_name))
    q = np.array(start_angles(study.maze))
    state, controller, parameters = initial_state(q), pack_controller(study.controller), mode.packed()
    T, J, measured, target = np.empty((4, 4)), np.empty((6, 6)), np.empty(6), np.empty(6)
    follow = 1.0 - np.exp(-PHYSICS_STEP_S / SERVO_LAG_S)
    apart, sigma = [], []
    for counts, triggers in zip(trace.counts, trace.triggers, strict=True):
        counted(counts, measured)
        enabled = bool(triggers & ENABLE)
        control_step(
            mode.function, parameters, controller, q, measured, enabled, CONTROL_PERIOD_S, state, T, J
        )
        apart.append(T[:3, 3].copy())
        sigma.append(state[SIGMA])
        for substep in range(SUBSTEPS):
            servo_target(state, (substep + 1) * PHYSICS_STEP_S, target)
            q += follow * (target - q)
    distance = np.linalg.norm(np.array(apart) - trace.ticks["handle"], axis=1)
    assert distance.max() < 0.004
    np.testing.assert_allclose(sigma, trace.ticks["sigma"], atol=0.002)
