"""What halted or disturbed a lap: explicit, versioned definitions as pure functions over its trace.

``sigma-dwell/1`` (stuck)
    sigma_min stays below the study's ``sigma_below`` in more control ticks on end than fit into ``dwell_s``.
    Time: the tick in which that is exceeded. It ends the lap.
``elbow-sign/1`` (elbow inversion)
    The elbow angle q3 lies more than 1 deg on the other side of zero (the straight arm) than at the start.
    Time: the first such tick. The lap goes on.
``joint-speed/1`` (protective stop)
    A measured joint speed reaches 98 % of its limit (120 deg/s base and shoulder, 180 deg/s others).
    Time: the first such tick. It ends the lap.

Whatever changes in a definition changes its version, too. The loop halts by the same rules; a test holds
the two together.
"""

import math

import numpy as np

from data.records import EventKind, StuckEvent
from data.study import Stuck
from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S
from sim_trials.loop import JOINT_SPEED_SHARE
from sim_trials.maze import PHASES
from sim_trials.trace import Trace

STUCK_DEFINITION = "sigma-dwell/1"
INVERSION_DEFINITION = "elbow-sign/1"
STOP_DEFINITION = "joint-speed/1"
ELBOW = 2
INVERTED_BY_RAD = math.radians(1.0)


def dwell_ticks(dwell_s: float) -> int:
    """The most control ticks on end below the threshold that are not yet stuck."""
    return math.floor(dwell_s / CONTROL_PERIOD_S + 1e-9)


def ticks_below(sigma: np.ndarray, threshold: float) -> np.ndarray:
    """For each tick, in how many ticks on end up to this one sigma was below the threshold, shape (n,)."""
    tick = np.arange(1, sigma.size + 1)
    last_above = np.maximum.accumulate(np.where(sigma < threshold, 0, tick))
    return tick - last_above


def stuck_tick(sigma: np.ndarray, stuck: Stuck) -> int | None:
    """The tick in which the robot counts as stuck (``sigma-dwell/1``), or None."""
    return _first(ticks_below(sigma, stuck.sigma_below) > dwell_ticks(stuck.dwell_s))


def inversion_tick(elbow_rad: np.ndarray) -> int | None:
    """The tick in which the elbow is found on the other side (``elbow-sign/1``), or None."""
    return _first(elbow_rad * np.sign(elbow_rad[0]) < -INVERTED_BY_RAD)


def stop_tick(qdot: np.ndarray) -> int | None:
    """The tick in which a joint moves too fast (``joint-speed/1``), or None; qdot has shape (n, 6)."""
    return _first((np.abs(qdot) >= JOINT_SPEED_SHARE * np.array(JOINT_SPEED_LIMITS_RAD_S)).any(axis=1))


def events(trace: Trace, phase: np.ndarray, stuck: Stuck) -> tuple[StuckEvent, ...]:
    """All events of a lap in order of time.

    Parameters
    ----------
    trace : Trace
    phase : ndarray, shape (n,)
        Code of the phase of each tick, from ``metrics.phases``.
    stuck : Stuck
        The study's definition.
    """
    sigma = trace.ticks["sigma"]
    found: list[tuple[int | None, EventKind, str]] = [
        (stuck_tick(sigma, stuck), "stuck", STUCK_DEFINITION),
        (inversion_tick(trace.ticks["q"][:, ELBOW]), "elbow_inversion", INVERSION_DEFINITION),
        (stop_tick(trace.ticks["qdot"]), "protective_stop", STOP_DEFINITION),
    ]
    return tuple(
        StuckEvent(
            kind=kind,
            time_s=tick * CONTROL_PERIOD_S,
            sigma_min=float(sigma[tick]),
            phase=PHASES[int(phase[tick])],
            definition=definition,
        )
        for tick, kind, definition in sorted(
            (f for f in found if f[0] is not None), key=lambda f: (f[0], f[1])
        )
        if tick is not None
    )


def _first(is_so: np.ndarray) -> int | None:
    return int(np.argmax(is_so)) if is_so.any() else None
