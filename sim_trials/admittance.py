"""The control chain around a mode: from the force on the handle to the servos' position references.

Carmichael, Aldini, Liu (2017), Figure 3, and what a robot controller adds behind it::

    wrench at the sensor --A--> tool frame --low-pass--> minus f_D --K_A--> task velocity
        --mode--> joint velocities --speed limit--acceleration limit--lag--> reference of the servos

One compiled step serves batches and live trials alike. All that it remembers stands in one array,
``state``, whose slots are named below.
"""

import math

import numpy as np
from numba.core import types

from data.study import Controller
from sim_trials.compiled import MATRIX, VECTOR, compiled
from sim_trials.kinematics import (
    HANDLE_OFFSET_M,
    JOINT_SPEED_LIMITS_RAD_S,
    SENSOR_OFFSET_M,
    handle_jacobian,
    handle_pose,
)
from sim_trials.modes.method import MEMORY_LENGTH, MODE_TYPE, ModeFunction
from sim_trials.singular_value import smallest_singular_value

CONTROL_PERIOD_S = 0.008
"""125 Hz, the rate at which a UR10 (CB3) accepts commands."""

# Slots of ``state``. The first five are the chain's memory, the others let the caller look into it.
WRENCH = slice(0, 6)
"""Filtered wrench at the handle centre, tool frame [N, N m]."""
RAMP = slice(6, 12)
"""Joint velocities after the limits on speed and acceleration [rad/s]."""
VELOCITY = slice(12, 18)
"""Joint velocities after the lag, in force until the next step [rad/s]."""
REFERENCE = slice(18, 24)
"""Joint positions asked of the servos at the time of the last step [rad]."""
MEMORY = slice(24, 24 + MEMORY_LENGTH)
"""What the mode remembers."""
TWIST = slice(40, 46)
"""Task velocity commanded to the mode, base frame [m/s, rad/s]."""
COMMAND = slice(46, 52)
"""Joint velocities as the mode wants them, before any limit [rad/s]."""
SIGMA = 52
"""Smallest singular value of the Jacobian at the last step (SI units)."""
STATE_LENGTH = 53

# Slots of the packed controller.
_GAIN_V, _GAIN_W, _FILTER, _DAMPING_V, _DAMPING_W, _ACCELERATION, _LAG = range(7)

_SENSOR_TO_HANDLE_M = HANDLE_OFFSET_M - SENSOR_OFFSET_M
_SPEED_LIMITS = JOINT_SPEED_LIMITS_RAD_S


def pack_controller(controller: Controller) -> np.ndarray:
    """The numbers of a study's controller as ``control_step`` reads them: shape (7,)."""
    return np.array(
        [
            controller.translation_gain_m_s_n,
            controller.rotation_gain_rad_s_nm,
            controller.wrench_filter_hz,
            controller.extra_damping_n_s_m,
            controller.extra_damping_nm_s_rad,
            controller.joint_acceleration_rad_s2,
            controller.actuator_lag_s,
        ]
    )


def initial_state(q: np.ndarray) -> np.ndarray:
    """State of the chain with the robot at rest at joint angles ``q`` [rad], shape (STATE_LENGTH,)."""
    state = np.zeros(STATE_LENGTH)
    state[REFERENCE] = q
    return state


@compiled(types.void(MATRIX, VECTOR, VECTOR))
def sensor_wrench(T: np.ndarray, wrench: np.ndarray, measured: np.ndarray) -> None:
    """Write what the force-torque sensor measures when a hand pushes at the handle centre.

    The sensor's axes are the tool's; weight and inertia of the handle are taken as compensated.

    Parameters
    ----------
    T : ndarray, shape (4, 4)
        Pose of the handle.
    wrench : ndarray, shape (6,)
        Force and moment of the hand on the handle, about the handle centre, base frame [N, N m].
    measured : ndarray, shape (6,), written
        Force and moment about the sensor's origin, tool frame [N, N m].
    """
    for k in range(3):
        measured[k] = T[0, k] * wrench[0] + T[1, k] * wrench[1] + T[2, k] * wrench[2]
        measured[3 + k] = T[0, k] * wrench[3] + T[1, k] * wrench[4] + T[2, k] * wrench[5]
    measured[3] -= _SENSOR_TO_HANDLE_M * measured[1]
    measured[4] += _SENSOR_TO_HANDLE_M * measured[0]


