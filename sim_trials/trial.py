"""One simulated lap of the maze under one mode, and the same lap once more from its recording."""

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
from sim_trials.loop import COMPLETED, DIVERGED, STOPPED, STUCK, TICK, TIMED_OUT, lap_loop
from sim_trials.maze import wall_of
from sim_trials.metrics import metrics, phases
from sim_trials.model import Robot, new_robot, physics_step
from sim_trials.modes.registry import resolve
from sim_trials.operators import Mind, Operator, hand_noise
from sim_trials.record import record_of
from sim_trials.recording import Facts, Recording, ReplayError, check_same_study, kept_states
from sim_trials.start import start_angles
from sim_trials.trace import Trace

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
        ``completed``, ``stuck``, ``abandoned`` (took too long) or ``failed`` (protective stop).
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
    mode = mode_of(study, mode_name)
    resolved = resolve(mode)
    facts = Facts(
        study=study.name,
        study_sha256=study.sha256,
        mode=mode.name,
        method=mode.method,
        parameters=dict(zip(resolved.method.parameter_names, resolved.values, strict=True)),
        operator=asdict(operator),
        seed=seed,
        lap=lap,
        start_rad=start_angles(study.maze),
        ending=trace.ending,
        versions=_versions(),
    )
    return _result(study, trace, facts)


def simulate(study: Study, mode_name: str, operator: Operator, *, seed: int, lap: int = 1) -> Trace:
    """The full-rate time series of the lap that `run_trial` would report on; same arguments."""
    noise = hand_noise(seed, lap, _LONGEST_LAP, CONTROL_PERIOD_S)
    counts = np.empty((_LONGEST_LAP, 6), np.int16)
    triggers = np.empty(_LONGEST_LAP, np.uint8)
    start = start_angles(study.maze)
    return _run(
        study, mode_of(study, mode_name), operator, lap, start, noise, counts, triggers, replaying=False
    )


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
    operator = Operator(**facts.operator)  # type: ignore[arg-type]
    trace = _run(
        study,
        mode,
        operator,
        facts.lap,
        facts.start_rad,
        np.empty((0, 6)),
        recording.counts.copy(),
        recording.triggers.copy(),
        replaying=True,
    )
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


def _run(
    study: Study,
    mode: Mode,
    operator: Operator,
    lap: int,
    start: tuple[float, ...],
    noise: np.ndarray,
    counts: np.ndarray,
    triggers: np.ndarray,
    *,
    replaying: bool,
) -> Trace:
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
        record_of(operator),
        record_of(Mind()),
        operator.anticipated_tilt_rad(lap),
        round(operator.visual_delay_s / CONTROL_PERIOD_S),
        noise,
        study.stuck.sigma_below,
        dwell_ticks(study.stuck.dwell_s),
        replaying,
        counts,
        triggers,
        ticks,
    )
    return Trace(ticks[:n].copy(), counts[:n].copy(), triggers[:n].copy(), ending)


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
