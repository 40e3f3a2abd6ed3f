"""How much a browser may send: what our own page never reaches, and what a hostile one cannot pass."""

from collections.abc import Callable

Timer = Callable[[], float]
"""Gives a time that only grows [s], such as ``time.monotonic``."""


class Allowance:
    """So much a second, on average; what was not used is saved up to a limit.

    A connection that stood still for some seconds delivers at once what the page sent meanwhile: savings let
    that pass, while a steady excess is found within a second.

    Parameters
    ----------
    per_s : float
        What comes in each second.
    most : float
        What can be saved.
    first : float, optional
        What is there at the start; by default one second's.
    """

    def __init__(self, per_s: float, most: float, timer: Timer, first: float | None = None) -> None:
        self._per_s = per_s
        self._most = most
        self._timer = timer
        self._left = min(per_s, most) if first is None else first
        self._at = timer()

    def take(self) -> bool:
        """Use one; False if there is none left."""
        now = self._timer()
        self._left = min(self._left + (now - self._at) * self._per_s, self._most)
        self._at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
