"""A lap as somebody watching it can see it, 25 times a second: robot, cursor, hand. No mode, no sigma."""

from dataclasses import dataclass

import numpy as np

from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.compiled import compiled
from sim_trials.kinematics import handle_pose
from sim_trials.loop import BLAST, ENABLE, counted, handle_wrench
from sim_trials.recording import STATE_EVERY, Recording

FRAME_HZ = 1.0 / (STATE_EVERY * CONTROL_PERIOD_S)
"""Frames per second: the rate of a recording's states."""

_SPEED_SPAN = 2
"""Speeds are central differences over this many frames to either side (160 ms): as steady as a gauge."""


@dataclass(frozen=True)
class Frames:
    """What is drawn of a lap; n frames.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
    q_rad : ndarray, shape (n, 6)
        Joint angles.
    cursor_m, hand_m : ndarray, shape (n, 2)
        y and z on the wall (base frame). The hand is where its spring would come to rest: beside the cursor
        by the force along the wall over the hand's stiffness.
    tilt_deg, tilt_direction_rad : ndarray, shape (n,)
        Lean of the nozzle; direction as somebody facing the wall sees it, 0 right, pi/2 up.
    is_blasting, is_enabled : ndarray of bool, shape (n,)
    speed_m_s : ndarray, shape (n,)
        Of the cursor.
    force_share : ndarray, shape (n,)
        Force of the hand over the most it pulls, at most 1. A simulated operator's limit is on the whole
        force, a person's on the force along the wall (``guidance``).
    """

    time_s: np.ndarray
    q_rad: np.ndarray
    cursor_m: np.ndarray
    tilt_deg: np.ndarray
    tilt_direction_rad: np.ndarray
    is_blasting: np.ndarray
    is_enabled: np.ndarray
    speed_m_s: np.ndarray
    hand_m: np.ndarray
    force_share: np.ndarray


def frames(recording: Recording, hz: float = FRAME_HZ) -> Frames:
    """What is drawn of a recorded lap.

    Parameters
    ----------
    recording : Recording
    hz : float
        Frames per second, at most the recorded 25. Each frame is the last recorded state before its time.
    """
    states, facts = recording.states, recording.facts
    n = states.size
    q = states["q"].astype(np.float64)
    force = np.empty((n, 3))
    _forces(q, np.ascontiguousarray(recording.counts[::STATE_EVERY]), force)
    cursor = np.column_stack([states["cursor_y"], states["cursor_z"]]).astype(np.float64)
    triggers = recording.triggers[::STATE_EVERY]
    person = facts.operator or facts.hand or {}
    limited = force if facts.operator else force[:, 1:]
    share = np.sqrt((limited**2).sum(axis=1)) / person["force_cap_n"]
    count = int((n - 1) * hz / FRAME_HZ + 1e-9) + 1
    kept = np.minimum((np.arange(count) * (FRAME_HZ / hz) + 1e-9).astype(np.int64), n - 1)
    return Frames(
        time_s=np.arange(count) / hz,
        q_rad=q[kept],
        cursor_m=cursor[kept],
        tilt_deg=np.degrees(states["tilt"].astype(np.float64))[kept],
        tilt_direction_rad=states["tilt_direction"].astype(np.float64)[kept],
        is_blasting=((triggers & BLAST) != 0)[kept],
        is_enabled=((triggers & ENABLE) != 0)[kept],
        speed_m_s=_speed(cursor)[kept],
        hand_m=(cursor + force[:, 1:] / person["stiffness_n_m"])[kept],
        force_share=np.minimum(share, 1.0)[kept],
    )


@compiled(None)
def _forces(q: np.ndarray, counts: np.ndarray, force: np.ndarray) -> None:
    """Write the hand's force on the handle [N], base frame, shape (n, 3)."""
    T, measured, wrench = np.empty((4, 4)), np.empty(6), np.empty(6)
    for k in range(q.shape[0]):
        handle_pose(q[k], T)
        counted(counts[k], measured)
        handle_wrench(T, measured, wrench)
        for i in range(3):
            force[k, i] = wrench[i]


def _speed(cursor: np.ndarray) -> np.ndarray:
    n = len(cursor)
    late = np.minimum(np.arange(n) + _SPEED_SPAN, n - 1)
    early = np.maximum(np.arange(n) - _SPEED_SPAN, 0)
    moved = np.hypot(*(cursor[late] - cursor[early]).T)
    return moved * FRAME_HZ / np.maximum(late - early, 1)
