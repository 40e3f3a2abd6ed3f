"""A lap under a person's hand, control tick by control tick.

The same chain, physics and endings as in a simulated lap (``loop``); only the hand is another one
(``guidance``). What the sensor counted and the triggers are all that is kept: ``trial.finish`` makes the
result and the recording of them, the same to the last bit.
"""

from typing import NamedTuple

import numpy as np

from data.errors import ElbowroomError
from data.study import Study
from sim_trials.admittance import CONTROL_PERIOD_S, initial_state, pack_controller
from sim_trials.events import dwell_ticks
from sim_trials.first_class import mode_address
from sim_trials.guidance import HAND, Grip
from sim_trials.live_tick import LIVE, REST_TICKS, live_tick
from sim_trials.loop import BLAST, ENABLE, GOES_ON, TIMED_OUT
from sim_trials.maze import wall_of
from sim_trials.model import new_robot, physics_step
from sim_trials.modes.registry import resolve
from sim_trials.record import record_of
from sim_trials.start import start_angles
from sim_trials.trace import LapInputs
from sim_trials.trial import mode_of

__all__ = ["LONGEST_LIVE_LAP_S", "HandInput", "LapInputs", "LiveTrial", "LiveView", "warm_up"]

LONGEST_LIVE_LAP_S = 180.0
"""After this time a lap is over, wherever the cursor is [s]; an ordinary lap takes 30-60 s."""

_LONGEST_LAP = round(LONGEST_LIVE_LAP_S / CONTROL_PERIOD_S)


class HandInput(NamedTuple):
    """What a person's hand does: plain finite numbers, which the caller has checked.

    Attributes
    ----------
    y_m, z_m : float
        Where on the wall the cursor is wanted, base frame (y to the left) [m].
    tilt_y_deg, tilt_z_deg : float
        Wanted lean of the nozzle: the angle, as components along base y and z [deg].
    enable : bool
        Whether the hand holds the handle, and with it the enable trigger. The caller lets go for a person of
        whom nothing has been heard for too long.
    blast : bool
        Whether the blasting trigger is pressed; it sprays only while the handle is held.
    """

    y_m: float
    z_m: float
    tilt_y_deg: float = 0.0
    tilt_z_deg: float = 0.0
    enable: bool = False
    blast: bool = False


class LiveView(NamedTuple):
    """What is drawn of a live trial; nothing that would give away the mode or the singularity.

    Attributes
    ----------
    time_s : float
        The trial's clock, which stands still while the robot rests.
    cursor_y_m, cursor_z_m : float
        Cursor on the wall, base frame.
    tilt_y_deg, tilt_z_deg : float
        The nozzle's tilt: the angle, as components along base y and z.
    hand_y_m, hand_z_m : float
        Where the hand wants the cursor; the cursor itself while nobody holds the handle.
    pull : float
        Force along the wall over the most a hand pulls, 0..1.
    speed_m_s : float
        Of the cursor, steady enough for a gauge.
    share : float
        Of the lap, 0..1.
    q_rad : tuple of 6 float
        Joint angles.
    """

    time_s: float
    cursor_y_m: float
    cursor_z_m: float
    tilt_y_deg: float
    tilt_z_deg: float
    hand_y_m: float
    hand_z_m: float
    pull: float
    speed_m_s: float
    share: float
    q_rad: tuple[float, ...]
    is_enabled: bool
    is_spraying: bool
    is_resting: bool


class LiveTrial:
    """One lap under one mode, guided by a person.

    Parameters
    ----------
    study : Study
    mode_name : str
        Name of one of the study's modes.
    lap : int
        Which lap under this condition it is, from 1.

    Attributes
    ----------
    ending : int or None
        How it ended, ``loop.COMPLETED`` ...; None as long as it goes on.
    is_resting : bool
        Nobody holds the robot and it stands still. Its clock stands still, too, until a hand takes hold.

    Raises
    ------
    InputError
        If the study has no such mode, or the mode or the maze can't be had.
    """

    def __init__(self, study: Study, mode_name: str, lap: int = 1) -> None:
        mode, q = resolve(mode_of(study, mode_name)), np.array(start_angles(study.maze))
        self.lap = lap
        self.ending: int | None = None
        self._robot = robot = new_robot(q)
        self._counts = np.zeros((_LONGEST_LAP, 6), np.int16)
        self._triggers = np.zeros(_LONGEST_LAP, np.uint8)
        self._function = mode.function
        live = np.zeros(1, LIVE)
        live["step"] = physics_step().__wrapper_address__()
        live["model"], live["data"] = robot.model_address, robot.data_address
        live["mode"] = mode_address(mode.function)
        live["sigma_below"], live["dwell"] = study.stuck.sigma_below, dwell_ticks(study.stuck.dwell_s)
        live["wall"] = record_of(wall_of(study.maze, study.feedback))
        live["hand"], live["grip"] = record_of(HAND), record_of(Grip())
        live["cursor_y"], live["cursor_z"] = study.maze.left_y_m, study.maze.top_z_m
        live["still"] = REST_TICKS
        self._shown: np.ndarray = live["shown"][0]
        self._run = live_tick()
        self._arguments = (
            live[0],
            robot.q,
            robot.qdot,
            robot.target,
            robot.hand,
            mode.packed(),
            pack_controller(study.controller),
            initial_state(q),
            self._counts,
            self._triggers,
        )
        self._ticks = 0
        self.is_resting = False
        # One tick that nobody touches, so that there is something to draw, and to keep whatever happens.
        self.advance(HandInput(study.maze.left_y_m, study.maze.top_z_m))

    def advance(self, hand: HandInput) -> None:
        """Run one control tick, 8 ms of the trial's time.

        Nothing happens once the trial has ended, nor while it rests and the hand doesn't take hold. Numbers
        that are not finite count as a hand that has let go.
        """
        if self.ending is not None or (self.is_resting and not hand.enable):
            return
        ending, rests = self._run(*self._arguments, self._ticks, *hand)
        self._ticks += 1
        self.is_resting = rests
        if ending != GOES_ON:
            self.ending = ending
        elif self._ticks == _LONGEST_LAP:
            self.ending = TIMED_OUT

    def abandon(self) -> None:
        """End the trial now, unless it has ended."""
        if self.ending is None:
            self.ending = TIMED_OUT

    @property
    def ticks(self) -> int:
        """How many control ticks have been run."""
        return self._ticks

    @property
    def time_s(self) -> float:
        """The trial's clock: the exposure to its condition [s]."""
        return self._ticks * CONTROL_PERIOD_S

    @property
    def view(self) -> LiveView:
        """What there is to draw after the last tick."""
        values = self._shown.tolist()
        trigger = self._triggers[self._ticks - 1]
        triggers = (bool(trigger & ENABLE), bool(trigger & BLAST))
        return LiveView._make((*values[:10], tuple(values[10:]), *triggers, self.is_resting))

    @property
    def inputs(self) -> LapInputs:
        """All that ``trial.finish`` needs; it can be sent to another process.

        Raises
        ------
        ElbowroomError
            If the trial is still under way.
        """
        if self.ending is None:
            raise ElbowroomError("the trial is still under way: it has no ending yet")
        n = self._ticks
        return LapInputs(self._counts[:n].copy(), self._triggers[:n].copy(), self.ending)


def warm_up(study: Study) -> None:
    """Compile or load all that the first tick of a trial would otherwise wait for."""
    for name in study.mode_names:
        trial = LiveTrial(study, name)
        trial.advance(HandInput(study.maze.left_y_m, study.maze.top_z_m, enable=True))
