"""Objective metrics of a lap: pure functions over its trace, units in the names.

Each is given for the whole lap and for the phases approach, edge and exit (``force_mean_n``,
``force_mean_edge_n``, ...; see ``maze`` for the phases). A metric that is not defined is left out: of a
phase that the lap did not reach, say.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

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
    """One metric: its stem and unit make the name, ``value`` computes it over some ticks of a lap.

    ``while_held``: the ticks in which nobody holds the handle don't count, so that a pause is no sign of
    little force or low speed.
    """

    stem: str
    unit: str
    meaning: str
    value: Value
    while_held: bool = False

    def name(self, phase_name: str = "") -> str:
        """E.g. ``force_mean_n``, or ``force_mean_edge_n`` for a phase."""
        return "_".join(part for part in (self.stem, phase_name, self.unit) if part)


def _solid_share(lap: Lap, at: np.ndarray) -> float:
    painted = lap.moved_m[at] * lap.is_blasting[at]
    total = painted.sum()
    return float(painted[lap.opacity[at] > SOLID_FROM].sum() / total) if total > 0 else float("nan")


def _gain(lap: Lap, at: np.ndarray) -> float:
    commanded = lap.commanded[at]
    total = (commanded**2).sum()
    return float((commanded * lap.achieved[at]).sum() / total) if total > 0 else float("nan")


METRICS: tuple[Metric, ...] = (
    Metric("duration", "s", "time taken", lambda lap, at: float(at.sum() * CONTROL_PERIOD_S)),
    Metric(
        "force_mean",
        "n",
        "mean force of the hand while it holds the handle",
        lambda lap, at: float(lap.force_n[at].mean()),
        while_held=True,
    ),
    Metric("force_peak", "n", "largest force of the hand", lambda lap, at: float(lap.force_n[at].max())),
    Metric(
        "speed_mean",
        "m_s",
        "mean speed of the cursor while the handle is held",
        lambda lap, at: float(lap.speed_m_s[at].mean()),
        while_held=True,
    ),
    Metric(
        "jerk_rms",
        "m_s3",
        "root mean square of the handle's jerk while it is held, low-passed at 5 Hz",
        lambda lap, at: float(np.sqrt((lap.jerk_m_s3[at] ** 2).mean())),
        while_held=True,
    ),
    Metric(
        "tilt_mean",
        "deg",
        "mean tilt of the nozzle while the handle is held",
        lambda lap, at: float(lap.tilt_deg[at].mean()),
        while_held=True,
    ),
    Metric("tilt_peak", "deg", "largest tilt of the nozzle", lambda lap, at: float(lap.tilt_deg[at].max())),
    Metric(
        "sigma_min", "", "smallest singular value met, SI units", lambda lap, at: float(lap.sigma[at].min())
    ),
    Metric(
        "near_singularity",
        "s",
        "time with the smallest singular value below 0.05",
        lambda lap, at: float((lap.sigma[at] < NEAR_SINGULARITY).sum() * CONTROL_PERIOD_S),
    ),
    Metric("solid_share", "", "share of the painted path with an opacity above 0.9", _solid_share),
    Metric(
        "gain",
        "",
        "responsiveness: the handle's velocity along the command, over the command (least squares)",
        _gain,
    ),
)
"""All metrics that are split by phase, in the order of the codebook."""

LONGEST_LOCK = "longest_lock_s"
"""Longest time on end with sigma_min below the study's ``sigma_below`` [s]; for the whole lap alone."""


def metric_names() -> tuple[str, ...]:
    """Every name that `metrics` can give."""
    split = tuple(metric.name(p) for p in ("", *PHASES[1:]) for metric in METRICS)
    return (*split, LONGEST_LOCK)


def metric_meanings() -> dict[str, str]:
    """What each metric means, by name, for codebooks."""
    meanings = {}
    for metric in METRICS:
        meanings[metric.name()] = metric.meaning
        for name in PHASES[1:]:
            meanings[metric.name(name)] = f"{metric.meaning}; phase {name}"
    meanings[LONGEST_LOCK] = (
        "longest time on end with the smallest singular value below the study's threshold"
    )
    return meanings


def metrics(trace: Trace, study: Study) -> dict[str, float]:
    """The metrics of a lap by name; those that are not defined are left out."""
    lap = _lap(trace, study)
    code = phases(trace, study)
    everywhere = np.ones(code.size, bool)
    values = {}
    for number, name in enumerate(PHASES):
        at = code == number if number else everywhere
        for metric in METRICS:
            counted = at & lap.is_held if metric.while_held else at
            if counted.any():
                values[metric.name(name if number else "")] = metric.value(lap, counted)
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
