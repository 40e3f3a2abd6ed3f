"""The full-rate time series of a lap: what events and metrics are computed from."""

from dataclasses import dataclass

import numpy as np

from sim_trials.admittance import CONTROL_PERIOD_S
from sim_trials.loop import BLAST, ENABLE, FORCE_COUNT_N


@dataclass(frozen=True, eq=False)
class LapInputs:
    """All that a hand did in a lap, and how the lap ended: the rest follows from running it again.

    Attributes
    ----------
    counts : ndarray of int16, shape (n, 6)
        What the force-torque sensor counted in each tick: force, moment; tool frame.
    triggers : ndarray of uint8, shape (n,)
        Bits ``loop.ENABLE`` and ``loop.BLAST``.
    ending : int
        ``loop.COMPLETED`` ...
    """

    counts: np.ndarray
    triggers: np.ndarray
    ending: int


@dataclass(frozen=True)
class Trace:
    """One lap, control tick by control tick.

    Attributes
    ----------
    ticks : ndarray of ``loop.TICK``, shape (n,)
        The state at the beginning of each tick; ``ticks["sigma"]`` and so on.
    counts : ndarray of int16, shape (n, 6)
        What the force-torque sensor counted in each tick: force, moment; tool frame.
    triggers : ndarray of uint8, shape (n,)
        Bits ``loop.ENABLE`` and ``loop.BLAST``.
    ending : int
        How the lap ended: ``loop.COMPLETED`` ...
    """

    ticks: np.ndarray
    counts: np.ndarray
    triggers: np.ndarray
    ending: int

    @property
    def duration_s(self) -> float:
        """Time of all ticks together [s]."""
        return self.ticks.size * CONTROL_PERIOD_S

    @property
    def time_s(self) -> np.ndarray:
        """Time of each tick since the start [s], shape (n,)."""
        return np.arange(self.ticks.size) * CONTROL_PERIOD_S

    @property
    def force_n(self) -> np.ndarray:
        """Magnitude of the hand's force [N], shape (n,)."""
        counts = self.counts[:, :3].astype(np.float64)
        return FORCE_COUNT_N * np.sqrt(np.einsum("ki,ki->k", counts, counts))

    @property
    def is_enabled(self) -> np.ndarray:
        """Whether the enable trigger is held, shape (n,)."""
        return (self.triggers & ENABLE) != 0

    @property
    def is_blasting(self) -> np.ndarray:
        """Whether the blasting trigger is pressed, shape (n,)."""
        return (self.triggers & BLAST) != 0
