"""Modes beside each other, worked out on request in a process of its own: curves at once, then laps.

What was worked out is kept as long as the server runs, under the study's hash: another choice of modes lets
only those laps be run that are missing.
"""

import threading
from dataclasses import replace

from app.atlas import OPERATORS, Atlas, study_atlas, with_modes
from app.console.aside import Aside, Teller
from data.study import Study
from sim_trials.mode_laps import ModeLaps, mode_laps


class ModeBench(Aside):
    """At most one comparison of modes under way, and all that were made."""

    killed = "the process that simulated was ended from outside"

    def __init__(self) -> None:
        super().__init__()
        self._atlases: dict[tuple[str, tuple[str, ...]], Atlas] = {}
        self._laps: dict[tuple[str, str], ModeLaps] = {}

    def start(self, study: Study, names: tuple[str, ...], with_laps: bool) -> None:
        """Begin to compare modes of a study; while a comparison is under way this changes nothing.

        Parameters
        ----------
        study : Study
            With every mode that can be chosen (`app.atlas.with_every_method`).
        names : tuple of str
            Which of them to compare.
        with_laps : bool
            Whether to run the laps that are missing.
        """
        key = study.sha256
        with self._lock:
            if self.state == "running":
                return
            missing = self.missing(study, names) if with_laps else ()

            def take(found: object) -> None:
                if isinstance(found, Atlas):
                    self._atlases[key, names] = found
                elif isinstance(found, ModeLaps):
                    self._laps[key, found.name] = found

            self.begin(_compare, (with_modes(study, names), missing), take)

    def missing(self, study: Study, names: tuple[str, ...]) -> tuple[str, ...]:
        """Those modes of which no laps were run yet."""
        return tuple(name for name in names if (study.sha256, name) not in self._laps)

    def atlas(self, study: Study, names: tuple[str, ...]) -> Atlas | None:
        """The modes beside each other, with the laps that were run so far; None if nothing was."""
        found = self._atlases.get((study.sha256, names))
        if found is None:
            return None
        laps = (self._laps.get((study.sha256, name)) for name in names)
        return replace(found, laps=tuple(lap for lap in laps if lap is not None))


def _compare(tell: Teller, study: Study, missing: tuple[str, ...]) -> None:
    """In a process of its own: gives an `Atlas` without laps, then the `ModeLaps` one by one."""
    tell.give(study_atlas(study, study.name, operators=0, progress=tell.part("Curves")))
    laps = tell.part("Laps")
    for done, name in enumerate(missing):
        laps(done, len(missing), name)
        tell.give(mode_laps(study, name, range(OPERATORS)))


_benches: list[ModeBench] = []
_one = threading.Lock()


def mode_bench() -> ModeBench:
    """The bench of this process."""
    with _one:
        if not _benches:
            _benches.append(ModeBench())
        return _benches[0]
