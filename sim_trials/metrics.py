"""Objective metrics of a lap: pure functions over its trace, units in the names.

Each is given for the whole lap and for the phases approach, edge and exit (``force_mean_n``,
``force_mean_edge_n``, ...; see ``maze`` for the phases). A metric that is not defined is left out: of a
phase that the lap did not reach, say. What each means stands in ``data.metric_meanings``.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from data.metric_meanings import LAP_METRICS, LAP_PHASES, LONGEST_LOCK
from data.study import Study
from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.compiled import compiled
from sim_trials.events import ticks_below
from sim_trials.maze import PHASES, Wall, paint_opacities, phase, wall_of
from sim_trials.record import record_of
from sim_trials.trace import Trace

SPEED_WINDOW_TICKS = 5
"""Cursor speeds are central differences over this many ticks to either side (80 ms altogether)."""
JERK_FILTER_HZ = 5.0
"""Before differentiating, positions pass a second-order Butterworth filter forwards and backwards (no phase
shift) with this cut-off: raw jerk would be tremor."""
NEAR_SINGULARITY = 0.05
"""sigma_min below which the arm counts as near the singularity: about 12 deg from straight."""
SOLID_FROM = 0.9
"""Opacity from which on the painted path looks solid."""


@dataclass(frozen=True)
class Lap:
    """What the metrics need of a lap, one value per control tick.

    Attributes
    ----------
    is_held : ndarray of bool, shape (n,)
        Whether the enable trigger is held, and with it the handle.
    jerk_m_s3 : ndarray, shape (n,)
        Magnitude of the handle's low-passed jerk; NaN for laps under 0.4 s.
    moved_m : ndarray, shape (n,)
        How far the cursor moves up to the next tick.
    commanded, achieved : ndarray, shape (n, 3)
        Velocity of the handle as commanded to the mode and as it turned out [m/s].
    """

    force_n: np.ndarray
    speed_m_s: np.ndarray
    jerk_m_s3: np.ndarray
    tilt_deg: np.ndarray
    sigma: np.ndarray
    opacity: np.ndarray
    is_held: np.ndarray
    is_blasting: np.ndarray
    moved_m: np.ndarray
    commanded: np.ndarray
    achieved: np.ndarray


Value = Callable[[Lap, np.ndarray], float]


@dataclass(frozen=True)
class Metric:
    """How a metric is computed: ``value`` over some ticks of a lap.

    ``while_held``: the ticks in which nobody holds the handle don't count, so that a pause is no sign of
    little force or low speed.
    """

    value: Value
    while_held: bool = False


def _solid_share(lap: Lap, at: np.ndarray) -> float:
    painted = lap.moved_m[at] * lap.is_blasting[at]
    total = painted.sum()
    return float(painted[lap.opacity[at] > SOLID_FROM].sum() / total) if total > 0 else float("nan")


def _gain(lap: Lap, at: np.ndarray) -> float:
    commanded = lap.commanded[at]
    total = (commanded**2).sum()
    return float((commanded * lap.achieved[at]).sum() / total) if total > 0 else float("nan")


_COMPUTED: Mapping[str, Metric] = {
    "duration": Metric(lambda lap, at: float(at.sum() * CONTROL_PERIOD_S)),
    "force_mean": Metric(lambda lap, at: float(lap.force_n[at].mean()), while_held=True),
    "force_peak": Metric(lambda lap, at: float(lap.force_n[at].max())),
    "speed_mean": Metric(lambda lap, at: float(lap.speed_m_s[at].mean()), while_held=True),
    "jerk_rms": Metric(lambda lap, at: float(np.sqrt((lap.jerk_m_s3[at] ** 2).mean())), while_held=True),
    "tilt_mean": Metric(lambda lap, at: float(lap.tilt_deg[at].mean()), while_held=True),
    "tilt_peak": Metric(lambda lap, at: float(lap.tilt_deg[at].max())),
    "sigma_min": Metric(lambda lap, at: float(lap.sigma[at].min())),
    "near_singularity": Metric(
        lambda lap, at: float((lap.sigma[at] < NEAR_SINGULARITY).sum() * CONTROL_PERIOD_S)
    ),
    "solid_share": Metric(_solid_share),
    "gain": Metric(_gain),
}
"""By the stems of `LAP_METRICS`, which say what each means."""


def metric_names() -> tuple[str, ...]:
    """Every name that `metrics` can give."""
    return (*(m.name(p) for p in ("", *LAP_PHASES) for m in LAP_METRICS), LONGEST_LOCK)


def metrics(trace: Trace, study: Study) -> dict[str, float]:
    """The metrics of a lap by name; those that are not defined are left out."""
    lap = _lap(trace, study)
    code = phases(trace, study)
    everywhere = np.ones(code.size, bool)
    values = {}
    for number, name in enumerate(PHASES):
        at = code == number if number else everywhere
        for described in LAP_METRICS:
            metric = _COMPUTED[described.stem]
            counted = at & lap.is_held if metric.while_held else at
            if counted.any():
                values[described.name(name if number else "")] = metric.value(lap, counted)
    values[LONGEST_LOCK] = float(ticks_below(lap.sigma, study.stuck.sigma_below).max() * CONTROL_PERIOD_S)
    return {name: value for name, value in values.items() if np.isfinite(value)}


def phases(trace: Trace, study: Study) -> np.ndarray:
    """Code of the phase (index into ``maze.PHASES``) of each tick, shape (n,)."""
    codes = np.empty(trace.ticks.size, np.uint8)
    place = np.ascontiguousarray(trace.ticks["place"])
    _phases(record_of(wall_of(study.maze, study.feedback)), place, codes)
    return codes


def cursor_speed(y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Speed of the cursor on the wall [m/s] from its full-rate coordinates [m], shape (n,)."""
    n = y.size
    late = np.minimum(np.arange(n) + SPEED_WINDOW_TICKS, n - 1)
    early = np.maximum(np.arange(n) - SPEED_WINDOW_TICKS, 0)
    time = np.maximum(late - early, 1) * CONTROL_PERIOD_S
    return np.hypot(y[late] - y[early], z[late] - z[early]) / time


