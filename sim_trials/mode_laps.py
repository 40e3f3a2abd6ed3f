"""What becomes of laps under a mode: in a batch with simulated operators, and live under a scripted hand."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba.core import types

from data.records import Outcome
from data.study import Study
from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.batch import map_jobs
from sim_trials.compiled import MATRIX, VECTOR, compiled
from sim_trials.kinematics import JOINT_SPEED_LIMITS_RAD_S, handle_jacobian
from sim_trials.live import LiveTrial
from sim_trials.loop import STOPPED, STUCK, TIMED_OUT
from sim_trials.metrics import metrics
from sim_trials.modes.method import MEMORY_LENGTH, MODE_TYPE, ModeFunction
from sim_trials.modes.registry import resolve
from sim_trials.operators import draw_operator
from sim_trials.scripted_hand import ScriptedHand
from sim_trials.singular_value import smallest_singular_value
from sim_trials.standstill import caution
from sim_trials.trace import Trace
from sim_trials.trial import OUTCOMES, mode_of, simulate

_LIMITS = np.array(JOINT_SPEED_LIMITS_RAD_S)


@dataclass(frozen=True)
class LapOfMode:
    """What one simulated lap says of its mode.

    Attributes
    ----------
    peak_joint_speed : float
        Of the fastest joint, as a share of its speed limit; the robot stops itself at 0.98.
    chatter_hz : float
        See `chatter_hz`.
    force_edge_n, gain_exit : float
        Metrics of the lap; NaN if it did not get there.
    last_sigma : float
        Smallest singular value when the lap ended.
    """

    ending: int
    duration_s: float
    peak_joint_speed: float
    chatter_hz: float
    force_edge_n: float
    gain_exit: float
    last_sigma: float

    @property
    def outcome(self) -> Outcome:
        """What the records call it."""
        return OUTCOMES[self.ending]


@dataclass(frozen=True)
class ModeLaps:
    """A mode on the maze: laps of simulated operators, and one live lap of the scripted hand.

    Attributes
    ----------
    caution : str
        See `standstill.caution`.
    """

    name: str
    laps: tuple[LapOfMode, ...]
    live_outcome: Outcome
    live_duration_s: float
    caution: str = ""

    def share(self, outcome: Outcome) -> float:
        """Share of the laps with an outcome."""
        return float(np.mean([lap.outcome == outcome for lap in self.laps]))

    def mean(self, quantity: str) -> float:
        """Mean of a quantity of `LapOfMode` over the laps that have it; NaN if none has."""
        values = np.array([getattr(lap, quantity) for lap in self.laps])
        values = values[np.isfinite(values)]
        return float(values.mean()) if values.size else float("nan")

    @property
    def peak_joint_speed(self) -> float:
        """The highest of the laps."""
        return max(lap.peak_joint_speed for lap in self.laps)

    @property
    def can_be_done(self) -> bool:
        """Whether every lap was finished, the live one too."""
        return self.live_outcome == "completed" and all(lap.outcome == "completed" for lap in self.laps)

    @property
    def verdict(self) -> str:
        """Whether laps can be done under the mode, and if not, what stands against it."""
        if self.can_be_done:
            return "laps are done"
        reasons = [self.caution] if self.caution else []
        missing = [lap for lap in self.laps if lap.outcome != "completed"]
        for ending, n in Counter(lap.ending for lap in missing).most_common():
            sigma = float(np.median([lap.last_sigma for lap in missing if lap.ending == ending]))
            why = _REASONS.get(ending, OUTCOMES[ending])
            reasons.append(f"{n} of {len(self.laps)} laps {why} (sigma {sigma:.3f})")
        if self.live_outcome != "completed":
            reasons.append(_LIVE[self.live_outcome])
        return "; ".join(reasons)


_REASONS = {
    STUCK: "get stuck in elbow-lock",
    STOPPED: "end in a protective stop: a joint too fast",
    TIMED_OUT: "get no further and are given up",
}
_LIVE: dict[Outcome, str] = {
    "stuck": "the live lap gets stuck",
    "failed": "the live lap ends in a protective stop",
    "abandoned": "the live lap gets no further and is given up",
}


def mode_laps(study: Study, name: str, operators: Sequence[int] = range(6), n_jobs: int = 1) -> ModeLaps:
    """Run first laps of simulated operators, and a live one, under one of the study's modes.

    Parameters
    ----------
    study : Study
    name : str
        The mode's name in the study.
    operators : sequence of int
        Seeds; each is an operator and its hand's unsteadiness.
    n_jobs : int
        How many processes.

    Raises
    ------
    InputError
        If the study has no such mode, or the mode or the maze can't be had.
    """
    mode = resolve(mode_of(study, name))
    laps = tuple(map_jobs(_lap, [(study, name, seed) for seed in operators], n_jobs))
    trial, hand = LiveTrial(study, name), ScriptedHand(study)
    while trial.ending is None:
        trial.advance(hand.aim(trial.view, CONTROL_PERIOD_S))
    return ModeLaps(name, laps, OUTCOMES[trial.ending], trial.time_s, caution(mode, study.maze))


def chatter_hz(trace: Trace, study: Study, name: str) -> float:
    """How often a second the mode's command jumps to and fro faster than the robot can follow.

    Counted are ticks in which some joint's command jumps by more than the acceleration limit allows in a
    tick, one way, and in the next tick as much the other way.
    """
    commands = mode_commands(trace, study, name)
    steps = np.diff(commands, axis=0)
    allowed = study.controller.joint_acceleration_rad_s2 * CONTROL_PERIOD_S
    jumps = np.where(np.abs(steps) > allowed, np.sign(steps), 0.0)
    return float((jumps[1:] * jumps[:-1] < 0.0).any(axis=1).sum() / trace.duration_s)


def mode_commands(trace: Trace, study: Study, name: str) -> np.ndarray:
    """What the mode asked of the joints in each tick of a lap [rad/s], before any limit; shape (n, 6)."""
    mode = resolve(mode_of(study, name))
    commands = np.empty((trace.ticks.size, 6))
    q, twist = (np.ascontiguousarray(trace.ticks[column]) for column in ("q", "twist"))
    _commands(mode.function, mode.packed(), q, twist, commands)
    return commands


@compiled(types.void(MODE_TYPE, VECTOR, MATRIX, MATRIX, MATRIX))
def _commands(
    mode: ModeFunction, parameters: np.ndarray, q: np.ndarray, twist: np.ndarray, commands: np.ndarray
) -> None:
    J, memory = np.empty((6, 6)), np.zeros(MEMORY_LENGTH)
    for k in range(q.shape[0]):
        handle_jacobian(q[k], J)
        sigma = smallest_singular_value(J)
        mode(q[k], J, sigma, twist[k], CONTROL_PERIOD_S, parameters, memory, commands[k])


def _lap(job: tuple[Study, str, int]) -> LapOfMode:
    study, name, seed = job
    trace = simulate(study, name, draw_operator(seed), seed=seed)
    values = metrics(trace, study)
    return LapOfMode(
        ending=trace.ending,
        duration_s=trace.duration_s,
        peak_joint_speed=float(np.abs(trace.ticks["qdot"] / _LIMITS).max()),
        chatter_hz=chatter_hz(trace, study, name),
        force_edge_n=values.get("force_mean_edge_n", float("nan")),
        gain_exit=values.get("gain_exit", float("nan")),
        last_sigma=float(trace.ticks["sigma"][-1]),
    )
