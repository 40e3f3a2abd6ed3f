"""One lap of the maze under one mode: simulated, guided by a person, or once more from its recording."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from importlib import metadata

import numpy as np

from data.errors import one_of
from data.records import Outcome, StuckEvent
from data.study import Mode, Study
from sim_trials.admittance import CONTROL_PERIOD_S, initial_state, pack_controller
from sim_trials.events import dwell_ticks, events
from sim_trials.guidance import HAND, Hand
from sim_trials.loop import COMPLETED, DIVERGED, STOPPED, STUCK, TICK, TIMED_OUT, lap_loop
from sim_trials.maze import wall_of
from sim_trials.metrics import metrics, phases
from sim_trials.model import Robot, new_robot, physics_step
from sim_trials.modes.registry import resolve
from sim_trials.operators import Mind, Operator, draw_operator, hand_noise
from sim_trials.record import record_of
from sim_trials.recording import Facts, Recording, ReplayError, check_same_study, kept_states
from sim_trials.start import start_angles
from sim_trials.trace import LapInputs, Trace

LONGEST_LAP_S = 120.0
"""After this time a simulated operator gives up [s]; an ordinary lap takes 30-60 s."""

OUTCOMES: dict[int, Outcome] = {
    COMPLETED: "completed",
    STUCK: "stuck",
    STOPPED: "failed",
    TIMED_OUT: "abandoned",
    DIVERGED: "failed",
}
"""What the endings of the loop are called in the records."""

_LONGEST_LAP = round(LONGEST_LAP_S / CONTROL_PERIOD_S)
_ARITHMETIC = ("elbowroom", "mujoco", "numba", "numpy")


@dataclass(frozen=True)
class TrialResult:
    """What came of one lap.

    Attributes
    ----------
    outcome : Outcome
        ``completed``, ``stuck``, ``abandoned`` (given up, or took too long) or ``failed`` (protective stop).
    duration_s : float
    metrics : mapping
        Objective metrics by name, units in the names (``sim_trials.metrics``).
    events : tuple of StuckEvent
        In order of time (``sim_trials.events``).
    recording : Recording
    """

    outcome: Outcome
    duration_s: float
    metrics: Mapping[str, float]
    events: tuple[StuckEvent, ...]
    recording: Recording


def run_trial(study: Study, mode_name: str, operator: Operator, *, seed: int, lap: int = 1) -> TrialResult:
    """Let a simulated operator do one lap.

    Parameters
    ----------
    study : Study
    mode_name : str
        Name of one of the study's modes.
    operator : Operator
    seed : int
        Of the hand's unsteadiness: the same seed gives the same hand under every mode.
    lap : int
        Which lap under this condition it is, from 1: operators learn.

    Raises
    ------
    InputError
        If the study has no such mode, or the mode or the maze can't be had.
    """
    trace = simulate(study, mode_name, operator, seed=seed, lap=lap)
    return _result(study, trace, _facts(study, mode_name, trace.ending, seed, lap, operator=operator))


def finish(study: Study, mode_name: str, inputs: LapInputs, *, lap: int, seed: int = 0) -> TrialResult:
    """What came of a lap that a person guided, from what the hand did.

    Parameters
    ----------
    study : Study
    mode_name : str
        Name of one of the study's modes.
    inputs : LapInputs
        From ``live.LiveTrial.inputs``.
    lap : int
        Which lap under this condition it is, from 1.
    seed : int
        Kept with the recording; nothing in a person's lap depends on it.

    Raises
    ------
    InputError
        If the study has no such mode, or the mode or the maze can't be had.
    ReplayError
        If the lap does not end as it did when it was guided.
    """
    mode, start = mode_of(study, mode_name), start_angles(study.maze)
    trace = _run(study, mode, start, inputs.counts.copy(), inputs.triggers.copy())
    if trace.ending != inputs.ending or trace.ticks.size != inputs.triggers.size:
        raise ReplayError(
            f"the lap ends as {OUTCOMES[trace.ending]} after {trace.duration_s:.3f} s when it is run again;"
            f" guided, it was {OUTCOMES[inputs.ending]} after {inputs.triggers.size * CONTROL_PERIOD_S:.3f} s"
        )
    return _result(study, trace, _facts(study, mode_name, trace.ending, seed, lap, hand=HAND))


def simulate(study: Study, mode_name: str, operator: Operator, *, seed: int, lap: int = 1) -> Trace:
    """The full-rate time series of the lap that `run_trial` would report on; same arguments."""
    counts = np.empty((_LONGEST_LAP, 6), np.int16)
    triggers = np.empty(_LONGEST_LAP, np.uint8)
    hand = _SimulatedHand(operator, lap, hand_noise(seed, lap, _LONGEST_LAP, CONTROL_PERIOD_S))
    return _run(study, mode_of(study, mode_name), start_angles(study.maze), counts, triggers, hand)


def replay(recording: Recording, study: Study) -> TrialResult:
    """Run a recorded lap again from its inputs alone; the result is the same to the last bit.

    Raises
    ------
    InputError
        If the recording was made for another study.
    ReplayError
        If the states don't come out as recorded (another MuJoCo or numba, say).
    """
    return _result(study, replay_trace(recording, study), recording.facts)


def replay_trace(recording: Recording, study: Study) -> Trace:
    """The full-rate states of a recorded lap, from its inputs alone; raises as `replay` does."""
    facts = recording.facts
    check_same_study(facts, study.sha256)
    mode = Mode(name=facts.mode, method=facts.method, parameters=facts.parameters)
    trace = _run(study, mode, facts.start_rad, recording.counts.copy(), recording.triggers.copy())
    if trace.ending != facts.ending or kept_states(trace.ticks).tobytes() != recording.states.tobytes():
        then, now = facts.versions, _versions()
        changed = ", ".join(
            f"{name} {then.get(name)} -> {now[name]}" for name in now if then.get(name) != now[name]
        )
        raise ReplayError(f"the replay differs from the recording ({changed or 'same versions'})")
    return trace


def mode_of(study: Study, name: str) -> Mode:
    """A study's mode by its name.

    Raises
    ------
    InputError
        If there is none; the line lists the study's modes.
    """
    for mode in study.modes:
        if mode.name == name:
            return mode
    raise one_of("mode", name, study.mode_names)


@lru_cache(maxsize=1)
def _robot() -> Robot:
    """The one robot of this process; every lap puts it back to its start."""
    return new_robot(np.zeros(6))


@dataclass(frozen=True)
class _SimulatedHand:
    """A simulated operator in a certain lap, with its unsteadiness (``operators.hand_noise``)."""

    operator: Operator
    lap: int
    noise: np.ndarray


_NO_HAND = _SimulatedHand(draw_operator(0), 1, np.empty((0, 6)))
"""What stands in for an operator where the loop reads counts and triggers and asks nobody."""


def _run(
    study: Study,
    mode: Mode,
    start: tuple[float, ...],
    counts: np.ndarray,
    triggers: np.ndarray,
    hand: _SimulatedHand = _NO_HAND,
) -> Trace:
    """Run a lap with a simulated hand, or without one from the given counts and triggers."""
    resolved = resolve(mode)
    robot, q = _robot(), np.array(start)
    robot.place(q)
    ticks = np.empty(triggers.size, TICK)
    n, ending = lap_loop()(
        physics_step(),
        robot.model_address,
        robot.data_address,
        robot.q,
        robot.qdot,
        robot.target,
        robot.hand,
        resolved.function,
        resolved.packed(),
        pack_controller(study.controller),
        initial_state(q),
        record_of(wall_of(study.maze, study.feedback)),
        record_of(hand.operator),
        record_of(Mind()),
        hand.operator.anticipated_tilt_rad(hand.lap),
        round(hand.operator.visual_delay_s / CONTROL_PERIOD_S),
        hand.noise,
        study.stuck.sigma_below,
        dwell_ticks(study.stuck.dwell_s),
        hand is _NO_HAND,
        counts,
        triggers,
        ticks,
    )
    return Trace(ticks[:n].copy(), counts[:n].copy(), triggers[:n].copy(), ending)


def _facts(
    study: Study,
    mode_name: str,
    ending: int,
    seed: int,
    lap: int,
    *,
    operator: Operator | None = None,
    hand: Hand | None = None,
) -> Facts:
    mode = mode_of(study, mode_name)
    resolved = resolve(mode)
    return Facts(
        study=study.name,
        study_sha256=study.sha256,
        mode=mode.name,
        method=mode.method,
        parameters=dict(zip(resolved.method.parameter_names, resolved.values, strict=True)),
        operator=asdict(operator) if operator else None,
        hand=asdict(hand) if hand else None,
        seed=seed,
        lap=lap,
        start_rad=start_angles(study.maze),
        ending=ending,
        versions=_versions(),
    )


def _result(study: Study, trace: Trace, facts: Facts) -> TrialResult:
    return TrialResult(
        outcome=OUTCOMES[trace.ending],
        duration_s=trace.duration_s,
        metrics=metrics(trace, study),
        events=events(trace, phases(trace, study), study.stuck),
        recording=Recording(facts, trace.counts, trace.triggers, kept_states(trace.ticks)),
    )


@lru_cache(maxsize=1)
def _versions() -> dict[str, str]:
    return {name: metadata.version(name) for name in _ARITHMETIC}
