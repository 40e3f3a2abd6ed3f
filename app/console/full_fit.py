"""The full fit on request: what ``elbowroom report`` writes, made in a process of its own, one at a time."""

import io
import shutil
import tempfile
import threading
import weakref
import zipfile
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Self

from analysis.looks import earlier
from app.console.aside import Aside, Teller
from app.server.desk import Desk
from data.records import Look
from data.responses import LagTable, MetricTable, PaceTable, ResponseTable, StuckTable
from data.study import Study


@dataclass(frozen=True)
class FittedReport:
    """A report in its folder."""

    folder: Path
    finished_at: datetime
    includes_simulated: bool
    warnings: tuple[str, ...]

    def zipped(self) -> bytes:
        """All of it as one ZIP file."""
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
            for file in sorted(self.folder.rglob("*")):
                if file.is_file():
                    archive.write(file, file.relative_to(self.folder))
        return content.getvalue()


class FullFit(Aside):
    """At most one fit under way, and the report of the last one that was done."""

    killed = "the process that fitted was ended from outside"

    def __init__(self) -> None:
        super().__init__()
        self._place = Path(tempfile.mkdtemp(prefix="elbowroom-report-"))
        # Also where nothing else is left that could clean up: at the end of the process.
        weakref.finalize(self, shutil.rmtree, self._place, ignore_errors=True)
        self._count = 0
        self.report: FittedReport | None = None

    def start(self, desk: Desk, include_simulated: bool) -> None:
        """Begin a fit of what is stored now; while one is under way this changes nothing.

        Raises
        ------
        InputError
            If there is nothing to fit.
        """
        with self._lock:
            if self.state == "running":
                return
            evidence = _Evidence.of(desk, include_simulated)
            is_blinded = not desk.store.is_unblinded(desk.stored_study)
            detail = {"study": desk.stored_study.label, "blinded": "yes" if is_blinded else "no"}
            desk.store.log("researcher", "full fit", detail, desk.clock())
            desk.store.log_look(desk.stored_study, evidence.table.look, "researcher", desk.clock())
            self._count += 1
            folder = self._place / f"report-{self._count}"

            def take(warnings: object) -> None:
                assert isinstance(warnings, tuple)
                self.report = FittedReport(folder, desk.clock(), include_simulated, warnings)

            self.begin(_fit, (evidence, folder), take)


_fits: list[FullFit] = []
_one = threading.Lock()


def full_fit() -> FullFit:
    """The full fit of this process."""
    with _one:
        if not _fits:
            _fits.append(FullFit())
        return _fits[0]


def log_reading(desk: Desk, action: str) -> None:
    """Keep that somebody takes the report, which names the modes, while the study is blinded."""
    if not desk.store.is_unblinded(desk.stored_study):
        desk.store.log(
            "researcher", action, {"study": desk.stored_study.label, "blinded": "yes"}, desk.clock()
        )


@dataclass(frozen=True)
class _Evidence:
    """All that a report is made of, on its way to another process."""

    table: ResponseTable
    stuck: StuckTable | None
    lag: LagTable | None
    metrics: MetricTable | None
    pace: PaceTable | None
    study: Study
    looks: tuple[Look, ...]

    @classmethod
    def of(cls, desk: Desk, include_simulated: bool) -> Self:
        store, stored = desk.store, desk.stored_study
        answers = store.responses_table(stored, include_simulated)
        return cls(
            answers,
            store.stuck_table(stored, include_simulated),
            store.lag_table(stored, include_simulated),
            store.metric_table(stored, include_simulated),
            store.pace_table(stored, include_simulated),
            stored.study,
            earlier(store.looks(stored), answers.look),
        )


def _fit(tell: Teller, evidence: _Evidence, folder: Path) -> None:
    """Fit and write, in a process of its own; gives the warnings."""
    from analysis.fit import fit
    from analysis.report import write_report

    fitted = fit(evidence.table, progress=tell.part("Fitting"))
    write_report(
        evidence.table,
        fitted,
        folder,
        stuck=evidence.stuck,
        study=evidence.study,
        progress=tell.part("Writing"),
        lag=evidence.lag,
        metrics=evidence.metrics,
        pace=evidence.pace,
        looks=evidence.looks,
    )
    tell.give(tuple(fitted.warnings))
