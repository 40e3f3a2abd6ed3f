"""The full fit on request: what ``elbowroom report`` writes, made in a process of its own, one at a time.

What it has come to is kept in this process, not in a page, so that it goes on while pages change.
"""

import io
import multiprocessing
import shutil
import tempfile
import threading
import weakref
import zipfile
from dataclasses import dataclass
from datetime import datetime
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Literal, Self

from app.server.desk import Desk
from app.server.worker_process import be_a_worker
from data.errors import ElbowroomError
from data.responses import LagTable, MetricTable, ResponseTable, StuckTable
from data.study import Study

_NICENESS = 10
"""Fitting waits for the robots that people hold in hand."""
_LEAST_WAIT_S = 5.0

State = Literal["idle", "running", "done", "failed", "cancelled"]


@dataclass(frozen=True)
class Step:
    """How far a part of a fit has come: ``done`` of ``total``, and a word on what is under way."""

    part: str
    done: int
    total: int
    now: str


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


class FullFit:
    """At most one fit under way, and the report of the last one that was done."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._place = Path(tempfile.mkdtemp(prefix="elbowroom-report-"))
        # Also where nothing else is left that could clean up: at the end of the process.
        weakref.finalize(self, shutil.rmtree, self._place, ignore_errors=True)
        self._process: multiprocessing.process.BaseProcess | None = None
        self._count = 0
        self.state: State = "idle"
        self.step = Step("", 0, 1, "")
        self.trouble = ""
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
            self._count += 1
            folder = self._place / f"report-{self._count}"
            # Spawned, never forked: the web process has threads.
            context = multiprocessing.get_context("spawn")
            ours, theirs = context.Pipe(duplex=False)
            process = context.Process(target=_fit, args=(theirs, evidence, folder), daemon=True)
            process.start()
            theirs.close()
            self._process, self.state, self.trouble = process, "running", ""
            self.step = Step("", 0, 1, "")
            listener = threading.Thread(
                target=self._listen, args=(ours, process, folder, desk, include_simulated), daemon=True
            )
            listener.start()

    def cancel(self) -> None:
        """Give up the fit under way; an earlier report stays."""
        with self._lock:
            if self.state != "running" or self._process is None:
                return
            self.state = "cancelled"
            self._process.terminate()

    def _listen(
        self,
        ours: Connection,
        process: multiprocessing.process.BaseProcess,
        folder: Path,
        desk: Desk,
        include_simulated: bool,
    ) -> None:
        """Take what the process says until it has said its last."""
        warnings: tuple[str, ...] | None = None
        trouble = "the process that fitted was ended from outside"
        with ours:
            while True:
                try:
                    said = ours.recv()
                except (EOFError, OSError):
                    break
                if isinstance(said, Step):
                    self.step = said
                elif isinstance(said, tuple):
                    warnings = said
                else:
                    trouble = str(said)
        process.join(_LEAST_WAIT_S)
        with self._lock:
            if self.state == "cancelled":
                return
            if warnings is None:
                self.state, self.trouble = "failed", trouble
                return
            self.report = FittedReport(folder, desk.clock(), include_simulated, warnings)
            self.state = "done"


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
    study: Study

    @classmethod
    def of(cls, desk: Desk, include_simulated: bool) -> Self:
        store, stored = desk.store, desk.stored_study
        return cls(
            store.responses_table(stored, include_simulated),
            store.stuck_table(stored, include_simulated),
            store.lag_table(stored, include_simulated),
            store.metric_table(stored, include_simulated),
            stored.study,
        )


def _fit(told: Connection, evidence: _Evidence, folder: Path) -> None:
    """Fit and write, in a process of its own; sends `Step`s, then the warnings or what went wrong."""
    be_a_worker(_NICENESS)
    from analysis.fit import fit
    from analysis.report import write_report

    try:
        fitted = fit(evidence.table, progress=_Teller(told, "Fitting"))
        write_report(
            evidence.table,
            fitted,
            folder,
            stuck=evidence.stuck,
            study=evidence.study,
            progress=_Teller(told, "Writing"),
            lag=evidence.lag,
            metrics=evidence.metrics,
        )
        told.send(tuple(fitted.warnings))
    except ElbowroomError as error:
        told.send(str(error))
    except MemoryError:
        told.send("not enough memory")
    finally:
        told.close()


@dataclass(frozen=True)
class _Teller:
    """Progress of one part of the work, sent to the process that asked for it."""

    told: Connection
    part: str

    def __call__(self, done: int, total: int, now: str = "") -> None:
        self.told.send(Step(self.part, done, max(total, 1), now))
