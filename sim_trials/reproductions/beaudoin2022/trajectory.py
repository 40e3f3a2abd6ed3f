"""The quasi-Cartesian trajectory of a shell, and how the arm follows it.

Beaudoin, Laliberte, Gosselin (2022), section 6.2, eqs. (30)-(33) and fig. 4. The paper does not say how
a shell's displacement becomes a velocity, where on the link the shell sits, how far it can move or how
often the law runs; `Reading` names one choice of these.
"""

from dataclasses import dataclass

import numpy as np

from sim_trials.reproductions.beaudoin2022.robot import (
    ACCELERATION_LIMIT,
    SPEED_LIMIT,
    START,
    link_state,
)
from sim_trials.reproductions.beaudoin2022.shell import SHELLS, Inverse, direct_rates

PERIOD_S = 0.002
TURNING_SHARE = 0.1
"""Where the link or the shell is slower than this share of its own largest speed it is turning back: what
is left of its velocity points anywhere, and the angle is left out. The paper's curves have no such spikes."""


@dataclass(frozen=True)
class Harmonic:
    """d = D sin(2 pi f t), eq. (30) and table III."""

    number: int
    amplitude_m: float
    frequency_hz: float

    @property
    def speed_m_s(self) -> float:
        """Largest speed."""
        return 2.0 * np.pi * self.frequency_hz * self.amplitude_m

    @property
    def acceleration_m_s2(self) -> float:
        """Largest acceleration."""
        return (2.0 * np.pi * self.frequency_hz) ** 2 * self.amplitude_m


HARMONICS = (Harmonic(1, 0.1, 1.0), Harmonic(2, 0.5, 1.0), Harmonic(3, 0.1, 3.0))


@dataclass(frozen=True)
class Reading:
    """One way of filling in what the paper leaves open.

    Attributes
    ----------
    lever_m : float
        From joint axis 2 along link 3 to the shell's neutral position.
    damping_squared : float
        lambda^2; the paper says 0.1.
    follows : {"velocity", "displacement"}
        Whether the shell's measured velocity is the velocity command, or ``gain`` times its displacement.
    gain_per_s : float
        Velocity per displacement; added to the velocity too, so that the shell does not drift away.
    range_m : float
        p_max, the shell's largest displacement on its link.
    has_limits : bool
        Whether the joints' speed and acceleration and the shell's range are limited, as the paper says.
    """

    lever_m: float
    damping_squared: float
    follows: str
    gain_per_s: float
    range_m: float = 0.05
    has_limits: bool = True

    @property
    def words(self) -> str:
        """For the assumption column."""
        law = f"{self.gain_per_s:g}/s times its displacement"
        if self.follows == "velocity":
            law = f"the shell's velocity plus {law}" if self.gain_per_s else "the shell's velocity"
        limits = f"limits on, p_max = {1e3 * self.range_m:.0f} mm" if self.has_limits else "no limits"
        return (
            f"shell {1e3 * self.lever_m:.0f} mm from joint 2, lambda^2 = {self.damping_squared:g}, "
            f"command = {law}, {limits}"
        )


@dataclass(frozen=True)
class Course:
    """A shell's trajectory and the arm's answer, one value per step.

    Attributes
    ----------
    time_s, psi_deg : ndarray, shape (n,)
        psi is the angle between the lines of the shell's motion and the link's velocity, 0 to 90 deg; NaN
        where either turns back.
    q : ndarray, shape (n, 5)
        Joint angles [rad].
    reaches_speed_limit, reaches_acceleration_limit, reaches_shell_limit : bool
        Whether a joint ran at its largest speed or acceleration, and the shell met the end of its range.
    """

    time_s: np.ndarray
    psi_deg: np.ndarray
    q: np.ndarray
    reaches_speed_limit: bool
    reaches_acceleration_limit: bool
    reaches_shell_limit: bool

    @property
    def psi_max_deg(self) -> float:
        """Largest angle."""
        return float(np.nanmax(self.psi_deg))

    @property
    def fall_share(self) -> float:
        """How far psi falls from its peak up to the first change of direction, as a share of the peak."""
        quarter = self.psi_deg[: self.psi_deg.size // 4]
        known = quarter[np.isfinite(quarter)]
        top = int(known.argmax())
        return float(1.0 - known[top:].min() / known[top])


def run(harmonic: Harmonic, inverse: Inverse, reading: Reading, cycles: float = 1.0) -> Course:
    """Move the shell of link 3 in the optimal direction (section 6.3) and let the arm follow."""
    shell = SHELLS[0]
    time = np.arange(0.0, cycles / harmonic.frequency_hz + PERIOD_S / 2, PERIOD_S)
    steps = np.diff(harmonic.amplitude_m * np.sin(2.0 * np.pi * harmonic.frequency_hz * time))
    q, rates = START.copy(), np.zeros(5)
    state = link_state(q, shell.link, reading.lever_m)
    # The shell's direction of motion in the link's frame: across joint axis 2.
    u = np.array([0.0, 1.0])
    offset = np.zeros(2)
    angles, courses = np.full(time.size, np.nan), np.empty((time.size, 5))
    speeds = np.zeros(time.size)
    courses[0] = q
    at_speed_limit = at_acceleration_limit = at_shell_limit = False
    for k, d in enumerate(steps, start=1):
        offset = offset + d * u
        size = np.linalg.norm(offset)
        if reading.has_limits and size > reading.range_m:
            offset, at_shell_limit = offset * (reading.range_m / size), True
        command = reading.gain_per_s * offset
        if reading.follows == "velocity":
            command = command + d * u / PERIOD_S
        wanted = direct_rates(shell, state.jacobian, np.array([0.0, *command]), inverse)
        before = rates
        rates = _limited(wanted, before) if reading.has_limits else wanted
        at_acceleration_limit |= bool((np.abs(wanted - before) > ACCELERATION_LIMIT * PERIOD_S).any())
        at_speed_limit |= bool((np.abs(rates) >= SPEED_LIMIT * (1 - 1e-9)).any())
        velocity = state.jacobian[3:] @ rates
        speeds[k] = np.linalg.norm(velocity)
        if speeds[k] > 0.0:
            angles[k] = np.degrees(np.arccos(min(1.0, abs(velocity[:2] @ u) / speeds[k])))
        place = state.point + state.rotation[:, :2] @ offset
        q = q + rates * PERIOD_S
        state = link_state(q, shell.link, reading.lever_m)
        # Projected onto the plane across the link, as the shell's mechanism holds it (eq. (33)).
        offset = state.rotation[:, :2].T @ (place - state.point)
        courses[k] = q
    shell_speeds = np.abs(np.concatenate([[0.0], steps]))
    turning = (speeds < TURNING_SHARE * speeds.max()) | (shell_speeds < TURNING_SHARE * shell_speeds.max())
    angles[turning] = np.nan
    return Course(time, angles, courses, at_speed_limit, at_acceleration_limit, at_shell_limit)


def _limited(wanted: np.ndarray, before: np.ndarray) -> np.ndarray:
    change = ACCELERATION_LIMIT * PERIOD_S
    return np.clip(before + np.clip(wanted - before, -change, change), -SPEED_LIMIT, SPEED_LIMIT)
