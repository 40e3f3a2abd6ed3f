"""Withdrawing a participant: what they gave is deleted, and that it was is kept."""

from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Select, delete, select, update

from data.locations import cannot_write
from data.records import Participant
from data.store.audit import StoredAudit
from data.store.tables import (
    comparisons,
    external_runs,
    links,
    responses,
    stuck_events,
    switches,
    trials,
)


class StoredWithdrawals(StoredAudit):
    """What a participant may ask for at any time."""

    def withdraw(self, participant_id: str, actor: str, at: datetime | None = None) -> Participant:
        """Delete a participant's comparisons, answers, trials, recordings and background.

        What stays is the participant's number, so that nobody else gets it, the times of joining, of consent
        and of withdrawing, the hash of their browser's cookie, which shows them that it is done, and an entry
        in the audit log. From then on nothing of them can be added. A second withdrawal changes none of this;
        it deletes recordings that an interruption left behind.

        Parameters
        ----------
        actor : str
            Who did it, for the audit log.

        Raises
        ------
        ElbowroomError
            If there is no such participant, or a recording cannot be deleted: withdrawing again tries again.
        """
        now = at or self.clock()
        with self.transaction() as connection:
            stored = self._participant(connection, participant_id)
            recordings = _recordings(connection, participant_id)
            if stored.withdrawn_at is None:
                _delete(connection, participant_id, now)
                changes: dict[str, object] = {
                    "background": {},
                    "background_at": None,
                    "device": None,
                    "practised_at": None,
                    "finished_at": None,
                    "withdrawn_at": now,
                }
                stored = self._change(connection, stored, changes)
                study = self.study_of(participant_id).label
                detail = {"study": study, "number": str(stored.number)}
                self.log(actor, "withdraw participant", detail, now)
        # After the commit: a recording without a row does no harm, a row without its recording would.
        self._delete_recordings(participant_id, recordings)
        return stored

    def _delete_recordings(self, participant_id: str, names: set[str]) -> None:
        """Delete recordings by name, and whatever bears the participant's name and is of no trial."""
        folder = self.recordings_folder
        with self.reading() as connection:
            kept = set(connection.execute(select(trials.c.recording)).scalars())
        left = {path.name for path in folder.iterdir() if path.name.startswith(f"{participant_id}.c")}
        for name in sorted(names | left - kept):
            try:
                (folder / name).unlink(missing_ok=True)
            except OSError as error:
                raise cannot_write(folder / name, error) from None


def _recordings(connection: Connection, participant_id: str) -> set[str]:
    query = (
        select(trials.c.recording)
        .join_from(trials, comparisons)
        .where(comparisons.c.participant == participant_id, trials.c.recording.is_not(None))
    )
    return {str(name) for name in connection.execute(query).scalars()}


def _delete(connection: Connection, participant_id: str, now: datetime) -> None:
    mine: Select[Any] = select(comparisons.c.id).where(comparisons.c.participant == participant_id)
    my_trials: Select[Any] = select(trials.c.id).where(trials.c.comparison.in_(mine))
    connection.execute(delete(stuck_events).where(stuck_events.c.trial.in_(my_trials)))
    for table in (trials, responses, switches, external_runs):
        connection.execute(delete(table).where(table.c.comparison.in_(mine)))
    connection.execute(delete(comparisons).where(comparisons.c.participant == participant_id))
    # A link's label may be a person's name.
    followed = links.c.participant == participant_id
    connection.execute(update(links).where(followed).values(expires_at=now, label=""))
