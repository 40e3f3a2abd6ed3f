"""Trials in the store: what happened in each run at the maze, and where its recording is."""

import hashlib
import os
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Select, select

from data.errors import ElbowroomError
from data.locations import cannot_write, sync_folder
from data.records import StuckEvent, Trial
from data.store.comparisons import StoredComparisons
from data.store.rows import every, insert_all, record_of, row_of, same
from data.store.studies import StoredStudy
from data.store.tables import comparisons, participants, stuck_events, trials


class StoredTrials(StoredComparisons):
    """The trials of a store, with their stuck events and recordings."""

    def add_trial(self, trial: Trial) -> None:
        """Keep a trial with its events; the same trial again changes nothing.

        A recording is a file in ``recordings_folder`` that is there already: before the row that
        names it is written, its content is compared with its hash and put on the disk.

        Raises
        ------
        ElbowroomError
            If the trial is stored otherwise, its mode is not the one behind its slot, or its
            recording is missing or differs from its hash.
        """
        if trial.recording is not None:
            self._secure_recording(trial.recording, trial.recording_sha256)
        with self.transaction() as connection:
            stored = self._trials(connection, select(trials).where(trials.c.id == trial.id))
            if stored:
                if not same(stored[0], trial):
                    raise ElbowroomError(f"trial {trial.id}: the store has another one of this id")
                return
            mode = self._comparison(connection, trial.comparison).mode_of(trial.slot)
            if trial.mode != mode:
                raise ElbowroomError(
                    f"trial {trial.id}: {trial.slot} stands for {mode}, not for {trial.mode}"
                )
            connection.execute(trials.insert(), row_of(trial, trials))
            rows = [
                row_of(event, stuck_events, trial=trial.id, number=number)
                for number, event in enumerate(trial.events, start=1)
            ]
            insert_all(connection, stuck_events, rows)

    def trial(self, trial_id: str) -> Trial:
        """One trial.

        Raises
        ------
        ElbowroomError
            If there is none of this id.
        """
        with self.reading() as connection:
            found = self._trials(connection, select(trials).where(trials.c.id == trial_id))
        if not found:
            raise ElbowroomError(f"trial {trial_id!r} is not in the store")
        return found[0]

    def trials(self, study: StoredStudy | None = None, comparison: str | None = None) -> tuple[Trial, ...]:
        """The trials of a study or of one comparison, by participant, comparison, slot and number."""
        query = select(trials).join_from(trials, comparisons).join(participants)
        if study is not None:
            query = query.where(participants.c.study == study.id)
        if comparison is not None:
            query = query.where(trials.c.comparison == comparison)
        query = query.order_by(
            participants.c.source,
            participants.c.number,
            participants.c.id,
            comparisons.c.position,
            trials.c.slot,
            trials.c.number,
        )
        with self.reading() as connection:
            return self._trials(connection, query)

    def recording_path(self, trial: Trial) -> Path:
        """Where a trial's recording is.

        Raises
        ------
        ElbowroomError
            If the trial has none, or the file is gone.
        """
        if trial.recording is None:
            raise ElbowroomError(f"trial {trial.id} has no recording")
        path = self.recordings_folder / trial.recording
        if not path.is_file():
            raise ElbowroomError(f"{path}: the recording of trial {trial.id} is missing")
        return path

    def _secure_recording(self, name: str, sha256: str | None) -> None:
        folder = self.recordings_folder
        path = folder / name
        if Path(name).name != name or name.startswith("."):
            raise ElbowroomError(f"recording {name!r}: the name of a file in {folder} is needed")
        try:
            with path.open("rb") as file:
                found = hashlib.file_digest(file, "sha256").hexdigest()
                os.fsync(file.fileno())
            sync_folder(folder)
        except FileNotFoundError:
            raise ElbowroomError(f"{path}: the recording is missing") from None
        except OSError as error:
            raise cannot_write(path, error) from None
        if found != sha256:
            raise ElbowroomError(f"{path}: the recording differs from its hash")

    @staticmethod
    def _trials(connection: Connection, query: Select[Any]) -> tuple[Trial, ...]:
        found = every(connection, query)
        wanted = query.with_only_columns(trials.c.id).order_by(None)
        events: dict[str, list[StuckEvent]] = {}
        of_them = select(stuck_events).where(stuck_events.c.trial.in_(wanted))
        in_order = of_them.order_by(stuck_events.c.trial, stuck_events.c.number)
        for row in every(connection, in_order):
            events.setdefault(row["trial"], []).append(record_of(StuckEvent, row))
        return tuple(record_of(Trial, row, events=tuple(events.get(row["id"], ()))) for row in found)
