"""Comparisons with a robot in the lab: which method is wanted, loaded and running."""

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime

from sqlalchemy import Connection, delete, select, update

from data.errors import ElbowroomError
from data.records import ExternalRun, Outcome, Slot, StuckEvent
from data.store.rows import first, insert_all, record_of, row_of
from data.store.tables import external_runs, stuck_events, trials
from data.store.trials import StoredTrials


class StoredExternalRuns(StoredTrials):
    """Where the comparisons stand that run on a robot in the lab. What is over stands among the trials."""

    def external_run(self, comparison_id: str) -> ExternalRun | None:
        """Where a comparison stands; None before the participant turned to a method."""
        with self.reading() as connection:
            return self._external_run(connection, comparison_id)

    def want_slot(self, comparison_id: str, slot: Slot) -> ExternalRun:
        """Keep which method the participant turned to; what is loaded stays until the operator changes it."""
        with self.transaction() as connection:
            stored = self._external_run(connection, comparison_id)
            if stored is None:
                self._comparison(connection, comparison_id)
                run = ExternalRun(comparison_id, slot)
                connection.execute(external_runs.insert(), row_of(run, external_runs))
                return run
            return self._change_run(connection, replace(stored, wanted=slot))

    def load_slot(self, comparison_id: str, slot: Slot | None) -> ExternalRun:
        """Keep which method the operator has loaded; None for none.

        Raises
        ------
        ElbowroomError
            If a run is under way, or the participant has turned to no method yet.
        """
        with self.transaction() as connection:
            stored = self._known_run(connection, comparison_id)
            if stored.started_at is not None:
                raise ElbowroomError(f"comparison {comparison_id}: a run is under way")
            return self._change_run(connection, replace(stored, loaded=slot))

    def start_run(self, comparison_id: str, at: datetime) -> ExternalRun:
        """Keep when a run began; the first time stands until the run is over.

        Raises
        ------
        ElbowroomError
            If no method is loaded.
        """
        with self.transaction() as connection:
            stored = self._known_run(connection, comparison_id)
            if stored.loaded is None:
                raise ElbowroomError(f"comparison {comparison_id}: no method is loaded")
            if stored.started_at is not None:
                return stored
            return self._change_run(connection, replace(stored, started_at=at))

    def end_run(self, comparison_id: str) -> ExternalRun:
        """Keep that no run is under way; the trial is added in the same transaction by who ends it."""
        with self.transaction() as connection:
            stored = self._known_run(connection, comparison_id)
            return self._change_run(connection, replace(stored, started_at=None))

    def correct_outcome(self, trial_id: str, outcome: Outcome, events: Sequence[StuckEvent]) -> None:
        """Change how a trial on a robot in the lab is said to have ended; the audit log is the caller's.

        Raises
        ------
        ElbowroomError
            If there is no such trial, or its outcome was computed and not said by an operator.
        """
        with self.transaction() as connection:
            if self.trial(trial_id).source != "external":
                raise ElbowroomError(f"trial {trial_id}: its outcome was measured and stays as it is")
            connection.execute(delete(stuck_events).where(stuck_events.c.trial == trial_id))
            connection.execute(update(trials).where(trials.c.id == trial_id).values(outcome=outcome))
            rows = [
                row_of(event, stuck_events, trial=trial_id, number=number)
                for number, event in enumerate(events, start=1)
            ]
            insert_all(connection, stuck_events, rows)

    def _known_run(self, connection: Connection, comparison_id: str) -> ExternalRun:
        stored = self._external_run(connection, comparison_id)
        if stored is None:
            raise ElbowroomError(f"comparison {comparison_id}: the participant has turned to no method yet")
        return stored

    @staticmethod
    def _external_run(connection: Connection, comparison_id: str) -> ExternalRun | None:
        row = first(connection, select(external_runs).where(external_runs.c.comparison == comparison_id))
        return None if row is None else record_of(ExternalRun, row)

    @staticmethod
    def _change_run(connection: Connection, run: ExternalRun) -> ExternalRun:
        here = external_runs.c.comparison == run.comparison
        values = {"wanted": run.wanted, "loaded": run.loaded, "started_at": run.started_at}
        connection.execute(update(external_runs).where(here).values(**values))
        return run
