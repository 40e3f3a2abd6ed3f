"""A lap in bytes, as the browser reads it (``app/stage/modules/lap.js``).

It says how the robot moved and nothing else: no name, no parameter, no measure of the arm's state beyond
its joint angles. Header of 24 bytes, then rows of 16 little-endian 32-bit floats at a fixed rate.
"""

import struct
from typing import TYPE_CHECKING

import numpy as np

from data.records import Outcome

if TYPE_CHECKING:
    from sim_trials.frames import Frames

COLUMNS = (
    "y_m",
    "z_m",
    "tilt_y_deg",
    "tilt_z_deg",
    "hand_y_m",
    "hand_z_m",
    "pull",
    "speed_m_s",
    "spraying",
    "moving",
    "q1_rad",
    "q2_rad",
    "q3_rad",
    "q4_rad",
    "q5_rad",
    "q6_rad",
)
"""Cursor on the wall, tilt of the nozzle along the wall's axes, the hand, its pull as a share of the most it
pulls, speed of the cursor, triggers, joint angles. Base frame: y to the left, z up."""

_HEADER = struct.Struct("<4sHHIffB3x")
_OUTCOMES: dict[Outcome, int] = {"completed": 0, "stuck": 1, "failed": 2, "abandoned": 2}
"""To the one who watches, a protective stop and an operator who gives up look the same: the robot stops."""


def pack_lap(frames: "Frames", hz: float, duration_s: float, outcome: Outcome) -> bytes:
    """The bytes of a lap."""
    lean = np.column_stack([-np.cos(frames.tilt_direction_rad), np.sin(frames.tilt_direction_rad)])
    rows = np.column_stack(
        [
            frames.cursor_m,
            # The direction 0 is to the right, where y falls.
            frames.tilt_deg[:, None] * lean,
            frames.hand_m,
            frames.force_share,
            frames.speed_m_s,
            frames.is_blasting,
            frames.is_enabled,
            frames.q_rad,
        ]
    )
    header = _HEADER.pack(b"ELAP", 1, len(COLUMNS), len(rows), hz, duration_s, _OUTCOMES[outcome])
    return header + rows.astype("<f4").tobytes()