@compiled(types.void(VECTOR, VECTOR, MATRIX, MATRIX, VECTOR, types.float64, types.boolean, VECTOR))
def task_velocity(
    controller: np.ndarray,
    measured: np.ndarray,
    T: np.ndarray,
    J: np.ndarray,
    velocity: np.ndarray,
    dt: float,
    enabled: bool,
    state: np.ndarray,
) -> None:
    """Write state[TWIST] = K_A (low-pass(A f_s) - f_D); zero unless the enable trigger is held.

    f_D opposes the velocity that the robot really takes up, J velocity, which near a singularity is
    less than commanded. All gains are the same along all axes, so axes may be the base's from here on.
    """
    share = 1.0 - math.exp(-2.0 * math.pi * controller[_FILTER] * dt)
    wrench = state[WRENCH]
    # A: same axes, moment taken about the handle centre instead of the sensor's origin.
    mx = measured[3] + _SENSOR_TO_HANDLE_M * measured[1]
    my = measured[4] - _SENSOR_TO_HANDLE_M * measured[0]
    wrench[0] += share * (measured[0] - wrench[0])
    wrench[1] += share * (measured[1] - wrench[1])
    wrench[2] += share * (measured[2] - wrench[2])
    wrench[3] += share * (mx - wrench[3])
    wrench[4] += share * (my - wrench[4])
    wrench[5] += share * (measured[5] - wrench[5])

    twist = state[TWIST]
    if not enabled:
        twist[:] = 0.0
        return
    for part in range(2):
        gain = controller[_GAIN_V + part]
        damping = controller[_DAMPING_V + part]
        first = 3 * part
        for i in range(3):
            force = T[i, 0] * wrench[first] + T[i, 1] * wrench[first + 1] + T[i, 2] * wrench[first + 2]
            moving = 0.0
            for k in range(6):
                moving += J[first + i, k] * velocity[k]
            twist[first + i] = gain * (force - damping * moving)


@compiled(types.void(VECTOR, VECTOR, types.float64, VECTOR))
def limit_and_integrate(controller: np.ndarray, command: np.ndarray, dt: float, state: np.ndarray) -> None:
    """Take the wanted joint velocities through the limits and the lag, and move the reference on.

    Speeds are scaled all together, so that the direction of motion stays; so are accelerations.
    """
    scale = 1.0
    for i in range(6):
        # Joints 1-2 and 3-6 have different limits.
        scale = max(scale, abs(command[i]) / _SPEED_LIMITS[i])
    ramp = state[RAMP]
    largest = 0.0
    for i in range(6):
        largest = max(largest, abs(command[i] / scale - ramp[i]))
    allowed = controller[_ACCELERATION] * dt
    share = 1.0 if largest <= allowed else allowed / largest
    lag = 1.0 - math.exp(-dt / controller[_LAG])
    velocity = state[VELOCITY]
    reference = state[REFERENCE]
    for i in range(6):
        reference[i] += dt * velocity[i]
        ramp[i] += share * (command[i] / scale - ramp[i])
        velocity[i] += lag * (ramp[i] - velocity[i])


@compiled(
    types.void(
        MODE_TYPE, VECTOR, VECTOR, VECTOR, VECTOR, types.boolean, types.float64, VECTOR, MATRIX, MATRIX
    )
)
def control_step(
    mode: ModeFunction,
    parameters: np.ndarray,
    controller: np.ndarray,
    q: np.ndarray,
    measured: np.ndarray,
    enabled: bool,
    dt: float,
    state: np.ndarray,
    T: np.ndarray,
    J: np.ndarray,
) -> None:
    """One tick of the chain.

    Parameters
    ----------
    mode : compiled function
        Of ``modes.method.MODE_SIGNATURE``.
    parameters : ndarray
        The mode's parameters, ``ResolvedMode.packed()``.
    controller : ndarray, shape (7,)
        From ``pack_controller``.
    q : ndarray, shape (6,)
        Measured joint angles [rad].
    measured : ndarray, shape (6,)
        Wrench that the sensor measures, tool frame, about the sensor's origin [N, N m].
    enabled : bool
        Whether the enable trigger is held; released, the robot is ramped to a halt.
    dt : float
        Control period [s].
    state : ndarray, shape (STATE_LENGTH,), changed
        The chain's memory; see the slots at the head of this module.
    T, J : ndarray, shapes (4, 4) and (6, 6), written
        Pose and Jacobian of the handle at ``q``.
    """
    handle_pose(q, T)
    handle_jacobian(q, J)
    sigma = smallest_singular_value(J)
    state[SIGMA] = sigma
    task_velocity(controller, measured, T, J, state[VELOCITY], dt, enabled, state)
    mode(q, J, sigma, state[TWIST], dt, parameters, state[MEMORY], state[COMMAND])
    limit_and_integrate(controller, state[COMMAND], dt, state)


@compiled(types.void(VECTOR, types.float64, VECTOR))
def servo_target(state: np.ndarray, since_step_s: float, ctrl: np.ndarray) -> None:
    """Write the servos' position references [rad] at a moment between two control steps.

    Parameters
    ----------
    state : ndarray, shape (STATE_LENGTH,)
        After ``control_step``.
    since_step_s : float
        Time since that step [s]: the end of the physics step about to be taken, so that the servos
        see a straight line and no staircase.
    ctrl : ndarray, shape (6,), written
        Position references.
    """
    reference = state[REFERENCE]
    velocity = state[VELOCITY]
    for i in range(6):
        ctrl[i] = reference[i] + since_step_s * velocity[i]
