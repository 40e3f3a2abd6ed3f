"""A power analysis on request: in a process of its own, one at a time, its result kept until the next one."""

import threading

from analysis.power.experiment import power
from analysis.power.outcome import Power, PowerPoint
from analysis.power.plan import Plan
from app.console.aside import Aside, Teller
from app.planning import Wish, plan_of
from data.study import Study


class PowerRun(Aside):
    """At most one power analysis under way, and what the last one found so far.

    Attributes
    ----------
    wish : Wish or None
        What the last one was asked.
    """

    killed = "the process that simulated was ended from outside"

    def __init__(self) -> None:
        super().__init__()
        self.wish: Wish | None = None
        self._plan: Plan | None = None
        self._points: list[PowerPoint] = []

    def start(self, study: Study, wish: Wish) -> bool:
        """Begin; while one is under way this changes nothing and says False.

        Raises
        ------
        InputError
            If what is wished makes no study.
        """
        plan = plan_of(study, wish)
        with self._lock:
            if self.state == "running":
                return False
            points: list[PowerPoint] = []

            def take(found: object) -> None:
                assert isinstance(found, PowerPoint)
                # A list of this run's own: one that was cancelled may still have something to say.
                points.append(found)

            self.wish, self._plan, self._points = wish, plan, points
            self.begin(_simulate, (plan,), take)
            return True

    @property
    def result(self) -> Power | None:
        """The sizes that are done; None before the first."""
        points = tuple(self._points)
        return Power(self._plan, points) if self._plan is not None and points else None


def _simulate(tell: Teller, plan: Plan) -> None:
    """In a process of its own: gives the `PowerPoint`s one by one.

    One study at a time: its chains use the cores, and no process is left over when this one is ended.
    """
    power(plan, progress=tell.part("Simulated studies"), each=tell.give)


_runs: list[PowerRun] = []
_one = threading.Lock()


def power_run() -> PowerRun:
    """The power analysis of this process."""
    with _one:
        if not _runs:
            _runs.append(PowerRun())
        return _runs[0]