def low_passed_jerk(position: np.ndarray) -> np.ndarray:
    """Magnitude of the third derivative [m/s^3] of a position [m], shape (n, 3) -> (n,).

    See `JERK_FILTER_HZ`; NaN throughout if the series is shorter than 0.4 s.
    """
    from scipy.signal import butter, sosfiltfilt

    if position.shape[0] < 50:
        return np.full(position.shape[0], np.nan)
    sections = butter(2, JERK_FILTER_HZ, fs=1.0 / CONTROL_PERIOD_S, output="sos")
    smooth = sosfiltfilt(sections, position, axis=0)
    for _ in range(3):
        smooth = np.gradient(smooth, CONTROL_PERIOD_S, axis=0)
    return np.sqrt((smooth**2).sum(axis=1))


@compiled(None)
def _phases(wall: Wall, place: np.ndarray, codes: np.ndarray) -> None:
    for k in range(place.size):
        codes[k] = phase(wall, place[k])


def _lap(trace: Trace, study: Study) -> Lap:
    ticks = trace.ticks
    y, z = ticks["cursor_y"], ticks["cursor_z"]
    speed = cursor_speed(y, z)
    step = np.diff(ticks["handle"], axis=0, append=ticks["handle"][-1:])
    return Lap(
        force_n=trace.force_n,
        speed_m_s=speed,
        jerk_m_s3=low_passed_jerk(ticks["handle"]),
        tilt_deg=np.degrees(ticks["tilt"]),
        sigma=ticks["sigma"],
        opacity=paint_opacities(study.maze, study.feedback, speed),
        is_held=trace.is_enabled,
        is_blasting=trace.is_blasting,
        moved_m=np.hypot(np.diff(y, append=y[-1:]), np.diff(z, append=z[-1:])),
        commanded=ticks["twist"][:, :3],
        achieved=step / CONTROL_PERIOD_S,
    )
