"""A hand that guides a live trial by itself: for tests, load tests and demonstrations.

It sees what a person at the screen sees (`LiveView`: cursor, tilt, pull) and moves what a person moves
(`HandInput`). It follows the line with its pointer a little ahead of the cursor; what the cursor stays
behind it pulls for, further and further; if the cursor hardly gets on for longer than it is patient, it
leans the nozzle the way it pulls, and after a while of good progress it straightens it. There is no chance
in it. Its numbers are untuned for people; they were chosen so that the hand does what the simulated
operators do on average (``operators``).
"""

import math

from data.study import Study
from sim_trials.live import HandInput, LiveView
from sim_trials.maze import EDGES, corners

LOOK_AHEAD_M = 0.08
"""The pointer runs no further ahead of the cursor along the line [m]."""
REACH_RATE = 0.5
"""How fast the pointer is moved beyond the line's point, per metre that the cursor is off it [1/s]."""
REACH_FADE_S = 4.0
"""Time constant with which that is taken back [s]."""
REACH_LIMIT_M = 0.25
"""The most it is moved beyond [m]."""
START_S = 0.8
"""Time to get up to speed [s]."""
BLAST_S = 0.4
"""From taking hold to pressing the blasting trigger [s]."""
PROGRESS_SENSE_S = 0.4
"""Time constant with which progress is judged [s]."""
POOR_PROGRESS = 0.3
"""Below this share of its pace it thinks it isn't getting on."""
NEAR_LINE_M = 0.06
"""Progress counts only this near the line [m]."""
PATIENCE_S = 2.0
"""Time of poor progress before it leans the nozzle [s]."""
CALM_S = 1.5
"""Time of good progress before it straightens the nozzle [s]."""
LEAN_RATE_DEG_S = 5.0
"""How fast it leans and straightens the nozzle."""
LEAN_LIMIT_DEG = 16.0
"""The most it leans the nozzle."""
SURE_SHARE = 0.8
"""A corner counts as reached within this share of its tolerance, since a screen shows rounded numbers."""


class ScriptedHand:
    """A hand that knows the maze and how fast it wants to go.

    Parameters
    ----------
    study : Study
        Of which it knows the maze alone.
    pace_m_s : float
        How fast it follows the line.
    """

    def __init__(self, study: Study, pace_m_s: float = 0.10) -> None:
        self.pace_m_s = pace_m_s
        self._corners = [(float(y), float(z)) for y, z in corners(study.maze)]
        self._tolerance_m = SURE_SHARE * study.maze.corner_tolerance_m
        self._edge = 0
        self._along_m = 0.0
        self._reach_m = (0.0, 0.0)
        self._lean_deg = (0.0, 0.0)
        self._seen_m = 0.0
        self._rate_m_s = 0.0
        self._poor_s = 0.0
        self._good_s = 0.0
        self._time_s = 0.0

    def aim(self, view: LiveView, dt: float) -> HandInput:
        """What it does next, `dt` seconds after it was last asked, given what it sees."""
        self._time_s += dt
        (from_y, from_z), (to_y, to_z) = self._ends()
        if (
            self._edge < EDGES - 1
            and math.hypot(view.cursor_y_m - to_y, view.cursor_z_m - to_z) <= self._tolerance_m
        ):
            self._edge += 1
            self._along_m = self._seen_m = self._poor_s = 0.0
            (from_y, from_z), (to_y, to_z) = self._ends()
        length = math.hypot(to_y - from_y, to_z - from_z)
        way_y, way_z = (to_y - from_y) / length, (to_z - from_z) / length
        off_y, off_z = view.cursor_y_m - from_y, view.cursor_z_m - from_z
        along, aside = off_y * way_y + off_z * way_z, off_z * way_y - off_y * way_z

        pace = self.pace_m_s * min(1.0, self._time_s / START_S)
        ahead = min(self._along_m + pace * dt, along + LOOK_AHEAD_M, length)
        self._along_m = max(self._along_m, ahead)
        point_y, point_z = from_y + self._along_m * way_y, from_z + self._along_m * way_z
        self._judge(along, aside, dt)
        self._reach(point_y - view.cursor_y_m, point_z - view.cursor_z_m, dt)
        hand_y, hand_z = point_y + self._reach_m[0], point_z + self._reach_m[1]
        self._lean(hand_y - view.cursor_y_m, hand_z - view.cursor_z_m, dt)
        return HandInput(hand_y, hand_z, *self._lean_deg, True, self._time_s > BLAST_S)

    def _ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        return self._corners[self._edge], self._corners[(self._edge + 1) % EDGES]

    def _judge(self, along: float, aside: float, dt: float) -> None:
        """How well it is getting on."""
        step = along - self._seen_m if abs(aside) < NEAR_LINE_M else 0.0
        self._seen_m = along
        self._rate_m_s += dt / PROGRESS_SENSE_S * (step / dt - self._rate_m_s)
        is_poor = self._time_s > 2.0 * START_S and self._rate_m_s < POOR_PROGRESS * self.pace_m_s
        self._poor_s = self._poor_s + dt if is_poor else 0.0
        self._good_s = 0.0 if is_poor else self._good_s + dt

    def _reach(self, missing_y: float, missing_z: float, dt: float) -> None:
        """Move the pointer further beyond the line's point the longer the cursor stays behind."""
        keep = 1.0 - dt / REACH_FADE_S
        y = keep * self._reach_m[0] + REACH_RATE * missing_y * dt
        z = keep * self._reach_m[1] + REACH_RATE * missing_z * dt
        share = min(1.0, REACH_LIMIT_M / max(math.hypot(y, z), 1e-9))
        self._reach_m = (share * y, share * z)

    def _lean(self, pull_y: float, pull_z: float, dt: float) -> None:
        """Lean the nozzle the way the hand pulls, or straighten it."""
        lean_y, lean_z = self._lean_deg
        turn, lean, pull = LEAN_RATE_DEG_S * dt, math.hypot(lean_y, lean_z), math.hypot(pull_y, pull_z)
        if self._poor_s > PATIENCE_S and pull > 0.0:
            lean_y, lean_z = lean_y + turn * pull_y / pull, lean_z + turn * pull_z / pull
            share = min(1.0, LEAN_LIMIT_DEG / max(math.hypot(lean_y, lean_z), 1e-9))
            self._lean_deg = (share * lean_y, share * lean_z)
        elif self._good_s > CALM_S and lean > 0.0:
            share = max(lean - turn, 0.0) / lean
            self._lean_deg = (share * lean_y, share * lean_z)
