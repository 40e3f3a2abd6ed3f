"""Participants in the store: who joined, with which number, and what they agreed to."""

import re
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime

from sqlalchemy import Connection, RowMapping, select, update

from data.background import checked_background
from data.errors import ElbowroomError
from data.records import Device, Participant, Source
from data.store.rows import every, first, record_of, row_of
from data.store.studies import StoredStudies, StoredStudy
from data.store.tables import allocations, participants

_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,79}")


class StoredParticipants(StoredStudies):
    """The participants of a store."""

    def next_number(self, study: StoredStudy, source: Source) -> int:
        """Give away the next participant number, once: two processes never get the same."""
        with self.transaction() as connection:
            return self._next_number(connection, study.id, source)

    def add_participant(
        self, study: StoredStudy, participant: Participant, *, pooled: bool = False
    ) -> Participant:
        """Keep a participant; the same one again changes nothing and gives back what is stored.

        Parameters
        ----------
        pooled : bool
            True if this stands for unknown people whose answers were imported together.

        Raises
        ------
        ElbowroomError
            If the id belongs to another participant, or the number to another person.
        """
        if not _ID.fullmatch(participant.id):
            raise ElbowroomError(f"participant {participant.id!r}: an id has letters, digits, _ . -")
        with self.transaction() as connection:
            row = self._participant_row(connection, participant.id)
            if row is not None:
                stored = record_of(Participant, row)
                if (row["study"], stored.number, stored.source) != (
                    study.id,
                    participant.number,
                    participant.source,
                ):
                    raise ElbowroomError(
                        f"participant {participant.id}: the store has another one of this id"
                    )
                return stored
            if participant.source == "human":
                taken = select(participants.c.id).where(
                    participants.c.study == study.id,
                    participants.c.source == "human",
                    participants.c.number == participant.number,
                )
                if connection.execute(taken).first() is not None:
                    raise ElbowroomError(f"participant number {participant.number} is given away already")
                self._lock(connection, study.id)
            connection.execute(
                participants.insert(), row_of(participant, participants, study=study.id, pooled=pooled)
            )
            self._count_up_to(connection, study.id, participant.source, participant.number)
            return participant

    def participant(self, participant_id: str) -> Participant:
        """One participant.

        Raises
        ------
        ElbowroomError
            If there is none of this id.
        """
        with self.reading() as connection:
            return self._participant(connection, participant_id)

    def participants(self, study: StoredStudy, source: Source | None = None) -> tuple[Participant, ...]:
        """The participants of a study, people first, by number; of one source if it is given."""
        query = select(participants).where(participants.c.study == study.id)
        if source is not None:
            query = query.where(participants.c.source == source)
        query = query.order_by(participants.c.source, participants.c.number, participants.c.id)
        with self.reading() as connection:
            return tuple(record_of(Participant, row) for row in every(connection, query))

    def study_of(self, participant_id: str) -> StoredStudy:
        """The study that a participant takes part in."""
        with self.reading() as connection:
            row = self._participant_row(connection, participant_id)
            if row is None:
                raise ElbowroomError(f"participant {participant_id!r} is not in the store")
            return self._study_by_id(connection, row["study"])

    def record_consent(self, participant_id: str, version: str, at: datetime) -> Participant:
        """Keep that a participant agreed, to which text and when; the first time stands."""
        with self.transaction() as connection:
            stored = self._participant(connection, participant_id)
            if stored.consented_at is not None:
                if stored.consent_version != version:
                    raise ElbowroomError(
                        f"participant {participant_id} agreed to version {stored.consent_version} already"
                    )
                return stored
            return self._change(connection, stored, {"consent_version": version, "consented_at": at})

    def record_background(self, participant_id: str, answers: Mapping[str, str], at: datetime) -> Participant:
        """Keep the answers to the background questions; the first ones stand.

        Raises
        ------
        InputError
            If an answer is none that its question takes (``data.background``).
        """
        with self.transaction() as connection:
            stored = self._participant(connection, participant_id)
            if stored.background_at is not None:
                return stored
            given = checked_background(self.study_of(participant_id).study, answers)
            background = {**stored.background, **given}
            return self._change(connection, stored, {"background": background, "background_at": at})

    def record_device(self, participant_id: str, device: Device) -> Participant:
        """Keep what a participant guides the robot with; the first choice stands."""
        with self.transaction() as connection:
            stored = self._participant(connection, participant_id)
            return stored if stored.device else self._change(connection, stored, {"device": device})

    def record_practice(self, participant_id: str, at: datetime) -> Participant:
        """Keep that a participant has practised; the first time stands."""
        with self.transaction() as connection:
            stored = self._participant(connection, participant_id)
            if stored.practised_at is not None:
                return stored
            return self._change(connection, stored, {"practised_at": at})

    def finish_participant(self, participant_id: str, at: datetime) -> Participant:
        """Keep when a participant was done; the first time stands."""
        with self.transaction() as connection:
            stored = self._participant(connection, participant_id)
            if stored.finished_at is not None:
                return stored
            return self._change(connection, stored, {"finished_at": at})

    def _change(self, connection: Connection, stored: Participant, changes: dict[str, object]) -> Participant:
        if stored.withdrawn_at is not None:
            raise ElbowroomError(f"participant {stored.id} has withdrawn: nothing more is kept")
        connection.execute(update(participants).where(participants.c.id == stored.id).values(**changes))
        return replace(stored, **changes)  # type: ignore[arg-type]

    def _participant(self, connection: Connection, participant_id: str) -> Participant:
        row = self._participant_row(connection, participant_id)
        if row is None:
            raise ElbowroomError(f"participant {participant_id!r} is not in the store")
        return record_of(Participant, row)

    @staticmethod
    def _participant_row(connection: Connection, participant_id: str) -> RowMapping | None:
        return first(connection, select(participants).where(participants.c.id == participant_id))

    @staticmethod
    def _next_number(connection: Connection, study_id: int, source: Source) -> int:
        here = (allocations.c.study == study_id) & (allocations.c.source == source)
        last = connection.execute(select(allocations.c.last_number).where(here)).scalar()
        if last is None:
            connection.execute(allocations.insert(), {"study": study_id, "source": source, "last_number": 1})
            return 1
        connection.execute(update(allocations).where(here).values(last_number=last + 1))
        return int(last) + 1

    @staticmethod
    def _count_up_to(connection: Connection, study_id: int, source: Source, number: int) -> None:
        """Numbers that came with a participant are not given away again."""
        here = (allocations.c.study == study_id) & (allocations.c.source == source)
        last = connection.execute(select(allocations.c.last_number).where(here)).scalar()
        if last is None:
            row = {"study": study_id, "source": source, "last_number": number}
            connection.execute(allocations.insert(), row)
        elif number > last:
            connection.execute(update(allocations).where(here).values(last_number=number))
